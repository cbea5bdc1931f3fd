#include "geometry/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::geometry {
namespace {

template <class Variant>
struct List;
template <class... Kinds>
struct List<std::variant<Kinds...>> {
  static_assert((TextureKind<Kinds> && ...), "a kind does not say all that textures say");
  static std::vector<std::string> names() { return {std::string(Kinds::kName)...}; }
  static constexpr std::array<bool, sizeof...(Kinds)> kNumbersAlone{Kinds::kNumbersAlone...};
  static Texture make(std::size_t kind) {
    Texture out;
    std::size_t i = 0;
    ((i++ == kind ? void(out.kind.template emplace<Kinds>()) : void()), ...);
    return out;
  }
};
using Kinds = decltype(Texture::kind);
static_assert(std::is_same_v<std::variant_alternative_t<0, Kinds>, Flat>);

// The next even count that FFTs are fast for (factors of 2 to 7, one of 11 or 13) and that halves
// to such counts again where it is large, so that nested grids exist.
int even_count(double least) {
  const int step = least > 64 ? 16 : least > 16 ? 4 : 2;
  const auto fast = [](int n) {
    for (int p : {2, 3, 5, 7}) {
      while (n % p == 0) n /= p;
    }
    return n == 1 || n == 11 || n == 13;
  };
  int n = std::max(2, step * static_cast<int>(std::ceil(least / step - 1e-9)));
  while (!fast(n)) n += step;
  return n;
}

// Periods along a side that hold what the texture does not repeat, a film of particles beside a
// lattice.
double periods_that_hold(const FreePatch& free, double side) {
  return std::max(1.0, std::ceil(free.least / side - 1e-6));
}

}  // namespace

const std::vector<std::string>& texture_kinds() {
  static const std::vector<std::string> names = List<Kinds>::names();
  return names;
}

std::string texture_name(const Texture& texture) { return texture_kinds()[texture.kind.index()]; }

Texture default_texture(std::size_t kind) {
  PAPILLA_CHECK(kind < texture_kinds().size(), "a texture kind");
  return List<Kinds>::make(kind);
}

bool numbers_alone(std::size_t kind) { return List<Kinds>::kNumbersAlone.at(kind); }

void fields(FieldVisitor& v, Texture& texture) {
  int index = static_cast<int>(texture.kind.index());
  const int before = index;
  v.choice({"type", "kind of texture"}, texture_kinds(), index);
  if (index != before) texture = default_texture(static_cast<std::size_t>(index));
  std::visit([&](auto& kind) { fields(v, kind); }, texture.kind);
}

TextureProblems problems(const Texture& texture) {
  return std::visit([](const auto& kind) { return problems(kind); }, texture.kind);
}

TextureFacts facts(const Texture& texture) {
  return std::visit([](const auto& kind) { return facts(kind); }, texture.kind);
}

Roles roles(Texture& texture) {
  return std::visit([](auto& kind) { return roles(kind); }, texture.kind);
}

Heightmap generate(const Texture& texture, const Grid& grid) {
  return std::visit([&](const auto& kind) { return heights(kind, grid); }, texture.kind);
}

Grid patch_grid(const Texture& texture, int pixels, double target) {
  const TextureFacts known = facts(texture);
  double lx, ly;
  if (known.cell) {
    const UnitCell& cell = *known.cell;
    const FreePatch& free = known.free_patch;
    lx = cell.x * std::max({2.0, std::round(target / cell.x), periods_that_hold(free, cell.x)});
    ly = cell.y * std::max(std::round(lx / cell.y), periods_that_hold(free, cell.y));
  } else {
    lx = ly = known.free_patch.side(target);
  }
  const int nx = std::max(2, pixels + pixels % 2);
  int ny = static_cast<int>(std::lround(nx * ly / lx));
  // Even, and kept divisible as nx is, so that nested grids exist.
  const int multiple = nx % 16 == 0 ? 16 : 2;
  ny = std::max(multiple, (ny + multiple / 2) / multiple * multiple);
  return {nx, ny, lx, ly};
}

Grid simulated_patch(const Texture& texture, int pixels, int most) {
  const TextureFacts known = facts(texture);
  const FreePatch& free = known.free_patch;
  std::optional<UnitCell> repeated = known.cell;
  if (!repeated && free.exact && free.repeats) repeated = UnitCell{*free.exact, *free.exact};
  double lx, ly;
  if (repeated) {
    const UnitCell& cell = *repeated;
    // A patch twice too long counts as much as one of half or twice the area.
    double least = kInfinity;
    lx = cell.x;
    ly = cell.y;
    // Of each side on its own: the cell of grooves beside finer holes is shorter along y.
    const auto fewest = [&](double side) {
      return static_cast<int>(periods_that_hold(free, side));
    };
    const auto most_periods = [&](double side) {
      return std::max(fewest(side), static_cast<int>(std::ceil(2 * kWindow / side)));
    };
    for (int i = fewest(cell.x); i <= most_periods(cell.x); ++i) {
      for (int j = fewest(cell.y); j <= most_periods(cell.y); ++j) {
        const double x = i * cell.x, y = j * cell.y;
        const double unlike =
            std::abs(std::log(x * y / (kWindow * kWindow))) + 0.5 * std::abs(std::log(x / y));
        if (unlike < least - 1e-9) {
          least = unlike;
          lx = x;
          ly = y;
        }
      }
    }
  } else {
    lx = ly = free.side(kWindow);
  }
  const double pixel = std::max(kWindow / pixels, std::max(lx, ly) / most);
  return {even_count(lx / pixel), even_count(ly / pixel), lx, ly};
}

}  // namespace papilla::geometry
