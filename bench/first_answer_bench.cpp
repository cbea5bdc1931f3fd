// First answers of the studio against refined ones: designs of all kinds, bare and under a film,
// drawn by a seed, in groups of three that differ by some numbers. Each is refined, stands alone
// and is carried by each other of its group. CSV: what the first answer said, its standard error,
// what it was made of, the refined value.
//   ninja -C build/release first_answer_bench
//   build/release/bench/first_answer_bench designs 30 2613 > results/studio/bands.csv
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "base/random.h"
#include "bench/drawn_design.h"
#include "design/design.h"
#include "estimate/difference.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "studio/first_answer.h"

using namespace papilla::tests;

namespace {

constexpr int kOfGroup = 3;
struct Number {
  const char* name;
  QuantityMetric metric;
};
constexpr std::array<Number, 3> kNumbers{
    {{"friction_off", kFriction}, {"friction_on", kFrictionOn}, {"modulation", kModulation}}};

struct Drawn {
  Anchor anchor;
  std::string moved;  // what was, since the one before
};

Drawn answered(const Design& design, std::string moved) {
  Fidelity fidelity = fidelity_level("design");
  fidelity.seed = quick_fidelity(design).seed;
  return {anchor_of(design, evaluate(scene_of(design), design.texture, fidelity)),
          std::move(moved)};
}

struct Count {
  int inside = 0, readings = 0;
  double squares = 0;  // of errors over standard errors
};

class Table {
 public:
  // from: whose anchor carries it; null: it stands alone.
  void add(std::size_t group, const Drawn& d, const Drawn* from) {
    const Design& design = d.anchor.design;
    const Response& refined = d.anchor.refined;
    const Anchor* const anchor = from ? &from->anchor : nullptr;
    if (anchor && !carries(*anchor, design)) return;
    const Response quick = quick_answer(design, anchor);
    seconds_[anchor != nullptr].push_back(quick.seconds);
    const Response first = first_answer(quick, design, anchor);
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      if (refined.points[i].status.pull_in()) continue;
      for (const Number& n : kNumbers) {
        const auto at = [&](const Response& r) { return r.points[i].*n.metric.quantity; };
        const Measured answer = at(first);
        const double fine = at(refined).value;
        if (fine == 0 || answer.value == 0) continue;
        const double z = (answer.value - fine) / answer.se();
        const QuickMove moved =
            anchor ? quick_move(i, n.metric, anchor->quick, quick) : QuickMove{};
        rows_ += fmt::format(
            "{},{},{},{},{},{:.0f},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.4g},{:.4g},{}\n", group,
            texture_name(design.texture), quick_fidelity(design).grid, from ? d.moved : "",
            from ? "carried" : "alone", 100 * first.points[i].relative_humidity, n.name,
            answer.value, answer.se(), fine, at(quick).value, moved.logarithm, moved.error,
            std::abs(z) <= 2 ? "yes" : "no");
        for (const std::string& of :
             {std::string(n.name),
              fmt::format("{} at {:.0f} %", n.name, 100 * first.points[i].relative_humidity)}) {
          Count& c = counts_[(from ? "carried, " : "alone, ") + of];
          ++c.readings, c.inside += std::abs(z) <= 2, c.squares += z * z;
        }
      }
    }
  }
  void print() const {
    for (const auto& [of, c] : counts_)
      fmt::print("# {}: {} of {} inside two standard errors, rms {:.2f} of one\n", of, c.inside,
                 c.readings, std::sqrt(c.squares / c.readings));
    fmt::print(
        "group,texture,pixels,moved,first answer,humidity [%],number,first,standard error,refined,"
        "quick,quick moved,its error,inside\n{}",
        rows_);
    for (const bool carried : {false, true}) {
      std::vector<double> seconds = seconds_[carried];
      std::sort(seconds.begin(), seconds.end());
      fmt::print(stderr, "{}: {:.4f} s a quick answer in the median\n",
                 carried ? "carried" : "alone", seconds[seconds.size() / 2]);
    }
  }

 private:
  std::string rows_;
  std::map<std::string, Count> counts_;
  std::array<std::vector<double>, 2> seconds_;  // alone, carried
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "first_answer_bench DESIGNS GROUPS SEED\n");
    return 2;
  }
  Table table;
  for (std::size_t group = 0; group < std::strtoul(argv[2], nullptr, 10); ++group) {
    RandomStream random(std::strtoul(argv[3], nullptr, 10), "first_answer_bench", group);
    std::vector<Drawn> of_group{answered(drawn_design(random, argv[1], group), "")};
    while (of_group.size() < kOfGroup) {
      Design next = of_group.back().anchor.design;
      std::string moved = moved_by_hand(random, next);
      if (random.below(2) == 1) moved = fmt::format("{} {}", moved, moved_by_hand(random, next));
      of_group.push_back(answered(next, moved));
    }
    for (const Drawn& d : of_group) {
      table.add(group, d, nullptr);
      for (const Drawn& from : of_group) {
        if (&from != &d) table.add(group, d, &from);
      }
    }
    fmt::print(stderr, "group {} of {}\n", group + 1, argv[2]);
  }
  table.print();
}
