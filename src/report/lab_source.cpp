#include "report/lab_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "calibrate/calibration_file.h"
#include "claims/claim.h"
#include "config/reader.h"
#include "design/study.h"
#include "metrics/metrics.h"
#include "search/records.h"

namespace papilla::report {
namespace {

namespace fs = std::filesystem;

class LabOpener {
 public:
  explicit LabOpener(const LabSource& source) : source_(source) {}

  LabOpening open() {
    // A run first, however they are named: other designs beside it are controls, as it knows
    // nothing of what they are worth.
    std::vector<std::string> paths = source_.paths;
    std::stable_partition(paths.begin(), paths.end(), is_run);
    for (const std::string& path : paths) take(path);
    if (designs_.empty()) throw InputError("no design to measure");
    refuse_pins();
    set_belief();
    set_conditions();
    set_worth();
    LabFile& file = out_.opening.file;
    file.source = join_names(opened_with_, " ");
    file = with_values(file, source_.values);
    out_.opening.designs = designs_;
    return std::move(out_);
  }

 private:
  LabFile& file() { return out_.opening.file; }
  void note(const std::string& text) { out_.notes.push_back(text); }

  // A design goes by its name here: its file may be one of the moment, and the lab has its own
  // copy.
  void take(const std::string& path) {
    opened_with_.push_back(path);
    const bool folder = fs::is_directory(path);
    if (is_run(path)) return take_run(path);
    if (folder && fs::is_regular_file(path + "/manifest.csv"))
      return take_manifest(path + "/manifest.csv");
    if (path.ends_with(".csv")) return take_manifest(path);
    if (folder)
      throw InputError(path + ": neither a run (run.json), nor a wafer (manifest.csv), nor a lab" +
                       search::unfinished_hint(Folder(path)));
    if (is_calibration(path)) return take_calibration(path);
    opened_with_.back() =
        file().designs[add(fs::path(path).stem().string(), read_design(path), !has_run())].name;
  }

  static bool is_run(const std::string& path) {
    return fs::is_directory(path) && fs::is_regular_file(path + "/run.json");
  }
  bool has_run() const { return out_.opening.worth.has_value(); }

  static bool is_calibration(const std::string& path) {
    return load_document(own_or_shipped(path), {}, design_roots()).has("parameters");
  }

  // Under a name whose file no other has; the index of the design.
  std::size_t add(const std::string& plain, const Design& design, bool choice) {
    const auto file_of = [](std::string name) {
      std::replace(name.begin(), name.end(), '/', '_');
      return "designs/" + name + ".toml";
    };
    const auto taken = [&](const std::string& name) {
      return std::any_of(file().designs.begin(), file().designs.end(),
                         [&](const DesignEntry& d) { return d.file == file_of(name); });
    };
    std::string name = plain;
    for (int k = 2; taken(name); ++k) name = fmt::format("{}-{}", plain, k);
    file().designs.push_back({name, file_of(name), choice});
    designs_.push_back(design);
    return designs_.size() - 1;
  }

  void take_run(const std::string& path) {
    if (has_run())
      throw InputError(path +
                       ": a second run: what designs of one are worth is not known beside "
                       "those of another; open a lab for each");
    const Folder folder(path);
    try {
      const auto run = nlohmann::ordered_json::parse(folder.read("run.json"));
      if (!run.contains("decision")) refuse_undecided(path, folder, run);
      take_decision(path, folder, run);
    } catch (const nlohmann::ordered_json::exception& e) {
      throw InputError(fmt::format(
          "{0}/run.json is damaged: {1}; put back a copy of it, or let `papilla optimize STUDY "
          "--out {0} --resume` write it anew from the journal",
          path, e.what()));
    }
    take_study(folder);
  }

  // A run that was interrupted, has found nothing to decide among, or is not of this version.
  [[noreturn]] static void refuse_undecided(const std::string& path, const Folder& folder,
                                            const nlohmann::ordered_json& run) {
    if (run.value("interrupted", false)) {
      const std::string hint = search::unfinished_hint(folder);
      throw InputError(path + ": no decision in it" +
                       (hint.empty() ? "; its run was interrupted: search again" : hint));
    }
    const bool none = run.contains("receipts")
                          ? run.at("receipts").is_null()
                          : run.contains("finalists") && run.at("finalists").empty();
    if (none)
      throw InputError(path +
                       ": no decision in it, as it found no design to recommend; loosen a limit or "
                       "give the search more room or time, and search again");
    throw InputError(path +
                     "/run.json: no decision in it, as another version of this program writes it; "
                     "`papilla optimize` with the same study and --resume writes it anew");
  }

  // Why a run has not judged its designs over belief, and what to do about it: the reason says that
  // itself, but where no design keeps the limits.
  [[noreturn]] static void refuse_unjudged(const std::string& path,
                                           const nlohmann::ordered_json& run,
                                           const std::string& reason) {
    const std::string what = path + ": no decision by belief: " + reason;
    const auto& finalists = run.at("finalists");
    const bool any_keeps = std::any_of(finalists.begin(), finalists.end(), [](const auto& f) {
      return f.at("folder") != "";  // those of the front have one
    });
    if (!any_keeps)
      throw InputError(what + "; loosen a limit or give the search more room, and search again");
    throw InputError(what + "; then search again");
  }

  void take_decision(const std::string& path, const Folder& folder,
                     const nlohmann::ordered_json& whole) {
    const nlohmann::ordered_json& run = whole.at("decision");
    if (const std::string absent = run.value("absent", ""); !absent.empty())
      refuse_unjudged(path, whole, absent);
    RunWorth worth;
    worth.name = run.value("worth", "");
    for (const auto& [name, design] : run.at("designs").items()) {
      if (!design.contains("worth_at_members"))
        throw InputError(path +
                         "/run.json: without what its designs are worth at each member; "
                         "`papilla optimize` with the same study adds it, nothing is "
                         "evaluated again");
      const std::size_t index = add(name, read_design(folder.file(name + "/design.toml")), true);
      worth.designs.push_back(file().designs[index].name);
      std::vector<double>& row = worth.worth.emplace_back();
      for (const auto& x : design.at("worth_at_members"))
        row.push_back(x.is_null() ? std::nan("") : x.get<double>());
      worth.kept.push_back(design.at("limits_kept_at_members").get<std::vector<bool>>());
      worth.by_skin.push_back(design.value("worth_moved_by_skins", std::vector<double>()));
      std::vector<RunLimit>& limits = worth.limits.emplace_back();
      const auto of_design = design.value("p_limits", nlohmann::ordered_json::object());
      for (const auto& [limit, probability] : of_design.items())
        limits.push_back({limit, probability.get<double>()});
    }
    if (folder.has("best/build.toml")) {
      const Design best = read_design(folder.file("best/design.toml"));
      for (std::size_t i = 0; i < designs_.size(); ++i) {
        if (is_same(designs_[i], best)) built_ = {i, read_design(folder.file("best/build.toml"))};
      }
    }
    file().worth = worth.name;
    file().worth_file = "worth.json";
    out_.opening.worth = std::move(worth);
  }

  // The study of the run says what decides, and how surely its limits are to be kept.
  void take_study(const Folder& folder) {
    if (!folder.has("resolved.toml")) return;
    Document study = load_document(folder.file("resolved.toml"), {}, design_roots());
    StudyRisk risk;
    read_section(study, "risk", risk);
    file().risk = risk.belief;
    file().limits = risk.limits;
  }

  static bool is_same(const Design& a, const Design& b) {
    return a.texture == b.texture && a.surface == b.surface;
  }

  // Fields of a wafer. A design that a run has brought already is that one, and so is the run's
  // best with the rounded numbers that it is built with.
  void take_manifest(const std::string& path) {
    const MeasuredTable table = read_measured_table(read_bytes(path, std::size_t{1} << 26), path);
    std::vector<Problem> problems;
    std::map<std::string, std::size_t> known;
    std::map<std::string, std::string> held;  // design of each field
    for (const MeasuredRow& row : table.rows) {
      const auto problem = [&](const char* key, const std::string& message) {
        problems.push_back({path, row.line, 0, key, message});
      };
      if (row.field.empty()) problem("field", "a row without a label");
      if (row.design.empty()) problem("design", "a row without a design");
      if (!row.load) problem("load", "a row without a load");
      if (!row.relative_humidity) problem("humidity", "a row without a humidity");
      if (row.field.empty() || row.design.empty() || !row.load || !row.relative_humidity) continue;
      if (const auto& there = held.emplace(row.field, row.design).first->second;
          there != row.design)
        problem("design", fmt::format("{} holds {} in a line before", row.field, there));
      if (!known.count(row.design)) {
        const std::string at = (fs::path(path).parent_path() / row.design).string();
        try {
          known[row.design] = same_or_new(row.design, read_design(at));
        } catch (const InputError& error) {
          for (const Problem& p : error.problems()) problems.push_back(p);
          continue;
        }
      }
      file().fields.push_back({row.field, file().designs[known[row.design]].name, *row.load,
                               *row.relative_humidity, row.voltage.value_or(0),
                               row.frequency.value_or(0), row.state.value_or(FingerState::Clean)});
    }
    if (!problems.empty()) throw InputError(problems);
    keep_labels_apart(path, held);
    for (const std::string& n : table.notes) note(fs::path(path).filename().string() + ": " + n);
  }

  // A reading is told by the label of its field: what two wafers have alike could be of either.
  void keep_labels_apart(const std::string& path, const std::map<std::string, std::string>& held) {
    std::vector<std::string> alike;
    std::string other;
    for (const auto& [label, design] : held) {
      const auto [known, is_new] = labels_.emplace(label, path);
      if (is_new) continue;
      alike.push_back(label);
      other = known->second;
    }
    if (alike.empty()) return;
    constexpr std::size_t kShown = 3;
    const std::size_t more = alike.size() - std::min(alike.size(), kShown);
    alike.resize(alike.size() - more);
    throw InputError({Problem{
        path, 0, 0, "field",
        fmt::format("{}{}: also on the wafer of {}; a reading that is told by its field could "
                    "be of either. Open a lab for each wafer, or name a copy of this "
                    "manifest, beside it, with labels of its own (2{})",
                    join_names(alike), more > 0 ? fmt::format(" and {} more", more) : "", other,
                    alike.front())}});
  }

  std::size_t same_or_new(const std::string& name, const Design& design) {
    for (std::size_t i = 0; i < designs_.size(); ++i) {
      if (is_same(designs_[i], design)) return i;
    }
    if (built_ && is_same(built_->design, design)) {
      Design& best = designs_[built_->choice];  // what is measured is what was built
      best.texture = design.texture;
      best.surface = design.surface;
      note(file().designs[built_->choice].name + " stands on the wafer with rounded numbers");
      return built_->choice;
    }
    return add(fs::path(name).stem().string(), design, !has_run());
  }

  void take_calibration(const std::string& path) {
    const Calibration c = read_calibration(path, m3_claim_ids());
    std::vector<std::string> files;
    CandidateConditions& at = file().conditions;
    const auto once = [](auto& values, const auto& v) {
      if (std::find(values.begin(), values.end(), v) == values.end()) values.push_back(v);
    };
    for (const FrictionDatum& d : c.data) {
      Design design = read_design(d.design);
      const FingerState state = d.state.value_or(design.finger.state);
      once(at.load, d.load);
      once(at.humidity, d.relative_humidity);
      once(at.voltage, d.amplitude);
      once(at.states, finger_state_names()[static_cast<std::size_t>(state)]);
      if (std::find(files.begin(), files.end(), d.design) != files.end()) continue;
      files.push_back(d.design);
      design.finger = c.finger;
      design.finger.state = state;
      add(fs::path(d.design).stem().string(), design, false);
    }
    if (files.empty())
      throw InputError(path +
                       ": a fit to published numbers alone names no design to measure; name "
                       "design files, with --belief");
    calibrated_ = true;
    if (source_.belief.empty()) {
      const std::string fitted = "results/" + fs::path(path).stem().string() + "/belief.toml";
      if (!fs::is_regular_file(fitted))
        throw InputError(path + ": no " + fitted +
                         "; run `papilla calibrate` first, or say --belief");
      belief_ = fitted;
    }
  }

  void refuse_pins() const {
    for (std::size_t i = 0; i < designs_.size(); ++i) {
      if (designs_[i].counterface.in_place())
        throw InputError(
            fmt::format("{}: a pin is in the place of the finger, and a lab weighs what a belief "
                        "leaves open of fingers: name designs that a finger touches",
                        out_.opening.file.designs[i].name));
    }
  }

  void set_belief() {
    std::string path = source_.belief.empty() ? belief_ : own_or_shipped(source_.belief);
    if (path.empty()) path = designs_.front().finger.belief;
    if (path.empty())
      throw InputError(
          fmt::format("finger \"{}\" names no belief (finger.belief): say --belief FILE",
                      designs_.front().finger.name));
    const Belief belief = read_belief(path, designs_.front().finger);
    for (const Design& d : designs_) {
      if (d.model == belief.calibrated_for) continue;
      throw InputError(
          fmt::format("{}: its members were found for other model options than [model] "
                      "of {}",
                      path, d.title));
    }
    out_.opening.belief_text =
        "# Before anything was measured: " + path + ".\n" + belief_text(belief);
    note(fmt::format("belief: {} ({} members, as good as {} equal ones)", path,
                     belief.members.size(), significant(belief.effective_members(), 3)));
  }

  std::vector<double> listed(const std::string& text, const char* unit, const char* option) {
    std::vector<double> out;
    for (const std::string& one : split(text, ',')) {
      if (one.empty()) throw InputError(fmt::format("{}: \"{}\": an empty item", option, text));
      out.push_back(parse_si(one, unit));
    }
    return out;
  }

  // What the manifest says of each field is not said again of all.
  void refuse_conditions() const {
    for (const auto& [option, text] :
         {std::pair("--load", &source_.load), std::pair("--humidity", &source_.humidity),
          std::pair("--voltage", &source_.voltage), std::pair("--frequency", &source_.frequency),
          std::pair("--state", &source_.states)}) {
      if (!text->empty())
        throw InputError(fmt::format(
            "{}: the manifest of a wafer says under which conditions each field is measured: "
            "leave the option out, or take rows off the manifest",
            option));
    }
  }

  void set_conditions() {
    CandidateConditions& at = file().conditions;
    const auto given = [&](const std::string& text, const char* unit, const char* option,
                           std::vector<double>& values) {
      if (!text.empty()) values = listed(text, unit, option);
    };
    const Design& first = designs_.front();
    const bool of_wafer = !file().fields.empty();
    if (of_wafer) refuse_conditions();
    if (at.load.empty()) at.load = {first.finger.load};
    if (at.humidity.empty()) at.humidity = first.environment.relative_humidity;
    if (at.voltage.empty()) {
      const bool current = first.drive.driven() && first.drive.control == DriveControl::Current;
      if (current && source_.voltage.empty() && !of_wafer)
        throw InputError(
            "a drive by current: say at which voltages friction can be measured, "
            "--voltage \"100 V\"");
      if (!current) at.voltage = {first.drive.amplitude};
    }
    given(source_.load, "N", "--load", at.load);
    given(source_.humidity, "%", "--humidity", at.humidity);
    given(source_.voltage, "V", "--voltage", at.voltage);
    given(source_.frequency, "Hz", "--frequency", at.frequency);
    if (at.states.empty())
      at.states = {finger_state_names()[static_cast<std::size_t>(first.finger.state)]};
    if (!source_.states.empty()) at.states = split(source_.states, ',');
    if (of_wafer)
      note(fmt::format("{} of the wafer can be measured", counted(file().fields.size(), "field")));
  }

  void tell_controls() {
    std::vector<std::string> controls;
    for (const DesignEntry& d : file().designs) {
      if (!d.choice) controls.push_back(d.name);
    }
    if (!controls.empty())
      note(
          "the run does not say what these designs are worth, so they are measured and not "
          "chosen among: " +
          join_names(controls));
  }

  void set_worth() {
    if (has_run()) tell_controls();
    if (!source_.worth.empty()) {
      if (has_run())
        throw InputError("--worth: the run decides by its own rule, " + out_.opening.worth->name);
      parse_own_metric(source_.worth);
      file().worth = source_.worth;
      return;
    }
    if (has_run() || calibrated_ || designs_.size() < 2) return;
    const bool driven = std::all_of(designs_.begin(), designs_.end(),
                                    [](const Design& d) { return d.drive.driven(); });
    if (driven) file().worth = "worst(modulation)";
    note(driven ? "designs are compared by worst(modulation); --worth for another metric"
                : "nothing is decided, as some designs have no voltage: --worth names a metric to "
                  "compare all of them by");
  }

  const LabSource& source_;
  LabOpening out_;
  std::vector<Design> designs_;
  std::vector<std::string> opened_with_;
  std::map<std::string, std::string> labels_;  // of fields, and the manifest of each
  std::string belief_;
  bool calibrated_ = false;
  struct Built {
    std::size_t choice;
    Design design;
  };
  std::optional<Built> built_;  // the best of the run on the grid of the fab
};

}  // namespace

LabOpening lab_opening(const LabSource& source) { return LabOpener(source).open(); }

}  // namespace papilla::report
