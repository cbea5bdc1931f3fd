#include "measure/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "estimate/target.h"
#include "measure/accuracy.h"
#include "numerics/statistics.h"

namespace papilla::measure {
namespace {

// One random scene: its reference, and what is judged against it.
class JudgedScene {
 public:
  JudgedScene(int index, const CoverageOptions& options, std::vector<CoverageRow>& rows)
      : index_(index),
        options_(options),
        rows_(rows),
        scene_(random_scene(index, texture_)),
        seed_(static_cast<std::uint64_t>(index) + 1) {
    Fidelity fine = coverage_reference(options);
    fine.seed = seed_;
    truth_ = evaluate(scene_, texture_, fine);
  }

  void judge() {
    if (options_.tight) {
      judge_level("design");
      judge_target("target 2 %", 0.02);
      return;
    }
    for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
      Fidelity f = level("design");
      f.grid = options_.grid;
      f.skins = options_.skins;
      f.estimator = estimator;
      judge(fmt::format("{} pixels {} skins {}", f.grid, f.skins,
                        estimator == Estimator::Load ? "load law" : "solved areas"),
            evaluate(scene_, texture_, f));
    }
    for (const char* name : {"search", "draft"}) judge_level(name);
    judge_target("target 5 %", 0.05);
  }

 private:
  Fidelity level(const char* name) const {
    Fidelity f = fidelity_level(name);
    f.threads = options_.threads;
    f.seed = seed_;
    return f;
  }

  void judge_level(const char* name) { judge(name, evaluate(scene_, texture_, level(name))); }

  void judge_target(const char* name, double target) {
    judge(name, evaluate_to_target(scene_, texture_,
                                   {.target = target, .seed = seed_, .threads = options_.threads}));
  }

  void judge(const std::string& fidelity, const Response& r) {
    for (const AccuracyQuantity& q : accuracy_quantities()) {
      const auto v = summarise(q.summary, q.metric, r), t = summarise(q.summary, q.metric, truth_);
      if (!v || !t) continue;  // no mean to divide by
      // The humidities are given and the reference stands on the same 3-D field: neither quadrature
      // nor what pixels and cells leave of that field is part of this comparison.
      ErrorParts parts = v->parts;
      parts.humidity.reset();
      if (parts.field) *parts.field *= own_share_of_field(r);
      rows_.push_back({index_, texture_name(texture_), fidelity, q.name, v->value,
                       1.96 * parts.total(), t->value, t->parts.sampling, parts});
    }
  }

  // Of the part of the 3-D field, the share that is of the few skins it is solved on.
  static double own_share_of_field(const Response& r) {
    double all = 0, own = 0;
    for (const ResponsePoint& p : r.points) {
      const double e = p.field_error.value_or(0);
      all += e;
      own += std::sqrt(std::max(0.0, square(e) - square(full_field_error(p.field_correction))));
    }
    return all > 0 ? own / all : 1;
  }

  int index_;
  const CoverageOptions& options_;
  std::vector<CoverageRow>& rows_;
  Texture texture_;
  Scene scene_;
  std::uint64_t seed_;  // skins of its own: with common ones the luck of a few would be that of all
  Response truth_;
};

// One of four: alike everywhere, by the angle, level, and a level one under a coat of another
// oxide. Below a rough surface a level film has no stated depth to hold: it is alike everywhere
// there.
void lay_film(int which, double depth, const Texture& texture, RandomStream& random,
              Surface& surface) {
  const bool holds = facts(texture).relief.height().has_value();
  if (which == 1) surface.process = FilmProcess::Directional;
  if (which >= 2 && holds) {
    surface.process = FilmProcess::Planar;
    surface.dielectric.front().thickness += depth;
  }
  if (which != 3) return;
  FilmDielectric coat;
  coat.material = "Al2O3";
  coat.thickness = random.uniform(30e-9, 200e-9);
  coat.permittivity = random.uniform(6, 10);
  coat.process = LayerProcess::Conformal;
  surface.dielectric.push_back(coat);
}

}  // namespace

bool CoverageRow::inside() const { return std::abs(value - reference) <= half_width; }

Scene random_scene(int index, Texture& texture) {
  RandomStream random(1, "accuracy scene", static_cast<std::uint64_t>(index));
  const auto log_uniform = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform());
  };
  const double period = random.uniform(3e-6, 6e-6), size = period * random.uniform(0.3, 0.6),
               depth = random.uniform(50e-9, 900e-9);
  // From gentle to steep, and never so gentle that the walls meet.
  const double slope = random.uniform(kPi / 6, kPi / 2);
  const auto between = [&](double room) { return std::max(slope, std::atan(2.2 * depth / room)); };
  const double wall = between(size);
  switch (index % 8) {
    case 0:
      texture = Texture{
          HoleArray{.period = period, .diameter = size, .depth = depth, .wall_angle = wall}};
      break;
    case 1:
      texture = Texture{PillarArray{.period = period,
                                    .diameter = size,
                                    .height = depth,
                                    .wall_angle = between(std::min(size, period - size))}};
      break;
    case 2:
      texture =
          Texture{Grating{.period = period, .width = size, .depth = depth, .wall_angle = wall}};
      break;
    case 3:
      texture = Texture{VGrooves{.period = period, .width = size, .depth = depth}};
      break;
    case 4:
      texture = Texture{Waves{.period = period, .depth = depth}};
      break;
    case 5:
      texture = Texture{CapArray{.form = CapArray::Form::Domes,
                                 .period = period,
                                 .diameter = size,
                                 .depth = std::min(depth, 0.45 * size)}};
      break;
    case 6:
      texture = Texture{RandomRough{.rms = 0.25 * depth}};
      break;
    default:
      texture = Texture{};
  }
  Scene scene;
  Finger& finger = scene.finger;
  scene.model = finger.calibrated_for;
  finger.skin.rms = random.uniform(150e-9, 350e-9);
  const double stiff = log_uniform(0.6, 1.6);
  finger.skin.layer_modulus *= stiff;
  finger.skin.bulk_modulus *= stiff;
  const double wet = log_uniform(0.3, 3);
  for (double& v : finger.water.volume) v *= wet;
  scene.surface.contact_angle = random.uniform(0.6, 1.9);
  lay_film(index / 8 % 4, depth, texture, random, scene.surface);
  scene.drive.amplitude = random.uniform(80, 220);
  const double low = random.uniform(0.15, 0.45);
  scene.environment.relative_humidity = {low, low + random.uniform(0.1, 0.3)};
  return scene;
}

Fidelity coverage_reference(const CoverageOptions& options) {
  Fidelity f = fidelity_level(options.tight ? "reference" : "design");
  if (!options.tight) {
    f.grid = options.finer_grid;
    f.skins = options.finer_skins;
  }
  f.threads = options.threads;
  f.first_skin = 1000;  // held out
  f.control_skins = 0;
  return f;
}

std::vector<CoverageRow> coverage(const CoverageOptions& options) {
  std::vector<CoverageRow> rows;
  for (int i = options.first; i < options.first + options.scenes; ++i) {
    JudgedScene(i, options, rows).judge();
    if (options.note)
      options.note(fmt::format("scene {} of {}", i - options.first + 1, options.scenes));
  }
  return rows;
}

std::vector<CoverageSummary> coverage_summary(const std::vector<CoverageRow>& rows) {
  std::vector<CoverageSummary> out;
  for (const CoverageRow& first : rows) {
    const auto same = [&](const auto& r) {
      return r.fidelity == first.fidelity && r.quantity == first.quantity;
    };
    if (std::any_of(out.begin(), out.end(), same)) continue;
    std::vector<double> widths, errors;
    int inside = 0, inside_both = 0;
    double squares = 0;
    for (const CoverageRow& row : rows) {
      if (!same(row)) continue;
      widths.push_back(row.half_width);
      errors.push_back(std::abs(row.value - row.reference));
      inside += row.inside() ? 1 : 0;
      inside_both +=
          errors.back() <= std::hypot(row.half_width, 1.96 * row.reference_error) ? 1 : 0;
      squares += square(1.96 * errors.back() / row.half_width);
    }
    const auto n = static_cast<int>(widths.size());
    out.push_back({first.fidelity, first.quantity, n, static_cast<double>(inside) / n,
                   static_cast<double>(inside_both) / n, quantile(widths, 0.5),
                   quantile(errors, 0.95), std::sqrt(squares / n)});
  }
  return out;
}

}  // namespace papilla::measure
