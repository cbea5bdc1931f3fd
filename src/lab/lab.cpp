#include "lab/lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

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

// Records of an older program have choices by their place among those of then: as many as there are
// now are taken for the same.
void name_choices(const std::vector<LabDesign>& designs, std::vector<JournalEntry>& entries) {
  std::vector<std::string> names;
  for (const LabDesign& d : designs) {
    if (d.choice) names.push_back(d.name);
  }
  for (JournalEntry& e : entries) {
    if (!e.decision || !e.decision->designs.empty()) continue;
    if (e.decision->p_designs.size() != names.size()) continue;
    e.decision->designs = names;
    if (!e.plan) continue;
    for (PlannedExperiment& p : e.plan->experiments) {
      for (std::vector<Foreseen>* thirds : {&p.off, &p.on}) {
        for (Foreseen& o : *thirds) {
          if (o.choice < names.size()) o.design = names[o.choice];
        }
      }
    }
  }
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
    entries_.push_back(read_entry(record.payload, design_names(designs_)));
  name_choices(designs_, entries_);
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

struct ToldReading {
  const FrictionReading* reading;
  const TellRecord* of;
  std::string id;  // its identity

  std::string where() const { return of->file + " of " + of->date; }
};

// Of all tellings, without those that a later one took the place of.
std::vector<ToldReading> in_force(const std::vector<JournalEntry>& entries) {
  std::vector<ToldReading> out;
  for (const JournalEntry& e : entries) {
    if (!e.tell) continue;
    for (const std::string& key : e.tell->replaced)
      std::erase_if(out, [&](const ToldReading& o) { return o.reading->key == key; });
    for (const FrictionReading& r : e.tell->readings) {
      const std::string id = identity(r);
      if (!id.empty()) std::erase_if(out, [&](const ToldReading& o) { return o.id == id; });
      out.push_back({&r, &*e.tell, id});
    }
  }
  return out;
}

// What was told, by key and by identity. Both are entered a second time without the day, to be
// found by a reading that does not say its day.
struct ToldBefore {
  std::map<std::string, ToldReading> by_key;
  std::multimap<std::string, ToldReading> by_identity;

  ToldBefore(const std::vector<ToldReading>& told, const std::vector<LabDesign>& designs) {
    for (const ToldReading& t : told) {
      add(*t.reading, t);
      add(as_of_day(*t.reading, "", designs), t);
    }
  }

 private:
  void add(const FrictionReading& r, const ToldReading& t) {
    by_key.emplace(r.key, t);
    if (const std::string id = identity(r); !id.empty()) by_identity.emplace(id, t);
  }
};

}  // namespace

std::vector<FrictionReading> Lab::readings() const {
  std::vector<FrictionReading> out;
  for (const ToldReading& t : in_force(entries_)) out.push_back(*t.reading);
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
  const std::vector<double> frequencies = carrier_frequencies(c);
  const std::size_t count = designs_.size() * c.load.size() * c.humidity.size() * c.voltage.size() *
                            frequencies.size() * c.states.size();
  if (count > kMostCandidates)
    throw InputError(
        fmt::format("{} experiments can be made: leave conditions out of [conditions] "
                    "in lab.toml until there are {} at most",
                    count, kMostCandidates));
  for (std::size_t d = 0; d < designs_.size(); ++d) {
    for (const FingerState state : finger_states(c)) {
      for (const double load : c.load) {
        for (const double voltage : c.voltage) {
          for (const double frequency : frequencies) {
            for (const double humidity : c.humidity) {
              const Experiment e{d, {load, humidity, voltage, voltage > 0 ? frequency : 0, state}};
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
    std::vector<std::size_t> rows;  // of the choices
    std::vector<Problem> unknown;
    for (const LabDesign& d : designs_) {
      if (!d.choice) continue;
      const auto at = std::find(run.designs.begin(), run.designs.end(), d.name);
      if (at == run.designs.end()) {
        unknown.push_back({folder_.path(kLabFile), 0, 0, "choice",
                           fmt::format("\"{}\" is decided among, but {} does not say what it is "
                                       "worth: set it to false",
                                       d.name, file_.worth_file)});
        continue;
      }
      rows.push_back(static_cast<std::size_t>(at - run.designs.begin()));
    }
    if (!unknown.empty()) throw InputError(unknown);
    for (const std::size_t i : rows) {
      worth_.push_back({run.worth[i], 0, {"of the run", run.by_skin[i]}});
      kept_.push_back(run.kept[i]);
      run_limits_.push_back(run.limits[i]);
    }
    return worth_;
  }
  const MetricExpression metric = parse_own_metric(file_.worth);
  const auto choices =
      std::count_if(designs_.begin(), designs_.end(), [](const LabDesign& d) { return d.choice; });
  for (const LabDesign& d : designs_) {
    if (!d.choice) continue;
    const std::string which = fmt::format("{} of {}: ", worth_.size() + 1, choices);
    worth_.push_back(model_->worth(d, metric, which));
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

const std::vector<RunLimit>& Lab::run_limits(std::size_t choice) const {
  static const std::vector<RunLimit> kNone;
  return run_limits_.empty() ? kNone : run_limits_[choice];
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
    for (std::size_t i = 0; i < s.prospects.size(); ++i) {
      out.p_designs.push_back(s.prospects[i].p_best);
      out.designs.push_back(designs_[s.choices[i]].name);
    }
  }
  out.p_hypothesis = s.p_hypothesis;
  out.effective_members = s.effective_members;
  out.explained = s.discrepancies.none;
  if (!s.discrepancies.found.empty()) out.discrepancy = s.discrepancies.found.front().where;
  return out;
}

void Lab::keep(JournalEntry entry) {
  const std::string text = entry_text(entry, design_names(designs_));
  journal_->append({fmt::format("{}", entries_.size() + 1), text});
  entries_.push_back(std::move(entry));
}

PlanRecord Lab::next(const NextOptions& options) {
  stand();
  PlanRecord plan = plan_batch(*standing_, *table_, candidates(), file_, options, planned().size());
  keep({plan, std::nullopt, decision(options.date)});
  return plan;
}

// Takes those into the record that were not told before. Throws InputError for one that contradicts
// what was told.
void Lab::take_new(const std::vector<FrictionReading>& rows, const TellOptions& options,
                   Told& told) const {
  const std::vector<std::string>& in_belief = belief().readings;
  const std::vector<ToldReading> before = in_force(entries_);
  const ToldBefore known(before, designs_);
  std::vector<Problem> problems;
  const auto problem = [&](const FrictionReading& r, const char* key, const std::string& message) {
    problems.push_back({told.record.file, r.line, 0, key, message});
  };
  std::set<std::string> stay, of_file;
  for (const FrictionReading& row : rows) {
    const FrictionReading r = row.day.empty() ? as_of_day(row, options.day, designs_) : row;
    auto found = known.by_key.find(r.key);
    // Of a table that grows, --day is that of the new touches; of one that is told anew, of all.
    if (found == known.by_key.end() && r.repeat > 0) {
      found = known.by_key.find(row.key);
      if (found != known.by_key.end() && found->second.of->sha256 == told.record.sha256)
        found = known.by_key.end();
    }
    if (found != known.by_key.end()) {
      ++told.already;
      told.already_of = found->second.where();
      stay.insert(found->second.reading->key);
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
    const auto [first, last] = known.by_identity.equal_range(identity(r));
    std::set<std::string> days;
    for (auto other = first; other != last; ++other) days.insert(other->second.reading->day);
    if (!days.empty() && !options.replace)
      problem(r, "",
              fmt::format("another value of repeat {} of this experiment was told in {}: number it "
                          "as a further repeat{}, or --replace",
                          r.repeat, std::prev(last)->second.where(),
                          r.day.empty() ? ", say of which day it is" : ""));
    else if (r.day.empty() && days.size() > 1)
      problem(r, "day",
              fmt::format("not said, and repeat {} of this experiment was told of {}", r.repeat,
                          join_names({days.begin(), days.end()}, " and of ")));
    const std::string else_day = days.empty() ? options.date : *days.begin();
    FrictionReading taken = r.day.empty() ? as_of_day(r, else_day, designs_) : r;
    if (const std::string id = identity(taken); !id.empty() && !of_file.insert(id).second)
      problem(r, "repeat",
              fmt::format("repeat {} of this experiment stands twice in the file, with two values",
                          r.repeat));
    told.record.readings.push_back(std::move(taken));
  }
  if (!problems.empty()) throw InputError(problems);
  if (!options.replace) return;
  for (const ToldReading& t : before) {
    if (t.of->sha256 == told.record.sha256 && !stay.contains(t.reading->key))
      told.record.replaced.push_back(t.reading->key);
  }
  if (const auto count = static_cast<long long>(told.record.replaced.size()); count > 0)
    told.record.notes.push_back(fmt::format(
        "no longer counted: {} that this file was told as before", counted(count, "reading")));
}

// Notes readings under conditions where some member of the belief has no friction: they are kept
// but have no weight. Throws InputError where that is so of all readings.
void Lab::note_unheld(const std::string& path, TellRecord& record) const {
  std::vector<std::string> notes;
  std::optional<Problem> first;
  bool any_held = record.readings.empty();
  for (const FrictionReading& r : record.readings) {
    const MeasurableCell& cell = table_->cell(r.experiment);
    for (const auto& [name, force, held] :
         {std::tuple("F_off", r.off, cell.off.has_value()), {"F_on", r.on, cell.on.has_value()}}) {
      if (!(force > 0)) continue;
      any_held |= held;
      if (held) continue;
      const std::string of = designs_[r.experiment.design].name + ", " + text(r.experiment.at);
      if (!first)
        first =
            Problem{path, r.line, 0, "",
                    "some member of the belief has no friction there (" + text(r.experiment.at) +
                        "), for example because its film breaks down: the reading cannot be "
                        "compared with it"};
      notes.push_back(fmt::format(
          "{} of {} is kept but has no weight: some member of the belief has no friction there",
          name, of));
    }
  }
  if (!any_held && first) throw InputError({*first});
  for (const std::string& n : notes) {
    if (std::find(record.notes.begin(), record.notes.end(), n) == record.notes.end())
      record.notes.push_back(n);  // once, of several touches
  }
}

Told Lab::tell(const std::string& path, const TellOptions& options,
               const std::function<void(const Told&)>& picture) {
  const std::string bytes = read_bytes(path, kLargestFile);
  Told told;
  told.record.date = options.date;
  told.record.file = std::filesystem::path(path).filename().string();
  told.record.sha256 = sha256(bytes);
  told.record.trace = is_trace(bytes);
  TellOptions meant = options;
  for (const JournalEntry& e : entries_) {
    if (!e.tell || e.tell->sha256 != told.record.sha256) continue;
    if (!options.replace) {  // the same readings, whatever is said of them
      told.already = static_cast<int>(e.tell->readings.size());
      told.already_of = e.tell->file + " of " + e.tell->date;
      return told;
    }
    meant.date = e.tell->date;  // of which it is where it says no day
    break;
  }
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
  take_new(matched.readings, meant, told);
  if (told.record.readings.empty() && told.record.replaced.empty()) return told;
  told.before = decision(options.date);
  std::vector<Experiment> of_file;
  for (const FrictionReading& r : told.record.readings) of_file.push_back(r.experiment);
  table_->lay(of_file);
  note_unheld(path, told.record);
  if (picture) picture(told);
  entries_.push_back({std::nullopt, told.record, std::nullopt});
  stand();
  told.after = decision(options.date);
  entries_.pop_back();
  keep({std::nullopt, told.record, told.after});
  return told;
}

}  // namespace papilla::lab
