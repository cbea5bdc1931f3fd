#include "search/tasks.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "design/families.h"
#include "search/space.h"

namespace papilla::search {
namespace {

// A frequency that no task feels is no variable.
void check_frequency(const Study& study, const std::vector<StudyTask>& tasks) {
  if (std::any_of(study.variables.begin(), study.variables.end(),
                  [](const Variable& v) { return v.path == "drive.frequency"; })) {
    const auto deaf = [&](const StudyTask& t) {
      return !frequency_not_felt(task_design(study, study.design, t)).empty();
    };
    if (std::all_of(tasks.begin(), tasks.end(), deaf)) {
      throw InputError("design_space: drive.frequency has no effect: " +
                       frequency_not_felt(task_design(study, study.design, tasks.front())) +
                       "; leave the variable out, or give film, gap or finger what it conducts");
    }
  }
}

// What all scenarios set is the same for every design.
void check_scenarios(const Study& study) {
  const auto counts = std::count_if(study.scenarios.begin(), study.scenarios.end(),
                                    [](const Scenario& s) { return s.weight > 0; });
  for (const Variable& v : study.variables) {
    const std::vector<std::string> setting = scenarios_setting(study, v.path);
    if (setting.empty() || static_cast<std::ptrdiff_t>(setting.size()) < counts) continue;
    throw InputError(fmt::format(
        "scenarios: {} {} {}, which design_space varies, so that all designs are alike in it; "
        "leave the variable out, or the setting of one scenario",
        join_names(setting), setting.size() > 1 ? "set" : "sets", v.path));
  }
}

// The study's own design under the largest drive that is searched.
Design most_driven(const Study& study) {
  std::vector<Setting> drive;
  for (const Variable& v : study.variables) {
    if (!v.path.starts_with("drive.")) continue;
    const std::vector<double>& c = v.choices;
    drive.push_back({v.path, c.empty() ? v.high : *std::max_element(c.begin(), c.end())});
  }
  return with_settings(study.design, drive);
}

// The same surface without its relief. A lattice keeps a picometre of it, so that it is judged on
// the patch and the skins of the lattice: the difference is the texture's, not that of other skins.
Texture without_relief(Texture texture) {
  constexpr double kNone = 1e-12;  // [m]
  double* depth = roles(texture).depth;
  if (depth) *depth = std::min(*depth, kNone);
  return depth || !facts(texture).relief.present ? texture : Texture{};
}

// A measure of a texture that is not there: nobody makes it, so that nobody misses it.
bool has_no_relief(const Design& design, const std::string& path) {
  if (!path.starts_with("texture.")) return false;
  const Relief relief = facts(part_at(design.texture, path)).relief;
  return !relief.present || (relief.planes && *relief.height() < kLeastDepth);
}

}  // namespace

std::vector<StudyTask> study_tasks(const Study& study) {
  std::vector<StudyTask> tasks;
  const bool pin = study.design.counterface.in_place() != nullptr;
  if (pin && !study.population.empty())
    throw InputError(
        "population: a pin stands in place of fingers (counterface.type); leave the fingers out, "
        "or "
        "describe the pin under [counterface.pen] and judge it beside them");
  const std::vector<Finger> fingers = study.population.empty()
                                          ? std::vector<Finger>{scene_of(study.design).finger}
                                          : study.population;
  const std::vector<Scenario> scenarios =
      study.scenarios.empty() ? std::vector<Scenario>{Scenario{}} : study.scenarios;
  const Design most = most_driven(study);
  for (const Scenario& scenario : scenarios) {
    if (scenario.weight <= 0) continue;  // it counts for nothing
    const bool driven = with_settings(most, scenario.set).drive.driven();
    for (const Finger& finger : fingers) {
      tasks.push_back({scenario.name.empty() ? finger.name : finger.name + ", " + scenario.name,
                       scenario.weight, finger, scenario.set});
      tasks.back().driven = driven;
    }
  }
  const std::size_t nominal = tasks.size();
  for (std::size_t t = 0; t < nominal; ++t) {
    for (std::size_t k = 0; k < study.scatter.size(); ++k) {
      for (int sign : {-1, 1}) {
        StudyTask task = tasks[t];
        task.name += fmt::format(", {} {}", study.scatter[k].path, sign < 0 ? "low" : "high");
        task.scattered = static_cast<int>(k);
        task.sign = sign;
        tasks.push_back(std::move(task));
      }
    }
  }
  if (tasks.empty()) throw InputError("scenarios: at least one weight above 0 is needed");
  check_scenarios(study);
  check_frequency(study, tasks);
  return tasks;
}

Design task_design(const Study& study, Design d, const StudyTask& task, bool flat) {
  if (!d.counterface.in_place()) d.finger = task.finger;
  d = with_settings(std::move(d), task.settings);  // a scenario may change the finger too
  if (flat) d.texture = without_relief(std::move(d.texture));
  if (task.nominal()) return d;
  std::vector<double> deviation(study.scatter.size(), 0.0);
  deviation[static_cast<std::size_t>(task.scattered)] = task.sign;
  return Plates(study, d).plate(deviation);
}

Plates::Plates(const Study& study, const Design& design) : design_(design) {
  const std::vector<NumberField> known = number_fields(design_);
  for (const Scatter& scatter : study.scatter) {
    const std::string path = path_in(known, scatter.path);
    if (path.empty() || has_no_relief(design_, path)) {
      numbers_.push_back({});
      continue;
    }
    const NumberField field = find_number_field(known, path);
    const double unit = find_unit(field.unit)->to_si;
    numbers_.push_back(
        {field.value, *field.value, scatter.end(), field.low * unit, field.high * unit});
  }
}

const Design& Plates::plate(const std::vector<double>& deviation) {
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const Number& n = numbers_[k];
    if (n.value) *n.value = std::clamp(n.nominal + deviation[k] * n.end, n.low, n.high);
  }
  return design_;
}

std::string shape_trouble(const Study& study, const std::vector<StudyTask>& tasks,
                          const Design& design) {
  if (const auto wrong = design_problems(design); !wrong.empty())
    return wrong.front().path + ": " + wrong.front().message;
  if (study.scatter.empty()) return {};
  // Shapes are the same for every finger. All ends are of one design: a search asks this of
  // thousands of shapes, and to make a design takes longer than to judge it.
  Plates plates(study, task_design(study, design, tasks.front()));
  std::vector<double> deviation(study.scatter.size(), 0.0);
  for (double& one : deviation) {
    for (const int sign : {-1, 1}) {
      one = sign;
      if (const auto wrong = design_problems(plates.plate(deviation)); !wrong.empty())
        return wrong.front().path + ": within the scatter, " + wrong.front().message;
    }
    one = 0;
  }
  return {};
}

std::string frequency_not_felt(const Design& design) {
  if (design.drive.waveform == Waveform::Dc) return "the drive is a direct voltage";
  if (design.drive.control == DriveControl::Current) return "";
  const Scene scene = scene_of(design);
  const ElectricalLayer& finger = scene.finger.electrical;
  if (finger.skin_exponent != 1) return "";  // disperses at every frequency
  double corner = std::max(finger.corner_frequency, corner_frequency(1, finger.gap_resistivity));
  for (const FilmDielectric& layer : design.surface.dielectric) {
    if (layer.relaxation.law != RelaxationLaw::None) return "";
    corner = std::max(corner, layer.corner_frequency());
  }
  constexpr double kSlowest = 1;  // [Hz] nobody drives a screen below
  if (corner > kSlowest) return "";
  return "neither film nor gap nor skin conducts (surface.dielectric.resistivity, "
         "finger.electrical.gap_resistivity, finger.electrical.corner_frequency)";
}

}  // namespace papilla::search
