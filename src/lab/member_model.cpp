#include "lab/member_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/parallel.h"
#include "config/writer.h"
#include "estimate/belief.h"
#include "forward/forward.h"
#include "numerics/statistics.h"

namespace papilla::lab {
namespace {

constexpr std::size_t kNumbers = 4;  // of a member: off, on, and their errors

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

double share(const Measured& m) { return m.value > 0 ? m.parts.sampling / m.value : 0; }

}  // namespace

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

std::vector<Response> MemberModel::runs(const Design& design) const {
  const std::vector<Scene> scenes = belief_scenes(belief_, scene_of(design));
  Fidelity few = belief_fidelity(fidelity_of(design));
  few.threads = 1;  // a member each
  std::vector<Response> out(scenes.size());
  parallel_for(
      static_cast<int>(scenes.size()),
      [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const Watch quiet({}, nullptr);  // members are counted, not their skins
        out[k] = respond(scenes[k], few, solve_patches(scenes[k], design.texture, few));
      },
      threads_);
  return out;
}

std::vector<double> MemberModel::kept(const std::string& question, std::size_t size,
                                      const std::function<std::vector<double>()>& make) {
  const std::string key = text_hash(question);
  if (const std::string* found = kept_.find(key)) {
    std::vector<double> answer = read_numbers(*found);
    if (answer.size() == size) return answer;
  }
  std::vector<double> answer = make();
  ++evaluated_;
  kept_.keep(key, written(answer));
  return answer;
}

MemberFriction MemberModel::friction(const Design& design, const Conditions& at) {
  const Design there = under_conditions(design, at);
  const std::vector<double> answer =
      kept("friction at the design's level\n" + write_toml(to_table(there)),
           kNumbers * belief_.members.size(), [&] {
             if (note_)
               note_(fmt::format("{}, {}, at {} members", there.title, text(at),
                                 belief_.members.size()));
             const Scene scene = scene_of(there);
             const Fidelity wanted = fidelity_of(there), least = belief_fidelity(wanted);
             const ResponsePoint own = evaluate(scene, there.texture, wanted).points.front();
             const ResponsePoint few =
                 respond(scene, least, solve_patches(scene, there.texture, least)).points.front();
             std::vector<double> out;
             for (const Response& r : runs(there)) {
               const ResponsePoint& p = r.points.front();
               // A reading is of a force, which few pixels make too large by tens of percent: it is
               // as the design's own level has it, moved as the member moves it. Eq. accuracy.15
               const auto at_member = [&](Measured PointQuantities::*force) {
                 return moved((own.*force).value, (few.*force).value, (p.*force).value, true);
               };
               const bool off = p.knows_undriven() && own.knows_undriven(),
                          on = r.driven && p.knows_driven() && own.knows_driven();
               out.push_back(off ? at_member(&PointQuantities::friction_off) : std::nan(""));
               out.push_back(on ? at_member(&PointQuantities::friction_on) : std::nan(""));
               out.push_back(share(own.friction_off));
               out.push_back(share(own.friction_on));
             }
             return out;
           });
  MemberFriction out;
  std::vector<double> off_se, on_se;
  for (std::size_t i = 0; i < answer.size(); i += kNumbers) {
    out.off.push_back(answer[i]);
    if (at.driven()) out.on.push_back(answer[i + 1]);
    off_se.push_back(answer[i + 2]);
    on_se.push_back(answer[i + 3]);
  }
  out.off_se = quantile(off_se, 0.5);
  out.on_se = quantile(on_se, 0.5);
  return out;
}

std::vector<double> MemberModel::worth(const Design& design, const MetricExpression& expression) {
  Design own = design;
  own.finger.belief.clear();
  return kept("worth " + metric_text(expression) + "\n" + write_toml(to_table(own)),
              belief_.members.size(), [&] {
                if (note_)
                  note_(fmt::format("{}: {} at {} members", design.title, metric_text(expression),
                                    belief_.members.size()));
                const double sign = better_direction(expression) == Better::Lower ? -1 : 1;
                std::vector<double> out;
                for (const Response& r : runs(own)) {
                  const auto value =
                      summary_of_points(expression.summary, expression.metric, r.points);
                  out.push_back(value ? sign * *value : std::nan(""));
                }
                return out;
              });
}

}  // namespace papilla::lab
