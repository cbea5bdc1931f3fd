// Swipes: recorded ones through the state machine, and rendered ones in a closed loop.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "cases/drive.h"
#include "cases/recording.h"

namespace papilla::cases {
namespace {

RecordedColumns force_columns() {
  return {{{"time", "s", false, {"t"}},
           {"lateral",
            "N",
            false,
            {"lateral_force", "lateral force", "tangential", "friction", "F_t", "Ft"}},
           {"normal", "N", false, {"normal_force", "normal force", "load", "F_n", "Fn"}}},
          true,
          "\"lateral,normal\" in N, or \"time,lateral,normal\" in s and N"};
}

struct Forces {
  double lateral, normal;  // [N]
};

// As the machine takes them: one a step, low-passed where the recording says when it was made.
std::vector<Forces> forces_of(const Recording& recording, const std::string& name, double step,
                              double filter) {
  const auto& rows = recording.rows;
  std::vector<Forces> out;
  if (rows[0].size() == 2) {
    for (const auto& row : rows) out.push_back({row[0], row[1]});
    return out;
  }
  const double taken = even_step(recording, name);
  if (filter > 0 && filter * taken >= 0.5) {
    throw InputError({Problem{
        name, 1, 1, "",
        fmt::format("taken every {:g} ms, too seldom for a low-pass of {:g} Hz: set swipe.filter "
                    "below {:g} Hz, or 0 where the forces are low-passed",
                    1e3 * taken, filter, 0.5 / taken)}});
  }
  std::vector<Forces> passed;
  std::vector<LowPass> low(2, LowPass(filter > 0 ? filter : 0.1 / taken, taken));
  for (const auto& row : rows) {
    passed.push_back(filter > 0 ? Forces{low[0](row[1]), low[1](row[2])} : Forces{row[1], row[2]});
  }
  const double duration = taken * static_cast<double>(rows.size() - 1);
  for (double time = 0; time <= duration; time = step * static_cast<double>(out.size())) {
    const auto before = std::min(static_cast<std::size_t>(time / taken), passed.size() - 2);
    const double share = time / taken - static_cast<double>(before);
    const Forces &a = passed[before], &b = passed[before + 1];
    out.push_back(
        {a.lateral + share * (b.lateral - a.lateral), a.normal + share * (b.normal - a.normal)});
  }
  return out;
}

void add_step(double time, SlipState state, double current, double step, Swipe& swipe) {
  if (current > 0) swipe.driven += step;
  if (swipe.steps.empty() || swipe.steps.back().state != state)
    swipe.steps.push_back({time, state, current});
}

}  // namespace

StictionOptions SwipeSettings::machine(double current) const {
  StictionOptions out;
  out.stuck_current = stuck * current;
  out.partial_current = partial * current;
  out.full_current = full * current;
  return out;
}

StictionOptions swipe_machine(const DriveCase& c) {
  if (c.drive.control != DriveControl::Current)
    throw InputError("stickiness is rendered by a current: set drive.control = \"current\"");
  return c.swipe.machine(c.drive.current);
}

Swipe run_swipe(const std::string& csv, const std::string& name, const StictionOptions& options,
                double filter) {
  StictionMachine machine(options);
  Swipe swipe;
  const auto forces =
      forces_of(read_recording(csv, name, force_columns()), name, options.step, filter);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double current = machine.update(forces[i].lateral, forces[i].normal);
    add_step(static_cast<double>(i) * options.step, machine.state(), current, options.step, swipe);
  }
  swipe.duration = static_cast<double>(forces.size()) * options.step;
  return swipe;
}

Swipe render_swipe(const DriveCase& c, const Network& network) {
  const StictionOptions options = swipe_machine(c);
  if (!c.recording.value.empty() || c.source.chirp_to > 0)
    throw InputError(
        "stickiness is rendered by the amplitude of a carrier, and a recording or a chirp is none: "
        "set no source.file and no source.chirp_to");
  const SwipeSettings& s = c.swipe;
  const RubbingFinger finger{c.touch.load, s.stroke, s.frequency,
                             s.stiffness,  s.filter, s.duration};
  Swipe swipe;
  swipe.without_tones = c.modulated();
  std::map<double, double> pulls;  // by current, of which each state has one
  swipe.samples = rub(finger, options, [&](double current) {
    const auto [pull, is_new] = pulls.try_emplace(current);
    if (is_new)
      pull->second = carrier_response(network, DriveControl::Current, c.drive.waveform, current,
                                      c.drive.frequency)
                         .mean_force;
    return c.touch.coefficient * (c.touch.load + pull->second);
  });
  for (const RubbingSample& at : swipe.samples)
    add_step(at.time, at.state, at.current, options.step, swipe);
  swipe.duration = s.duration;
  return swipe;
}

}  // namespace papilla::cases
