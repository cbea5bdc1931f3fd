#include "lab/member_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/parallel.h"
#include "config/writer.h"
#include "estimate/belief.h"
#include "estimate/parameters.h"
#include "forward/forward.h"
#include "numerics/statistics.h"

namespace papilla::lab {
namespace {

// Hexadecimal, so that a number reads back to its last bit.
std::string written(const std::vector<double>& numbers) {
  std::string out;
  for (const double x : numbers) out += fmt::format("{:a} ", x);
  return out;
}

std::vector<double> read_numbers(const std::string& text) {
  std::vector<double> out;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double x = std::strtod(at, &end);
    if (end == at) return out;
    out.push_back(x);
  }
}

// More than `belief_fidelity` has: readings part designs by a few percent, which moves on two skins
// scatter by.
constexpr int kReadingSkins = 8;

// The design by its own finger at its own level, by its own finger as members are run, and by each
// member.
struct DesignRuns {
  Response own, few;
  std::vector<Response> members;
  std::vector<double> weights;
};

using Points = std::vector<ResponsePoint>;
// A number as the design's own level has it, moved as a member moves it among few skins and pixels,
// which make forces tens of percent too large. NaN: none. Eq. accuracy.15
using MovedNumber =
    std::function<double(const Points& own, const Points& few, const Points& member)>;

// Adds the deviations of a number's mean by the values without each skin, times a factor. Values
// that are none add nothing.
void add_deviations(double all, const std::vector<double>& without, double factor,
                    std::vector<double>& out) {
  if (without.empty()) return;
  for (const double move : error_moves(jackknife_samples(all, without)))
    out.push_back(std::isnan(move) ? 0 : factor * move);
}

// Eq. lab.3: what skins leave open is that of the design's own level, and on average over belief
// that of the members' moves.
MemberNumbers numbers_of(const DesignRuns& runs, const MovedNumber& number) {
  MemberNumbers out;
  const Points &own = runs.own.points, &few = runs.few.points;
  out.own = number(own, few, few);
  std::vector<double> without, &deviations = out.sampling.deviations;
  for (const Points& points : runs.own.without) without.push_back(number(points, few, few));
  add_deviations(out.own, without, 1, deviations);
  for (std::size_t m = 0; m < runs.members.size(); ++m) {
    const Response& member = runs.members[m];
    out.at.push_back(number(own, few, member.points));
    without.clear();
    for (std::size_t k = 0; k < member.without.size(); ++k)
      without.push_back(number(own, runs.few.without[k], member.without[k]));
    add_deviations(out.at.back(), without, std::sqrt(runs.weights[m]), deviations);
  }
  return out;
}

// As they are kept: own number, members, skins.
std::vector<double> listed(const MemberNumbers& numbers) {
  std::vector<double> out{numbers.own};
  out.insert(out.end(), numbers.at.begin(), numbers.at.end());
  out.insert(out.end(), numbers.sampling.deviations.begin(), numbers.sampling.deviations.end());
  return out;
}

// How many deviations a number has: by the skins of the design's own level, and by those that each
// member is moved on.
struct Deviations {
  std::size_t own = 0, all = 0;
};

// skins: what the deviations are of.
MemberNumbers unlisted(const double* from, std::size_t members, const Deviations& deviations,
                       const std::string& skins) {
  const double *at = from + 1, *of_skins = at + members;
  return {{at, of_skins}, *from, {skins, {of_skins, of_skins + deviations.all}}, deviations.own};
}

double moved_off(const Points& own, const Points& few, const Points& member) {
  const ResponsePoint& p = own.front();
  if (!p.knows_undriven() || !member.front().knows_undriven()) return std::nan("");
  return moved(p.friction_off.value, few.front().friction_off.value,
               member.front().friction_off.value, true);
}

// By what the voltage adds, which lies nearer to an evaluation of the member than the force in
// proportion. Eq. lab.15
double moved_on(const Points& own, const Points& few, const Points& member) {
  if (!own.front().knows_driven() || !member.front().knows_driven()) return std::nan("");
  const auto gain = [](const Points& points) {
    return points.front().friction_on.value / points.front().friction_off.value - 1;
  };
  return moved_off(own, few, member) * (1 + moved(gain(own), gain(few), gain(member), true));
}

}  // namespace

// Eq. lab.3: what a logarithm moves by is what its number does as a share of it, of a member's move
// of that member's number.
MemberNumbers logarithms(const MemberNumbers& numbers) {
  MemberNumbers out = numbers;
  out.own = std::log(numbers.own);
  for (double& x : out.at) x = std::log(x);
  std::vector<double>& deviations = out.sampling.deviations;
  const std::size_t own = numbers.own_skins, each = (deviations.size() - own) / numbers.at.size();
  for (std::size_t i = 0; i < deviations.size(); ++i)
    deviations[i] /= i < own ? numbers.own : numbers.at[(i - own) / each];
  return out;
}

MemberModel::MemberModel(Belief belief, const std::string& folder, int threads,
                         std::function<void(const std::string&)> note)
    : belief_(std::move(belief)),
      belief_text_(scene::belief_text(belief_)),
      threads_(threads),
      note_(std::move(note)) {
  if (!folder.empty()) kept_ = Unfinished(folder, PAPILLA_VERSION "\n" + belief_text_);
}

Design under_conditions(const Design& design, const Conditions& at) {
  Design out = design;
  out.finger.belief.clear();
  out.finger.load = at.load;
  out.finger.state = at.state;
  out.environment = {{at.relative_humidity}, {}};
  if (at.driven()) {
    out.drive.control = DriveControl::Voltage;
    out.drive.current = 0;
    out.drive.amplitude = at.voltage;
    out.drive.source_compliance = 0;
    if (at.frequency > 0) out.drive.frequency = at.frequency;
  } else {
    out.drive.amplitude = out.drive.current = 0;
  }
  return out;
}

namespace {

DesignRuns runs_of(const Design& design, const Belief& belief, int threads) {
  const Scene scene = scene_of(design);
  const Fidelity wanted = fidelity_of(design);
  DesignRuns out;
  out.own = evaluate(scene, design.texture, wanted);
  for (const BeliefMember& m : belief.members) out.weights.push_back(m.weight);
  std::vector<Scene> scenes = belief_scenes(belief, scene);
  scenes.push_back(scene);
  Fidelity few = belief_fidelity(wanted, kReadingSkins);
  few.threads = 1;  // a member each
  out.members.resize(scenes.size());
  parallel_for(
      static_cast<int>(scenes.size()),
      [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const Watch quiet({}, Watch::stop_of_piece());  // members are counted, not their skins
        out.members[k] = respond(scenes[k], few, solve_patches(scenes[k], design.texture, few));
      },
      threads);
  // What skins leave open of the level's own numbers is theirs too.
  take_felt_errors(out.own, out.own.points);
  for (Response& run : out.members) take_felt_errors(run, out.own.points);
  out.few = std::move(out.members.back());
  out.members.pop_back();
  return out;
}

Deviations deviations_of(const Design& design, std::size_t members) {
  const int skins = fidelity_of(design).skins;
  const auto own = static_cast<std::size_t>(skins);
  return {own, own + members * static_cast<std::size_t>(std::min(skins, kReadingSkins))};
}
// A design as an answer depends on it.
std::string asked_of(const Design& design) {
  return write_toml(to_table(design)) + maps_state(design);
}

// Those of the designs of a seed and a level are the same.
std::string skins_of(const Design& design) {
  const Fidelity f = fidelity_of(design);
  return fmt::format("{} skins of seed {}", f.skins, f.seed);
}

}  // namespace

std::optional<std::vector<double>> MemberModel::kept(const std::string& question,
                                                     std::size_t size) const {
  const std::string* found = kept_.find(text_hash(question));
  if (!found) return std::nullopt;
  std::vector<double> answer = read_numbers(*found);
  if (answer.size() != size) return std::nullopt;
  return answer;
}

std::vector<double> MemberModel::kept_or_made(const std::string& question, std::size_t size,
                                              const std::function<std::vector<double>()>& make) {
  if (const auto known = kept(question, size)) return *known;
  std::vector<double> answer = make();
  answer.resize(size, 0);  // of one skin: no deviations
  ++evaluated_;
  kept_.keep(text_hash(question), written(answer));
  return answer;
}

namespace {

// Friction of a design off and on, as it is kept.
struct FrictionAnswer {
  Design there;
  std::size_t members;
  Deviations deviations;

  FrictionAnswer(const LabDesign& design, const Conditions& at, const Belief& belief)
      : there(under_conditions(design.design, at)),
        members(belief.members.size()),
        deviations(deviations_of(there, members)) {}

  std::string question() const { return "friction with what skins leave open\n" + asked_of(there); }
  std::size_t each() const { return 1 + members + deviations.all; }
  MemberFriction read(const std::vector<double>& answer) const {
    const std::string skins = skins_of(there);
    return {unlisted(answer.data(), members, deviations, skins),
            unlisted(answer.data() + each(), members, deviations, skins)};
  }
};

}  // namespace

std::optional<MemberFriction> MemberModel::kept_friction(const LabDesign& design,
                                                         const Conditions& at) const {
  const FrictionAnswer of(design, at, belief_);
  const auto answer = kept(of.question(), 2 * of.each());
  return answer ? std::optional(of.read(*answer)) : std::nullopt;
}

MemberFriction MemberModel::friction(const LabDesign& design, const Conditions& at,
                                     const std::string& which) {
  const FrictionAnswer of(design, at, belief_);
  return of.read(kept_or_made(of.question(), 2 * of.each(), [&] {
    if (note_)
      note_(fmt::format("{}{}, {}, at {} members", which, design.name, text(at), of.members));
    const DesignRuns runs = runs_of(of.there, belief_, threads_);
    std::vector<double> out = listed(numbers_of(runs, moved_off)),
                        on = listed(numbers_of(runs, moved_on));
    out.insert(out.end(), on.begin(), on.end());
    return out;
  }));
}

MemberNumbers MemberModel::worth(const LabDesign& design, const MetricExpression& expression,
                                 const std::string& which) {
  Design own = design.design;
  own.finger.belief.clear();
  const std::size_t members = belief_.members.size();
  const Deviations deviations = deviations_of(own, members);
  const std::vector<double> answer = kept_or_made(
      "worth with what skins leave open " + metric_text(expression) + "\n" + asked_of(own),
      1 + members + deviations.all, [&] {
        if (note_)
          note_(fmt::format("{}{}, {}, at {} members", which, design.name, metric_text(expression),
                            members));
        const double sign = better_direction(expression) == Better::Lower ? -1 : 1;
        const bool size = keeps_sign(expression.summary, expression.metric);
        const auto number = [&](const Points& points) {
          return summary_of_points(expression.summary, expression.metric, points)
              .value_or(std::nan(""));
        };
        return listed(numbers_of(runs_of(own, belief_, threads_),
                                 [&](const Points& o, const Points& few, const Points& member) {
                                   const double at_own = number(o);
                                   if (std::isnan(at_own)) return at_own;
                                   return sign * moved(at_own, number(few), number(member), size);
                                 }));
      });
  return unlisted(answer.data(), members, deviations, skins_of(own));
}

}  // namespace papilla::lab
