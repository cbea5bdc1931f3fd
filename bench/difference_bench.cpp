// What the stated error of the difference of two designs (Eq. accuracy.14) holds of what other
// skins scatter it by, as CSV: designs of all kinds drawn by a seed, each beside itself with one
// number moved, at level draft on twelve sets of skins. The grid's and the method's share of the
// error move all sets alike and stand in what is stated alone. Run by hand:
// ninja -C build/release difference_bench && build/release/bench/difference_bench designs COUNT
// SEED
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "bench/drawn_design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"

namespace {

using namespace papilla::tests;

// A value of one design on each set of skins, and what its error is made of; empty where a set has
// no value.
struct Values {
  std::vector<double> value;
  std::vector<ErrorSamples> samples;
};

Values values_of(const std::vector<Response>& responses, Summary summary) {
  Values out;
  for (const Response& r : responses) {
    const auto v = summarise(summary, kModulation, r);
    if (!v || !r.troubles().empty()) return {};
    out.value.push_back(v->value);
    out.samples.push_back(error_samples(summary, kModulation, r));
  }
  return out;
}

std::vector<Response> responses_of(const Design& design, const std::string& level, int sets) {
  std::vector<Response> out;
  Fidelity f = fidelity_level(level);
  for (int set = 0; set < sets; ++set) {
    f.seed = static_cast<std::uint64_t>(1000 + set);
    out.push_back(evaluate(scene_of(design), design.texture, f));
  }
  return out;
}

// Differences held against an error: how many lie inside 95 % of it, and its square mean.
struct Held {
  int inside = 0;
  double squares = 0;

  void add(double off, double error) {
    inside += off < 1.96 * error;
    squares += square(error);
  }
};

// Of many differences, each about its mean over the sets of skins. Against all that is stated, and
// against the parts of it that other skins move: sampling alone, and with the field part.
struct Tally {
  int count = 0;
  double scatter = 0;
  Held stated, of_skins, of_sampling;

  void add(const Values& a, const Values& b) {
    std::vector<double> differences;
    for (std::size_t k = 0; k < a.value.size(); ++k) differences.push_back(a.value[k] - b.value[k]);
    const double mean = mean_estimate(differences).value;
    // A set is part of the mean.
    const auto sets = static_cast<double>(differences.size());
    const double whole = std::sqrt(sets / (sets - 1));
    for (std::size_t k = 0; k < differences.size(); ++k) {
      const ErrorSamples &one = a.samples[k], &other = b.samples[k];
      const auto error = difference_error(one, other);
      if (!error) continue;
      const double field = field_difference_error(one.field, other.field);
      const double sampling =
          difference_error({one.sampling, {}, {}}, {other.sampling, {}, {}}).value_or(0);
      const double off = whole * std::abs(differences[k] - mean);
      ++count;
      scatter += square(off);
      stated.add(off, *error);
      of_skins.add(off, std::hypot(sampling, field));
      of_sampling.add(off, sampling);
    }
  }

  void print(const std::string& of, const std::string& summary) const {
    const auto rms = [&](double squares) { return std::sqrt(squares / std::max(count, 1)); };
    fmt::print("{},{},{},{:.4f}", of, summary, count, rms(scatter));
    for (const Held& held : {stated, of_skins, of_sampling})
      fmt::print(",{:.4f},{:.1f}", rms(held.squares), 100.0 * held.inside / std::max(count, 1));
    fmt::print("\n");
  }
};

// One number of the texture a tenth up or down.
std::optional<Design> neighbour(RandomStream& random, const Design& design) {
  const std::vector<std::string> paths = texture_numbers(design);
  if (paths.empty()) return std::nullopt;
  const std::string path = paths[static_cast<std::size_t>(random.below(int(paths.size())))];
  Design out = design;
  const DesignStep step = design_step(design, path, 0.1);
  set_number(out, path, random.uniform(0, 1) < 0.5 ? step.up : step.down);
  if (!design_problems(out).empty()) return std::nullopt;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string designs = argc > 1 ? argv[1] : "designs";
  const int count = argc > 2 ? std::atoi(argv[2]) : 12;
  const std::string level = argc > 4 ? argv[4] : "draft";
  const int sets = argc > 5 ? std::max(2, std::atoi(argv[5])) : 12;
  RandomStream random(argc > 3 ? static_cast<std::uint64_t>(std::atoi(argv[3])) : 1, "differences");
  std::vector<std::pair<std::vector<Response>, std::vector<Response>>> all;
  for (int k = 0; k < count; ++k) {
    const Design design = drawn_design(random, designs, static_cast<std::size_t>(k));
    const std::optional<Design> moved = neighbour(random, design);
    all.emplace_back(responses_of(design, level, sets),
                     moved ? responses_of(*moved, level, sets) : std::vector<Response>{});
  }
  fmt::print(
      "pairs,summary of the modulation,differences,their scatter over skins,stated,inside 95 % [%],"
      "sampling and field,inside 95 % [%],sampling alone,inside 95 % [%]\n");
  for (const auto& [summary, name] :
       {std::pair{Summary::Mean, "mean"}, {Summary::Variation, "variation"}}) {
    Tally others, neighbours;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Values own = values_of(all[i].first, summary);
      if (own.value.empty()) continue;
      for (std::size_t j = 0; j < i; ++j) {
        const Values other = values_of(all[j].first, summary);
        if (!other.value.empty()) others.add(own, other);
      }
      const Values moved = values_of(all[i].second, summary);
      if (!moved.value.empty()) neighbours.add(own, moved);
    }
    others.print("other designs", name);
    neighbours.print("one number moved by a tenth", name);
  }
}
