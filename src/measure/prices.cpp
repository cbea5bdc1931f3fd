#include "measure/prices.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "base/check.h"
#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "config/describe.h"
#include "forward/forward.h"
#include "forward/price.h"

namespace papilla::measure {
namespace {

constexpr double kDrawn = 0.3;        // of the numbers
constexpr double kSmallest = 1e-6;    // of a range from 0, as a share of its end
constexpr double kManyDecades = 100;  // of a range that is drawn by ratio
constexpr int kTries = 10000;

double drawn(const NumberField& field, RandomStream& random) {
  const double to_si = find_unit(field.unit)->to_si;
  const double high = field.high * to_si;
  const double low = field.low > 0 ? field.low * to_si : field.low * to_si + kSmallest * high;
  const double share = random.uniform();
  if (low > 0 && high > kManyDecades * low) return low * std::pow(high / low, share);
  return low + (high - low) * share;
}

// The numbers of a design that say how it looks and feels: no numbers of accuracy or optics alone.
bool counts(const std::string& path) {
  for (const char* section : {"texture.", "surface.", "finger.", "drive."}) {
    if (path.starts_with(section)) return true;
  }
  return false;
}

struct Drawn {
  Design design;
  std::string numbers;
};

Drawn draw(int index) {
  std::vector<std::size_t> kinds;
  for (std::size_t k = 0; k < texture_kinds().size(); ++k) {
    if (numbers_alone(k)) kinds.push_back(k);
  }
  RandomStream random(17, "legal designs", static_cast<std::uint64_t>(index));
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Drawn out;
    out.design.texture = default_texture(kinds[static_cast<std::size_t>(index) % kinds.size()]);
    out.design.accuracy.level = AccuracyLevel::Draft;
    for (const NumberField& field : number_fields(out.design)) {
      if (!counts(field.path) || random.uniform() > kDrawn) continue;
      *field.value = drawn(field, random);
      out.numbers +=
          fmt::format("{}{}={:.4g}", out.numbers.empty() ? "" : " ", field.path, *field.value);
    }
    if (design_problems(out.design).empty()) return out;
  }
  PAPILLA_CHECK(false, "a legal design is found");
  return {};
}

}  // namespace

Design legal_design(int index) { return draw(index).design; }

std::vector<PriceRow> prices_of(const PriceOptions& options) {
  std::vector<PriceRow> out;
  for (int i = options.first; i < options.first + options.designs; ++i) {
    const Drawn drawn = draw(i);
    Fidelity fidelity = fidelity_of(drawn.design);
    fidelity.threads = 1;
    const Scene scene = scene_of(drawn.design);
    PriceRow row;
    row.design = i;
    row.texture = texture_name(drawn.design.texture);
    row.announced = measured_seconds(scene, drawn.design.texture, fidelity);
    row.numbers = drawn.numbers;
    const std::clock_t begin = std::clock();
    try {
      const Response response = evaluate(scene, drawn.design.texture, fidelity);
      row.status = text(response.said());
      row.sound = response.said().empty();
    } catch (const InputError& error) {  // what only the work finds out, such as a jammed film
      row.status = error.what();
      row.sound = false;
    }
    row.taken = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (options.done) options.done(row);
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace papilla::measure
