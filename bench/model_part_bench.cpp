// The part `model` of numbers from few skins against many: designs of all kinds, bare and under a
// film, drawn by a seed, each beside one that a hand made of it, with the belief of the shipped
// finger on 2 skins (several sets of them) and on 24 others: numbers at humidities, means and
// variations over them, and the differences of the two. CSV: what each set says.
//   ninja -C build/release model_part_bench
//   build/release/bench/model_part_bench designs 8 2612 > results/accuracy/model_part.csv
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "bench/drawn_design.h"
#include "design/design.h"
#include "estimate/belief.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"

using namespace papilla::tests;

namespace {

constexpr int kSets = 4, kManySkins = 24;
struct Asked {
  std::string name;
  std::function<std::optional<BeliefValues>(const Response&)> of;
};

std::vector<Asked> asked(std::size_t points) {
  std::vector<Asked> out;
  const QuantityMetric capillary{&PointQuantities::capillary_force};
  for (const auto& [name, metric] :
       {std::pair("friction_off", kFriction), std::pair("friction_on", kFrictionOn),
        std::pair("modulation", kModulation), std::pair("capillary_force", capillary)}) {
    for (std::size_t i = 0; i < points; ++i)
      out.push_back({fmt::format("{} at {}", name, i),
                     [i, m = metric](const Response& r) { return belief_values_at(i, m, r); }});
    for (const auto& [summary, of] :
         {std::pair("mean", Summary::Mean), std::pair("variation", Summary::Variation)})
      out.push_back({fmt::format("{}({})", summary, name),
                     [s = of, m = metric](const Response& r) { return belief_values(s, m, r); }});
  }
  return out;
}

Response with_members(const Design& design, const Response& answer, Fidelity fidelity, int first,
                      int skins) {
  fidelity.first_skin = first;
  fidelity.skins = skins;
  Response out = answer;
  add_belief(out, scene_of(design), design.texture, fidelity, skins);
  return out;
}

double spread(const StepSamples& moves) {
  double out = 0;
  for (const std::vector<double>& m : moves) out += square(mean_estimate(m).value);
  return std::sqrt(out);
}

BeliefValues minus(const BeliefValues& a, const BeliefValues& b) {
  BeliefValues out = a;
  for (std::size_t m = 0; m < out.moves.size(); ++m) {
    for (std::size_t k = 0; k < out.moves[m].size(); ++k) out.moves[m][k] -= b.moves[m][k];
  }
  return out;
}

// What 2 skins state over what 24 do.
class Table {
 public:
  void add(int draw, const std::string& texture, const std::string& name, bool difference, int set,
           const BeliefValues& values) {
    const double stated = values.deviation(), raw = spread(values.moves);
    rows_ += fmt::format("{},{},{},{},{},{},{:.5g},{:.5g}\n", draw, texture, name,
                         difference ? "difference" : "number", set == kSets ? kManySkins : 2, set,
                         stated, raw);
    std::vector<Reading>& of = few_[fmt::format("{} {} {}", draw, difference, name)];
    if (set < kSets) {
      of.push_back({stated, raw});
      return;
    }
    for (const Reading& few : of) {
      if (stated > 0)
        ratios_[{difference, few.spread > 1.2 * few.stated}].push_back(few.stated / stated);
    }
  }
  void print() {
    for (const auto& [of, ratios] : ratios_) {
      const auto share = [&, &r = ratios](auto&& is) {
        return 100.0 * static_cast<double>(std::count_if(r.begin(), r.end(), is)) /
               static_cast<double>(r.size());
      };
      fmt::print(
          "# {} whose moves {}: {} readings, 2 skins over 24: median {:.2f}, below half {:.0f} %, "
          "above twice {:.0f} %\n",
          of.first ? "differences" : "numbers",
          of.second ? "scatter as much as they move" : "are clear of their scatter", ratios.size(),
          quantile(ratios, 0.5), share([](double q) { return q < 0.5; }),
          share([](double q) { return q > 2; }));
    }
    fmt::print("draw,texture,number,of,skins,set,stated,spread of the members\n{}", rows_);
  }

 private:
  struct Reading {
    double stated, spread;
  };
  std::string rows_;
  std::map<std::string, std::vector<Reading>> few_;
  // [difference, whether more than a sixth of the spread is taken for scatter]
  std::map<std::pair<bool, bool>, std::vector<double>> ratios_;
};

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    fmt::print(stderr, "usage: model_part_bench DESIGNS COUNT SEED\n");
    return 2;
  }
  Table table;
  for (int d = 0; d < std::atoi(words[2]); ++d) {
    RandomStream random(std::strtoull(words[3], nullptr, 10), "model_part_bench",
                        static_cast<std::uint64_t>(d));
    std::array<Design, 2> designs{drawn_design(random, words[1], static_cast<std::size_t>(d)), {}};
    designs[1] = designs[0];
    moved_by_hand(random, designs[1]);
    const Fidelity fidelity = fidelity_level("draft");
    std::array<Response, 2> answers;
    for (std::size_t k = 0; k < 2; ++k)
      answers[k] = evaluate(scene_of(designs[k]), designs[k].texture, fidelity);
    const std::string texture(texture_name(designs[0].texture));
    for (int set = 0; set <= kSets; ++set) {
      const bool many = set == kSets;
      const int first = many ? 100 : 2 * set, skins = many ? kManySkins : 2;
      std::array<Response, 2> r;
      for (std::size_t k = 0; k < 2; ++k)
        r[k] = with_members(designs[k], answers[k], fidelity, first, skins);
      for (const Asked& a : asked(r[0].points.size())) {
        const auto one = a.of(r[0]), other = a.of(r[1]);
        if (!one || !other) continue;
        table.add(d, texture, a.name, false, set, *one);
        table.add(d, texture, a.name, true, set, minus(*one, *other));
      }
    }
    fmt::print(stderr, "draw {} of {}\n", d + 1, words[2]);
  }
  table.print();
}
