#include "lab/lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/digest.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "config/writer.h"
#include "lab/planning.h"

namespace papilla::lab {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 28;  // of what is told [bytes]
constexpr const char* kWho = "another papilla next or tell works";

// All labs: what makes them unlike stands in their files.
std::string journal_key() { return text_hash("papilla lab, records of version 1"); }

std::vector<LabDesign> read_designs(const std::string& folder, const LabFile& file) {
  std::vector<LabDesign> out;
  Mistakes mistakes;
  for (const DesignEntry& entry : file.designs) {
    mistakes.of([&] {
      out.push_back({entry.name, read_design(folder + "/" + entry.file), entry.choice});
      if (out.back().design.title.empty()) out.back().design.title = entry.name;
    });
  }
  mistakes.tell();
  return out;
}

}  // namespace

std::string today() {
  const std::chrono::year_month_day date{
      std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now())};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

bool is_lab(const std::string& folder) {
  return std::filesystem::is_regular_file(folder + "/" + kJournalFile) &&
         std::filesystem::is_regular_file(folder + "/" + kLabFile);
}

bool has_begun(const std::string& folder) {
  if (!is_lab(folder)) return false;
  const std::string journal = Folder(folder).read(kJournalFile);
  return journal.find('\n') + 1 < journal.size();  // anything behind its header
}

void open_lab(const std::string& folder, const Opening& opening) {
  if (has_begun(folder))
    throw InputError(folder + ": is a lab already; name it alone to go on with it");
  const Folder place = Folder::made(folder);
  const SoleWriter sole(place, kWho);
  place.made_below("designs");
  for (std::size_t i = 0; i < opening.designs.size(); ++i) {
    Design design = opening.designs[i];
    design.finger.belief.clear();  // that of the lab
    place.write(opening.file.designs[i].file, to_toml(design));
  }
  place.write(opening.file.belief, opening.belief_text);
  if (opening.worth) place.write(opening.file.worth_file, run_worth_text(*opening.worth));
  place.write(kLabFile, lab_file_text(opening.file));
  const Journal journal(place, kJournalFile, journal_key(), true);
}

Lab::Lab(const std::string& folder, int threads, std::function<void(const std::string&)> note)
    : folder_(folder), sole_(folder_, kWho) {
  if (!is_lab(folder))
    throw InputError(folder + ": no lab (no lab.toml and lab.journal); `papilla next` opens one");
  file_ = read_lab_file(folder);
  designs_ = read_designs(folder, file_);
  model_ = std::make_unique<MemberModel>(
      read_belief(folder_.file(file_.belief), designs_.front().design.finger), folder, threads,
      std::move(note));
  table_ = std::make_unique<ResponseTable>(designs_, *model_);
  journal_ = std::make_unique<Journal>(folder_, kJournalFile, journal_key(), true);
  for (const JournalRecord& record : journal_->records())
    entries_.push_back(read_entry(record.payload));
}

std::vector<PlannedExperiment> Lab::planned() const {
  std::vector<PlannedExperiment> out;
  for (const JournalEntry& e : entries_) {
    if (e.plan) out.insert(out.end(), e.plan->experiments.begin(), e.plan->experiments.end());
  }
  return out;
}

namespace {

// What a reading is of, whatever it says; "": readings that nothing tells apart.
std::string identity(const FrictionReading& r) {
  if (r.repeat == 0) return {};
  return fmt::format("{} | {} | {} | {} | {}", r.experiment.design, text(r.experiment.at), r.finger,
                     r.day, r.repeat);
}

}  // namespace

std::vector<FrictionReading> Lab::readings() const {
  std::vector<FrictionReading> out;
  for (const JournalEntry& e : entries_) {
    if (!e.tell) continue;
    for (const FrictionReading& r : e.tell->readings) {
      // A later one of the same identity was told to take its place.
      const std::string id = identity(r);
      if (!id.empty())
        std::erase_if(out, [&](const FrictionReading& o) { return identity(o) == id; });
      out.push_back(r);
    }
  }
  return out;
}

std::vector<Experiment> Lab::candidates() const {
  std::vector<Experiment> out;
  if (!file_.fields.empty()) {
    for (const FieldEntry& f : file_.fields) {
      const auto design = std::find_if(designs_.begin(), designs_.end(),
                                       [&](const LabDesign& d) { return d.name == f.design; });
      const Experiment e{static_cast<std::size_t>(design - designs_.begin()),
                         {f.load, f.humidity, f.voltage, f.voltage > 0 ? f.frequency : 0, f.state}};
      if (std::find(out.begin(), out.end(), e) == out.end()) out.push_back(e);
    }
    return out;
  }
  const CandidateConditions& c = file_.conditions;
  const std::vector<double> frequencies = c.frequency.empty() ? std::vector{0.0} : c.frequency;
  const std::size_t count = designs_.size() * c.load.size() * c.humidity.size() * c.voltage.size() *
                            frequencies.size() * c.states.size();
  if (count > kMostCandidates)
    throw InputError(
        fmt::format("{} experiments can be made: leave conditions out of [conditions] "
                    "in lab.toml until there are {} at most",
                    count, kMostCandidates));
  for (std::size_t d = 0; d < designs_.size(); ++d) {
    for (const std::string& state : c.states) {
      const auto& names = finger_state_names();
      const auto index = std::find(names.begin(), names.end(), state) - names.begin();
      for (const double load : c.load) {
        for (const double voltage : c.voltage) {
          for (const double frequency : frequencies) {
            for (const double humidity : c.humidity) {
              const Experiment e{d,
                                 {load, humidity, voltage, voltage > 0 ? frequency : 0,
                                  static_cast<FingerState>(index)}};
              if (std::find(out.begin(), out.end(), e) == out.end()) out.push_back(e);
            }
          }
        }
      }
    }
  }
  return out;
}

const std::vector<MemberNumbers>& Lab::worth() {
  if (!worth_.empty() || file_.worth.empty()) return worth_;
  if (!file_.worth_file.empty()) {
    const RunWorth run = read_run_worth(folder_.read(file_.worth_file), file_.worth_file);
    if (run.worth.empty() || run.worth.front().size() != belief().members.size())
      throw InputError(folder_.path(file_.worth_file) + ": of another belief than " + file_.belief);
    for (const LabDesign& d : designs_) {
      const auto at = std::find(run.designs.begin(), run.designs.end(), d.name);
      if (!d.choice || at == run.designs.end()) continue;
      const auto i = static_cast<std::size_t>(at - run.designs.begin());
      worth_.push_back({run.worth[i], 0, {"of the run", run.by_skin[i]}});
      kept_.push_back(run.kept[i]);
    }
    return worth_;
  }
  const MetricExpression metric = parse_own_metric(file_.worth);
  for (const LabDesign& d : designs_) {
    if (d.choice) worth_.push_back(model_->worth(d, metric));
  }
  return worth_;
}

void Lab::stand() {
  // The same rows in the same order however many calls the readings were told in.
  std::vector<Experiment> all = candidates();
  const std::vector<FrictionReading> told = readings();
  for (const FrictionReading& r : told) all.push_back(r.experiment);
  table_->lay(all);
  const std::vector<MemberNumbers>& of_designs = worth();
  standing_ = standing_of(belief(), file_, designs_, *table_, told, of_designs, kept_);
}

const Standing& Lab::standing() {
  if (!standing_) stand();
  return *standing_;
}

DecisionRecord Lab::decision(const std::string& date) {
  const Standing& s = standing();
  DecisionRecord out;
  out.date = date;
  out.readings = readings().size();
  if (s.decided()) {
    out.best = designs_[s.choices[s.best]].name;
    out.p_best = s.prospects[s.best].p_best;
    out.regret = s.prospects[s.best].regret;
    for (const Prospect& p : s.prospects) out.p_designs.push_back(p.p_best);
  }
  out.p_hypothesis = s.p_hypothesis;
  out.effective_members = s.effective_members;
  out.explained = s.discrepancies.none;
  if (!s.discrepancies.found.empty()) out.discrepancy = s.discrepancies.found.front().where;
  return out;
}

void Lab::keep(JournalEntry entry) {
  const std::string text = entry_text(entry);
  journal_->append({fmt::format("{}", entries_.size() + 1), text});
  entries_.push_back(std::move(entry));
}

PlanRecord Lab::next(const NextOptions& options) {
  stand();
  PlanRecord plan = plan_batch(*standing_, *table_, candidates(), file_, options, planned().size());
  keep({plan, std::nullopt, decision(options.date)});
  return plan;
}

// Those that were not told before. Throws InputError for one that contradicts what was.
std::vector<FrictionReading> Lab::new_ones(std::vector<FrictionReading> readings, bool replace,
                                           Told& told) const {
  const std::vector<std::string>& in_belief = belief().readings;
  std::map<std::string, std::string> known, said;
  for (const JournalEntry& e : entries_) {
    if (!e.tell) continue;
    for (const FrictionReading& r : e.tell->readings) {
      const std::string where = e.tell->file + " of " + e.tell->date;
      known[r.key] = where;
      if (const std::string id = identity(r); !id.empty()) said[id] = where;
    }
  }
  std::vector<FrictionReading> out;
  std::vector<Problem> problems;
  std::set<std::string> of_file;
  for (FrictionReading& r : readings) {
    if (const auto before = known.find(r.key); before != known.end()) {
      ++told.already;
      told.already_of = before->second;
      continue;
    }
    const auto is_in_belief = [&](const std::string& text) {
      return std::find(in_belief.begin(), in_belief.end(), text) != in_belief.end();
    };
    const Conditions& at = r.experiment.at;
    if (is_in_belief(r.row) ||
        is_in_belief(reading_text(at.load, at.relative_humidity, at.voltage, r.off, r.on))) {
      ++told.fitted;
      continue;
    }
    const std::string id = identity(r);
    if (const auto before = said.find(id); !id.empty() && before != said.end() && !replace)
      problems.push_back({told.record.file, r.line, 0, "",
                          fmt::format("another value of repeat {} of this experiment was told in "
                                      "{}: number it as a further repeat, or --replace",
                                      r.repeat, before->second)});
    if (!id.empty() && !of_file.insert(id).second)
      problems.push_back({told.record.file, r.line, 0, "repeat",
                          fmt::format("repeat {} of this experiment stands twice in the file, with "
                                      "two values",
                                      r.repeat)});
    out.push_back(std::move(r));
  }
  if (!problems.empty()) throw InputError(problems);
  return out;
}

Told Lab::tell(const std::string& path, const TellOptions& options,
               const std::function<void(const Told&)>& picture) {
  const std::string bytes = read_bytes(path, kLargestFile);
  Told told;
  told.record.date = options.date;
  told.record.file = std::filesystem::path(path).filename().string();
  told.record.sha256 = sha256(bytes);
  told.record.trace = is_trace(bytes);
  for (const JournalEntry& e : entries_) {
    if (!e.tell || e.tell->sha256 != told.record.sha256) continue;
    told.already = static_cast<int>(e.tell->readings.size());
    told.already_of = e.tell->file + " of " + e.tell->date;
    if (told.record.trace) return told;  // a record is one reading, whatever is said of it
  }
  told.already = 0;
  const std::vector<PlannedExperiment> plan = planned();
  const MatchContext context{file_, designs_, plan};
  Matched matched;
  if (told.record.trace) {
    told.trace = read_trace(bytes, path);
    told.sliding = find_sliding(*told.trace);
    told.reading = read_friction_of(*told.trace, *told.sliding, path);
    matched = match_trace(*told.trace, *told.reading, context, options, path);
    told.record.notes = told.reading->notes;
  } else {
    const MeasuredTable table = read_measured_table(bytes, path);
    if (!table.has_friction)
      throw InputError({Problem{path, 0, 0, "", "no column of friction: F_off_N, F_on_N"}});
    matched = match_table(table, context, options, path);
  }
  told.empty = matched.empty;
  told.record.notes.insert(told.record.notes.end(), matched.notes.begin(), matched.notes.end());
  told.record.readings = new_ones(std::move(matched.readings), options.replace, told);
  if (told.record.readings.empty()) return told;
  told.before = decision(options.date);
  std::vector<Experiment> of_file;
  for (const FrictionReading& r : told.record.readings) of_file.push_back(r.experiment);
  table_->lay(of_file);
  for (const FrictionReading& r : told.record.readings) {
    const MeasurableCell& cell = table_->cell(r.experiment);
    if ((r.off > 0 && !cell.off) || (r.on > 0 && !cell.on))
      throw InputError({Problem{path, r.line, 0, "",
                                "some member of belief has no such state (" +
                                    text(r.experiment.at) + "): it cannot be held against it"}});
  }
  if (picture) picture(told);
  entries_.push_back({std::nullopt, told.record, std::nullopt});
  stand();
  told.after = decision(options.date);
  entries_.pop_back();
  keep({std::nullopt, told.record, told.after});
  return told;
}

}  // namespace papilla::lab
