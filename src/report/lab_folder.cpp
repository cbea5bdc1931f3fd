#include "report/lab_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/lab_trace.h"
#include "report/lab_words.h"

namespace papilla::report {
namespace {

// Weights below this share of all are no members of the written belief.
constexpr double kLeastWeight = 1e-6;

std::string plan_name(std::size_t number) { return fmt::format("plan_{:02}.csv", number); }

std::string belief_now(Lab& lab) {
  Belief belief = lab.belief();
  const std::vector<double>& weights = lab.standing().weights;
  double sum = 0;
  for (const double w : weights) sum += w < kLeastWeight ? 0 : w;
  std::vector<BeliefMember> members;
  for (std::size_t m = 0; m < weights.size(); ++m) {
    if (weights[m] < kLeastWeight) continue;
    members.push_back(belief.members[m]);
    members.back().weight = weights[m] / sum;
  }
  belief.members = std::move(members);
  for (const FrictionReading& r : lab.readings())
    belief.readings.push_back(reading_text(r.experiment.at.load, r.experiment.at.relative_humidity,
                                           r.experiment.at.voltage, r.off, r.on));
  belief.made_of += fmt::format("; weighted by {} of a lab",
                                counted(static_cast<long long>(lab.readings().size()), "reading"));
  belief.effective_samples = lab.standing().effective_members;
  belief.samples = static_cast<double>(weights.size());
  return "# " + lab.file().belief + " after the readings of this lab; see lab.md.\n" +
         belief_text(belief);
}

// All but the journal, lab.toml, designs and pictures. A plan that people fill in is written once.
void write_lab(Lab& lab) {
  const Folder& folder = lab.folder();
  std::size_t plans = 0;
  for (const JournalEntry& e : lab.entries()) {
    if (!e.plan) continue;
    const std::string name = plan_name(++plans);
    if (!folder.has(name)) folder.write(name, lab_plan_csv(lab, *e.plan));
  }
  folder.write("readings.csv", lab_readings_csv(lab));
  folder.write("belief.toml", belief_now(lab));
  if (const std::string picture = decisions_svg(lab); !picture.empty())
    folder.write("decisions.svg", picture);
  folder.write("lab.json", lab_state_json(lab) + "\n");
  folder.write("lab.md", lab_page(lab));
}

// A name that says its file, and no other record's.
std::string picture_name(const Told& told) {
  return "traces/" + std::filesystem::path(told.record.file).stem().string() + "-" +
         told.record.sha256.substr(0, 8) + ".svg";
}

void write_picture(const Lab& lab, const Told& told) {
  if (!told.trace) return;
  lab.folder().made_below("traces");
  lab.folder().write(picture_name(told),
                     trace_svg(*told.trace, *told.sliding, *told.reading, told.record.file));
}

std::string folder_for(const NextRun& run) {
  if (!run.folder.empty()) return run.folder;
  std::filesystem::path path(run.source.paths.front());
  if (!path.has_filename()) path = path.parent_path();
  return "labs/" + path.stem().string();
}

void tell_damage(const Lab& lab, const std::function<void(const std::string&)>& note) {
  if (lab.lost() > 0 && note)
    note(fmt::format("{} of the journal were damaged and are cut off; it is kept as it was in {}",
                     counted(lab.lost(), "record"), lab.kept_copy()));
}

}  // namespace

NextReport next_in_lab(const NextRun& run) {
  NextReport out;
  const auto note = [&](const std::string& text) {
    if (run.note) run.note(text);
  };
  const std::vector<std::string>& paths = run.source.paths;
  const bool goes_on = paths.size() == 1 && is_lab(paths.front());
  if (goes_on && !run.folder.empty())
    throw InputError(paths.front() +
                     ": is a lab, which goes on in its own folder: leave --lab out, which names "
                     "that of a new one");
  out.folder = goes_on ? paths.front() : folder_for(run);
  if (!goes_on && has_begun(out.folder))
    throw InputError(out.folder + ": is a lab already; `papilla next " + out.folder +
                     "` goes on with it, --lab names another folder");
  LabSource alone;
  alone.paths = paths;
  if (goes_on && run.source != alone)
    throw InputError(out.folder +
                     ": is a lab, which has its belief, worth, conditions and values: "
                     "change " +
                     out.folder + "/lab.toml");
  if (!goes_on) {
    const LabOpening opening = lab_opening(run.source);
    for (const std::string& n : opening.notes) note(n);
    open_lab(out.folder, opening.opening);
  }
  Lab lab(out.folder, run.threads, run.note);
  tell_damage(lab, run.note);
  const PlanRecord plan = lab.next(run.options);
  write_lab(lab);
  std::size_t plans = 0;
  for (const JournalEntry& e : lab.entries()) plans += e.plan.has_value();
  out.markdown = lab_plan_text(lab, plan);
  if (!plan.experiments.empty())
    out.markdown += fmt::format("\nFill in {}/{} and give it to `papilla tell {}`.\n", out.folder,
                                plan_name(plans), out.folder);
  out.json = lab_plan_json(lab, plan);
  out.stop = plan.stop;
  return out;
}

TellReport tell_lab(const TellRun& run) {
  Lab lab(run.folder, run.threads, run.note);
  tell_damage(lab, run.note);
  TellReport out;
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const std::string& file : run.files) {
    try {
      const Told told = lab.tell(file, run.options, [&](const Told& t) { write_picture(lab, t); });
      out.markdown += (out.markdown.empty() ? "" : "\n") + lab_told_text(lab, told);
      if (told.trace && told.after)
        out.markdown += "Picture: " + run.folder + "/" + picture_name(told) + "\n";
      files.push_back(nlohmann::ordered_json::parse(lab_told_json(lab, told)));
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) out.refused.push_back(p);
    }
  }
  write_lab(lab);
  if (!out.markdown.empty())
    out.markdown += "\n# Where the lab stands\n\n" + lab_standing_text(lab);
  out.json = nlohmann::ordered_json{{"schema", 1},
                                    {"files", std::move(files)},
                                    {"state", nlohmann::ordered_json::parse(lab_state_json(lab))}}
                 .dump(1);
  return out;
}

NextReport lab_state(const std::string& folder, int threads) {
  Lab lab(folder, threads);
  return {folder, lab_page(lab), lab_state_json(lab), false};
}

}  // namespace papilla::report
