// First answers of the studio against refined ones: designs of all kinds, bare and under a film,
// drawn by a seed, in groups of three that differ by some numbers. Each is refined, stands alone
// and is carried by each other of its group. CSV: what the first answer said, its standard error,
// what it was made of, the refined value.
//   ninja -C build first_answer_bench
//   build/bench/first_answer_bench designs 30 2612 > results/studio/bands.csv
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
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
  Design design;
  std::string moved;  // what was, since the one before
  Response quick, refined;
};

Drawn answered(Design design, std::string moved) {
  Drawn out{std::move(design), std::move(moved), {}, {}};
  const Scene scene = scene_of(out.design);
  const Fidelity quick = quick_fidelity(out.design);
  out.quick = respond(scene, quick, solve_patches(scene, out.design.texture, quick));
  Fidelity design_level = fidelity_level("design");
  design_level.seed = quick.seed;
  out.refined = evaluate(scene, out.design.texture, design_level);
  return out;
}

struct Count {
  int inside = 0, readings = 0;
  double squares = 0;  // of errors over standard errors
};

class Table {
 public:
  // from: whose anchor carries it; null: it stands alone.
  void add(std::size_t group, const Drawn& d, const Drawn* from) {
    const std::optional<Anchor> anchor =
        from ? std::optional(Anchor{from->design, from->quick, from->refined}) : std::nullopt;
    if (anchor && !carries(*anchor, d.design)) return;
    const Response first = first_answer(d.quick, d.design, anchor);
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      if (d.refined.points[i].status.pull_in()) continue;
      for (const Number& n : kNumbers) {
        const auto at = [&](const Response& r) { return r.points[i].*n.metric.quantity; };
        const Measured answer = at(first);
        const double fine = at(d.refined).value;
        if (fine == 0 || answer.value == 0) continue;
        const double z = (answer.value - fine) / answer.se();
        const QuickMove moved = from ? quick_move(i, n.metric, from->quick, d.quick) : QuickMove{};
        rows_ += fmt::format(
            "{},{},{},{},{},{:.0f},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.4g},{:.4g},{}\n", group,
            texture_name(d.design.texture), quick_fidelity(d.design).grid, from ? d.moved : "",
            from ? "carried" : "alone", 100 * first.points[i].relative_humidity, n.name,
            answer.value, answer.se(), fine, at(d.quick).value, moved.logarithm, moved.error,
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
  }

 private:
  std::string rows_;
  std::map<std::string, Count> counts_;
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
      Design next = of_group.back().design;
      std::string moved = moved_by_hand(random, next);
      if (random.below(2) == 1) moved = fmt::format("{} {}", moved, moved_by_hand(random, next));
      of_group.push_back(answered(std::move(next), moved));
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
