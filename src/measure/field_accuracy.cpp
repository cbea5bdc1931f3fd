#include "measure/field_accuracy.h"

#include <algorithm>
#include <array>
#include <ctime>

#include "base/check.h"
#include "base/constants.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "physics/electrostatics/rules.h"

namespace papilla::measure {
namespace {

// Weights of the four neighbours of a point at share t between the middle two.
std::array<double, 4> catmull_rom(double t) {
  return {0.5 * t * (-1 + t * (2 - t)), 0.5 * (2 + t * t * (3 * t - 5)),
          0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (t - 1)};
}

// A periodic field on a grid `factor` times finer; pixels are averages around their centres.
std::vector<double> refined(const Grid& grid, const std::vector<double>& values, const Grid& fine,
                            int factor) {
  std::vector<double> out(fine.size());
  const auto place = [factor](int i, int& base) {
    const double x = (i + 0.5) / factor - 0.5;
    base = static_cast<int>(std::floor(x));
    return x - base;
  };
  for (int iy = 0; iy < fine.ny; ++iy) {
    int y = 0;
    const auto wy = catmull_rom(place(iy, y));
    for (int ix = 0; ix < fine.nx; ++ix) {
      int x = 0;
      const auto wx = catmull_rom(place(ix, x));
      double sum = 0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          sum += wy[j] * wx[i] *
                 values[grid.index(wrap(x + i - 1, grid.nx), wrap(y + j - 1, grid.ny))];
        }
      }
      out[fine.index(ix, iy)] = sum;
    }
  }
  return out;
}

// The patch on a finer grid: gap between the refined skin and the texture made anew.
struct FinePatch {
  CoveredSurface surface;
  Gap gap;
  Wetting wetting;
};

FinePatch fine_patch(const Design& design, const PatchPicture& picture, int factor) {
  const Grid& grid = picture.texture.grid;
  const std::vector<FilmLayer> film = film_layers(design.surface);
  FinePatch out{CoveredSurface(picture.texture, film),
                {grid, picture.fields.off.gap},
                picture.fields.wetting_on};
  if (factor == 1) return out;
  const Grid fine{factor * grid.nx, factor * grid.ny, grid.lx, grid.ly};
  std::vector<double> skin(grid.size());
  for (std::size_t i = 0; i < skin.size(); ++i)
    skin[i] = picture.texture.z[i] + picture.fields.off.gap[i];
  skin = refined(grid, skin, fine, factor);
  out.surface = CoveredSurface(generate(design.texture, fine), film);
  out.gap = {fine, std::vector<double>(fine.size())};
  out.wetting.grid = fine;
  if (!out.wetting.bridged.empty()) out.wetting.bridged.assign(fine.size(), 0);
  for (int iy = 0; iy < fine.ny; ++iy) {
    for (int ix = 0; ix < fine.nx; ++ix) {
      const std::size_t i = fine.index(ix, iy), coarse = grid.index(ix / factor, iy / factor);
      // Contact stays contact; elsewhere the interpolation must not dip below the texture.
      out.gap.value[i] = picture.fields.off.gap[coarse] == 0
                             ? 0
                             : std::max(0.0, skin[i] - out.surface.height.z[i]);
      if (!out.wetting.bridged.empty()) {
        out.wetting.bridged[i] = picture.fields.wetting_on.bridged[coarse];
      }
    }
  }
  return out;
}

}  // namespace

std::vector<FieldAccuracyRow> field_accuracy(const std::string& sample, const Design& design,
                                             const FieldAccuracyOptions& options) {
  PAPILLA_CHECK(!options.refinements.empty(), "one refinement at least");
  Fidelity fidelity = fidelity_level("draft");
  fidelity.grid = options.pixels;
  const Scene scene = scene_of(design);
  std::vector<FieldAccuracyRow> rows;
  for (const double humidity : design.environment.relative_humidity) {
    const PatchPicture picture =
        picture_patch(scene, design.texture, fidelity, humidity, options.skin);
    const FieldProblem problem = field_problem(scene, humidity);
    const std::size_t first = rows.size();
    const auto add = [&](const char* method, const FinePatch& patch, auto&& solve) {
      // Processor time; the least of up to five runs: other work on the machine only adds.
      FieldSolution result;
      double least = kInfinity, total = 0;
      for (int run = 0; run < 5 && total < 0.2; ++run) {
        const std::clock_t begin = std::clock();
        result = solve(patch);
        const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        least = std::min(least, spent);
        total += spent;
      }
      rows.push_back({sample, method, humidity, patch.gap.grid.nx, result.mean_pressure, 0, least,
                      result.ok ? "" : result.reason});
    };
    const FinePatch solved = fine_patch(design, picture, 1);
    for (const bool screening : {false, true}) {
      FieldProblem p = problem;
      p.screening = screening;
      add(screening ? "screened" : "local", solved, [&](const FinePatch& patch) {
        return solve_local_field(patch.gap, &patch.surface, patch.wetting, p);
      });
    }
    add("spread", solved, [&](const FinePatch& patch) {
      return solve_spread_field(patch.gap, &patch.surface, patch.wetting, problem);
    });
    for (const int factor : options.refinements) {
      add("full", fine_patch(design, picture, factor), [&](const FinePatch& patch) {
        return field_rule(FieldMethod::Full)
            .solve(patch.gap, &patch.surface, patch.wetting, problem, 0);  // of its own accuracy
      });
    }
    const double exact = rows.back().pull;
    for (std::size_t i = first; i < rows.size(); ++i)
      rows[i].error = exact > 0 ? rows[i].pull / exact - 1 : 0;
  }
  return rows;
}

}  // namespace papilla::measure
