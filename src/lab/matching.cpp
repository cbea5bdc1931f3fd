#include "lab/matching.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <tuple>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/columns.h"

namespace papilla::lab {
namespace {

// What is set at an instrument comes out so near: the reading is taken as of what was planned.
constexpr double kHumidityBand = 0.015;  // of relative humidity, absolute
constexpr double kLoadBand = 0.1, kVoltageBand = 0.02, kFrequencyBand = 0.02;  // shares
// Of what friction is corrected by from load to load, what is not known of the correction.
constexpr double kCorrectionError = 0.5;
// Beyond these a number of a record is a slip, as in tables.
constexpr double kMostRepeats = 1e6, kHighestFrequency = 1e9;
constexpr double kLeastLoad = 1e-6, kLargestLoad = 100;  // [N]

// Conditions that no plan has set, as they were measured, are rounded so; a load to two digits
// where these are finer, which is by a twentieth at most.
struct Steps {
  double load = 0, humidity = 0, voltage = 0;  // 0: taken as they are
};
constexpr Steps kOfRecords{5e-3, 0.01, 1};

// As it would be written: 0.35, not 35 times 0.01.
double rounded(double value, double step) {
  return step > 0 ? std::round(value / step) / (1 / step) : value;
}

double rounded_load(double load, double step) {
  return rounded(load, std::min(step, std::pow(10, std::floor(std::log10(load)) - 1)));
}

// How far a value is from what was wanted, in widths of a band; infinite beyond it.
double distance(double value, double wanted, double absolute, double share) {
  const double off = std::abs(value - wanted), band = std::max(absolute, share * std::abs(wanted));
  if (off == 0) return 0;
  return off <= band ? off / band : kInfinity;
}

// The nearest of some values, where it is near enough; the first among equals. otherwise: what is
// taken where none is. meaning: what a value stands for.
template <class Meaning = std::identity>
double snapped(double value, const std::vector<double>& known, double absolute, double share,
               double otherwise, Meaning meaning = {}) {
  double out = otherwise, least = kInfinity;
  for (const double k : known) {
    const double off = distance(meaning(value), meaning(k), absolute, share);
    if (off >= least) continue;
    least = off;
    out = k;
  }
  return out;
}

class Matcher {
 public:
  Matcher(const MatchContext& context, const TellOptions& options, const std::string& file,
          const Steps& steps = {})
      : context_(context), options_(options), file_(file), steps_(steps) {}

  std::optional<FrictionReading> match(const MeasuredRow& row) {
    FrictionReading out;
    line_ = row.line;
    const std::size_t before = problems_.size();
    const std::string experiment = said(row.experiment, options_.experiment),
                      field = said(row.field, options_.field),
                      design = said(row.design, options_.design);
    if (!experiment.empty())
      by_experiment(experiment, row, out);
    else if (!field.empty())
      by_field(field, row, out);
    else
      by_design(design, row, out);
    out.finger = said(row.finger, options_.finger, "1");
    out.day = row.day;
    out.repeat = row.repeat;
    out.line = row.line;
    out.off = row.off.value_or(0);
    out.off_sd = row.off_sd.value_or(0);
    out.on = row.on.value_or(0);
    out.on_sd = row.on_sd.value_or(0);
    if (out.on > 0 && !out.experiment.at.driven() && problems_.size() == before)
      problem("F_on", "a friction under voltage, but its experiment has none");
    // Conditions say the design's own frequency by 0, a row a constant voltage.
    if (row.on && row.frequency && problems_.size() == before) {
      const std::string wrong =
          frequency_problem(context_.designs[out.experiment.design].design.drive, *row.frequency);
      if (!wrong.empty()) problem("frequency", wrong);
    }
    if (problems_.size() > before) return std::nullopt;
    return out;
  }

  void tell_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }
  // What readings were taken for: conditions that were planned, of which they are off by less than
  // a band; or their own, each once as "E01 at 35 % RH, ...".
  int planned_conditions() const { return as_planned_; }
  const std::vector<std::string>& own_conditions() const { return as_measured_; }

 private:
  static std::string said(const std::string& in_row, const std::string& in_options,
                          const std::string& otherwise = "") {
    if (!in_row.empty()) return in_row;
    return in_options.empty() ? otherwise : in_options;
  }

  void problem(const std::string& key, const std::string& message) {
    problems_.push_back({file_, line_, 0, key, message});
  }

  void unknown(const std::string& what, const std::string& name,
               const std::vector<std::string>& known) {
    const std::string close = nearest_name(name, known);
    problem(what, fmt::format("no {} \"{}\"{}", what, name,
                              close.empty() ? "; there are " + join_names(known)
                                            : fmt::format(", is it `{}`?", close)));
  }

  // Of the design's own carrier [Hz], which conditions say by a frequency of 0.
  double own_frequency(std::size_t design) const {
    return design < context_.designs.size() ? context_.designs[design].design.drive.frequency : 0;
  }
  double carrier(double frequency, std::size_t design) const {
    return frequency > 0 ? frequency : own_frequency(design);
  }
  double frequency_of(const Conditions& at, std::size_t design) const {
    return carrier(at.frequency, design);
  }

  // Of all that is set at an instrument; infinite where something of it is beyond its band.
  double distance_of(const Conditions& is, const Conditions& wanted, std::size_t design) const {
    if (is.state != wanted.state) return kInfinity;
    double out = distance(is.relative_humidity, wanted.relative_humidity, kHumidityBand, 0) +
                 distance(is.load, wanted.load, 0, kLoadBand) +
                 distance(is.voltage, wanted.voltage, 0, kVoltageBand);
    if (wanted.driven())
      out += distance(frequency_of(is, design), frequency_of(wanted, design), 0, kFrequencyBand);
    return out;
  }
  bool near(const Conditions& is, const Conditions& wanted, std::size_t design) const {
    return distance_of(is, wanted, design) < kInfinity;
  }

  // Conditions of a row over those that are meant.
  Conditions over(const MeasuredRow& row, Conditions at, std::size_t design) const {
    at.load = row.load.value_or(at.load);
    at.relative_humidity = row.relative_humidity.value_or(at.relative_humidity);
    at.voltage = row.voltage.value_or(at.voltage);
    const bool own = at.frequency == 0 && row.frequency == own_frequency(design);
    if (row.frequency && !own) at.frequency = *row.frequency;
    at.state = row.state.value_or(at.state);
    if (!at.driven()) at.frequency = 0;
    return at;
  }

  // As it was planned where the row is near it.
  Conditions taken(const std::string& id, const MeasuredRow& row, const Experiment& wanted) {
    const Conditions& planned = wanted.at;
    const Conditions is = over(row, planned, wanted.design);
    if (!near(is, planned, wanted.design)) return as_measured(id, row, is, wanted.design);
    as_planned_ += !same_rounded(is, planned, row);
    return planned;
  }

  // Under conditions that were not planned: an experiment of its own. id: of what was planned.
  Conditions as_measured(const std::string& id, const MeasuredRow& row, const Conditions& is,
                         std::size_t design) {
    const Conditions out = snapped_to_candidates(is, row, design);
    Conditions shown = out;
    if (shown.driven()) shown.frequency = frequency_of(out, design);
    const std::string known = id + " at " + text(shown);
    const bool told =
        std::find(as_measured_.begin(), as_measured_.end(), known) != as_measured_.end();
    if (row.measured() && !told) as_measured_.push_back(known);
    return out;
  }

  // What a row measured of conditions, rounded; the rest is as it was meant.
  Conditions as_rounded(Conditions at, const MeasuredRow& row) const {
    if (row.load) at.load = rounded_load(at.load, steps_.load);
    if (row.relative_humidity)
      at.relative_humidity = rounded(at.relative_humidity, steps_.humidity);
    if (row.voltage) at.voltage = rounded(at.voltage, steps_.voltage);
    return at;
  }
  bool same_rounded(const Conditions& is, const Conditions& wanted, const MeasuredRow& row) const {
    return as_rounded(is, row) == as_rounded(wanted, row);
  }

  Conditions snapped_to_candidates(Conditions at, const MeasuredRow& row,
                                   std::size_t design) const {
    const CandidateConditions& c = context_.file.conditions;
    const Conditions own = as_rounded(at, row);
    at.load = snapped(at.load, c.load, 0, kLoadBand, own.load);
    at.relative_humidity =
        snapped(at.relative_humidity, c.humidity, kHumidityBand, 0, own.relative_humidity);
    at.voltage = snapped(at.voltage, c.voltage, 0, kVoltageBand, own.voltage);
    if (at.driven())
      at.frequency = snapped(at.frequency, carrier_frequencies(c), 0, kFrequencyBand, at.frequency,
                             [&](double frequency) { return carrier(frequency, design); });
    return at;
  }

  void by_experiment(const std::string& id, const MeasuredRow& row, FrictionReading& out) {
    std::vector<std::string> known;
    for (const PlannedExperiment& p : context_.planned) {
      known.push_back(p.id);
      if (p.id != id) continue;
      out.id = id;
      out.field = p.field;
      out.experiment = {p.experiment.design, taken(id, row, p.experiment)};
      check_field(id, row, out);
      check_design(id, row, out);
      return;
    }
    unknown("experiment", id, known);
  }

  // The field that is said beside an experiment. A plan of no field leaves its column to notes of
  // the user.
  void check_field(const std::string& id, const MeasuredRow& row, const FrictionReading& out) {
    const std::string field = said(row.field, options_.field);
    if (field.empty() || field == out.field || (out.field.empty() && !row.field.empty())) return;
    problem("field", out.field.empty() ? fmt::format("{} stands in no field, not in {}", id, field)
                                       : fmt::format("{} stands in field {} of the plan, not {}",
                                                     id, out.field, field));
  }

  // The design that is said of a reading. A manifest names the file of a field's design, which the
  // lab may know by another name.
  void check_design(const std::string& of, const MeasuredRow& row, const FrictionReading& out) {
    const std::string name = said(row.design, options_.design);
    const std::size_t index = design_index(name);
    if (name.empty() || index == out.experiment.design) return;
    if (!out.field.empty() && name.ends_with(".toml")) return;
    if (index == context_.designs.size())
      return unknown("design", name, design_names(context_.designs));
    problem("design", fmt::format("{} is of {}, not {}", of,
                                  context_.designs[out.experiment.design].name, name));
  }

  void by_field(const std::string& field, const MeasuredRow& row, FrictionReading& out) {
    std::vector<std::string> known;
    std::vector<const FieldEntry*> here;
    for (const FieldEntry& f : context_.file.fields) {
      if (std::find(known.begin(), known.end(), f.field) == known.end()) known.push_back(f.field);
      if (f.field == field) here.push_back(&f);
    }
    if (here.empty()) return unknown("field", field, known);
    for (const FieldEntry* f : here) {
      if (f->design != here.front()->design)
        return problem("field", fmt::format("{} is a label of two fields of lab.toml, with {} and "
                                            "{}: tell it by its experiment, or by its design and "
                                            "conditions",
                                            field, here.front()->design, f->design));
    }
    out.field = field;
    out.experiment.design = design_index(here.front()->design);
    check_design(field, row, out);
    const std::size_t of = out.experiment.design;
    std::vector<Conditions> all,
        planned;  // of the field; those that the row is near, nearest first
    for (const FieldEntry* f : here) {
      all.push_back(conditions_of(*f));
      const bool can_be = all.back().driven() || !row.on;
      if (can_be && near(over(row, all.back(), of), all.back(), of)) planned.push_back(all.back());
    }
    std::stable_sort(planned.begin(), planned.end(), [&](const Conditions& a, const Conditions& b) {
      return distance_of(over(row, a, of), a, of) < distance_of(over(row, b, of), b, of);
    });
    const std::vector<Conditions>& meant = planned.empty() ? all : planned;
    if (const std::string open = left_open(row, meant); !open.empty())
      return problem("field", fmt::format("{} is to be measured at more than one {}: say which, in "
                                          "a column; in a record by a line `# humidity: 75 %`, "
                                          "`# state: wet` or `# carrier: 5 kHz`",
                                          field, open));
    const Conditions is = over(row, meant.front(), of);
    as_planned_ += !planned.empty() && !same_rounded(is, meant.front(), row);
    out.experiment.at = planned.empty() ? as_measured(field, row, is, of) : meant.front();
  }

  // What a row does not say and some conditions differ in: "load and humidity". Friction without
  // voltage is the same whatever the voltage is.
  static std::string left_open(const MeasuredRow& row, const std::vector<Conditions>& among) {
    std::vector<std::string> out;
    const auto compare = [&](bool is_said, const char* name, auto Conditions::*quantity) {
      const bool differ = std::any_of(among.begin(), among.end(), [&](const Conditions& c) {
        return c.*quantity != among.front().*quantity;
      });
      if (!is_said && differ) out.emplace_back(name);
    };
    compare(row.load.has_value(), "load", &Conditions::load);
    compare(row.relative_humidity.has_value(), "humidity", &Conditions::relative_humidity);
    compare(row.voltage || !row.on, "voltage", &Conditions::voltage);
    compare(row.frequency || !row.on, "frequency", &Conditions::frequency);
    compare(row.state.has_value(), "state", &Conditions::state);
    return join_names(out, " and ");
  }

  static Conditions conditions_of(const FieldEntry& f) {
    return {f.load, f.humidity, f.voltage, f.voltage > 0 ? f.frequency : 0, f.state};
  }

  void by_design(const std::string& name, const MeasuredRow& row, FrictionReading& out) {
    if (name.empty())
      return problem("", "says no experiment, field or design: add such a column, or --experiment");
    const std::size_t index = design_index(name);
    if (index == context_.designs.size())
      return unknown("design", name, design_names(context_.designs));
    const CandidateConditions& c = context_.file.conditions;
    const auto needed = [&](const auto& is, const auto& known, const char* what) {
      if (is) return *is;
      if (known.size() == 1) return known.front();
      problem(what, known.empty() ? "not said" : "not said, and the lab has more than one");
      return std::decay_t<decltype(*is)>{};
    };
    Conditions at;
    at.load = needed(row.load, c.load, "load");
    at.relative_humidity = needed(row.relative_humidity, c.humidity, "humidity");
    at.voltage = needed(row.voltage, c.voltage, "voltage");
    if (at.driven()) {
      const std::vector<double> known = carrier_frequencies(c);
      at.frequency = row.on ? needed(row.frequency, known, "frequency")
                            : row.frequency.value_or(known.front());
    }
    at.state = needed(row.state, finger_states(c), "state");
    out.experiment = {index, snapped_to_candidates(at, row, index)};
  }

  // By its name in the lab, as a plan writes that, or by the file that a table names.
  std::size_t design_index(const std::string& name) const {
    const std::vector<LabDesign>& all = context_.designs;
    const auto place_of = [&](const auto& is) {
      return static_cast<std::size_t>(std::find_if(all.begin(), all.end(), is) - all.begin());
    };
    const std::size_t named = place_of([&](const LabDesign& d) { return d.name == name; });
    if (named < all.size()) return named;
    const std::size_t written = place_of([&](const LabDesign& d) {
      std::string cell = d.name;  // no cell of a table has a comma
      std::replace(cell.begin(), cell.end(), ',', ';');
      return cell == name;
    });
    if (written < all.size()) return written;
    const std::string stem = std::filesystem::path(name).stem().string();
    return place_of([&](const LabDesign& d) { return d.name == stem; });
  }

  const MatchContext& context_;
  const TellOptions& options_;
  std::string file_;
  Steps steps_;
  int line_ = 0, as_planned_ = 0;
  std::vector<std::string> as_measured_;
  std::vector<Problem> problems_;
};

void note_conditions(const Matcher& matcher, Matched& out) {
  if (matcher.planned_conditions() > 0)
    out.notes.push_back(fmt::format(
        "{} within {} % RH, {:.0f} % of load, {:.0f} % of voltage and {:.0f} % of "
        "frequency of what was planned: taken as planned",
        counted(matcher.planned_conditions(), "reading"), significant(100 * kHumidityBand, 2),
        100 * kLoadBand, 100 * kVoltageBand, 100 * kFrequencyBand));
  for (const std::string& own : matcher.own_conditions())
    out.notes.push_back("measured otherwise than planned, and taken as measured: " + own);
}

// By the name of its design, whose place in the list may be another one later.
std::string key_of(const FrictionReading& r, const std::vector<LabDesign>& designs) {
  return fmt::format("\"{}\" | {} | {} | {} | {} | {:.9g} {:.9g}",
                     designs[r.experiment.design].name, text(r.experiment.at), r.finger, r.day,
                     r.repeat, r.off, r.on);
}

// What the name of a record's file says: a word of it is an experiment of the plan or a field.
void by_name(const std::string& file, const MatchContext& context, MeasuredRow& row) {
  std::string stem = std::filesystem::path(file).stem().string();
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return c == '_' || c == '-' || c == ' '; }, ' ');
  for (const std::string& word : split(stem, ' ')) {
    for (const PlannedExperiment& p : context.planned) {
      if (p.id == word) row.experiment = word;
    }
    for (const FieldEntry& f : context.file.fields) {
      if (f.field == word) row.field = word;
    }
  }
}

// What the head of a record says: what it is of, and conditions that it has no column of. A
// frequency there may be that of the samples, so that of the drive has a name of its own. Throws
// InputError with every line whose value cannot be read.
void by_head(const Trace& trace, const std::string& file, MeasuredRow& row) {
  std::vector<Problem> problems;
  const auto said = [&](const char* key, const std::string& expected, const auto& take) {
    const auto found = trace.said.find(key);
    if (found != trace.said.end() && !found->second.empty() && !take(found->second))
      problems.push_back(
          {file, 0, 0, key,
           fmt::format("\"{}\" in the head of the record: expected {}", found->second, expected)});
  };
  for (const auto& [key, target] :
       {std::pair("experiment", &row.experiment), std::pair("field", &row.field),
        std::pair("design", &row.design), std::pair("finger", &row.finger),
        std::pair("day", &row.day)}) {
    const auto found = trace.said.find(key);
    if (found != trace.said.end() && !found->second.empty()) *target = found->second;
  }
  said("repeat", "a whole number from 1 on", [&](const std::string& text) {
    const auto number = cell_number(text);
    if (!number || !(*number >= 1 && *number <= kMostRepeats) || *number != std::floor(*number))
      return false;
    row.repeat = static_cast<int>(*number);
    return true;
  });
  const auto quantity = [](const std::string& text, const char* unit, double most) {
    const auto q = parse_quantity(text);
    const bool fits =
        q && q->si >= 0 && q->si <= most &&
        (*unit == '%' ? q->unit == unit : find_unit(q->unit)->same_dimension(*find_unit(unit)));
    return fits ? std::optional(q->si) : std::nullopt;
  };
  said("humidity", "0 to 100 %, as \"75 %\"", [&](const std::string& text) {
    row.relative_humidity = quantity(text, "%", 1);
    return row.relative_humidity.has_value();
  });
  said("carrier", "a frequency, as \"5 kHz\"", [&](const std::string& text) {
    row.frequency = quantity(text, "Hz", kHighestFrequency);
    return row.frequency.has_value();
  });
  const std::vector<std::string>& names = finger_state_names();
  said("state", join_names(names), [&](const std::string& text) {
    const auto state = std::find(names.begin(), names.end(), text);
    if (state == names.end()) return false;
    row.state = static_cast<FingerState>(state - names.begin());
    return true;
  });
  if (!problems.empty()) throw InputError(problems);
}

// What no finger does, as in tables, and options that name another experiment or field than the
// record, which is of one alone. Throws InputError with all of it.
void check_record(const MeasuredRow& row, const TellOptions& options, const std::string& file) {
  std::vector<Problem> problems = row_problems(row, file);
  const auto problem = [&](const char* key, const std::string& message) {
    problems.push_back({file, 0, 0, key, message});
  };
  if (row.relative_humidity) {
    const std::string wrong = humidity_problem(*row.relative_humidity);
    if (!wrong.empty()) problem("humidity", wrong);
  }
  if (!(*row.load >= kLeastLoad && *row.load <= kLargestLoad))
    problem("normal", fmt::format("the finger pressed with {} N, outside {:g} to {:g} N: is the "
                                  "force in another unit?",
                                  significant(*row.load, 3), kLeastLoad, kLargestLoad));
  if (row.off && row.on && rubs_less_driven(row))
    problem("voltage",
            fmt::format("under voltage the finger rubs with {} mN, without it with {} mN, less by "
                        "more than touches scatter: is the voltage in the column while the drive "
                        "is on?",
                        significant(1e3 * *row.on, 3), significant(1e3 * *row.off, 3)));
  for (const auto& [key, in_record, in_options] :
       {std::tuple("experiment", row.experiment, options.experiment),
        std::tuple("field", row.field, options.field)}) {
    if (in_record.empty() || in_options.empty() || in_record == in_options) continue;
    problem(key, fmt::format("{} by the record's head or name, {} by --{}: leave the option out, "
                             "or correct the record",
                             in_record, in_options, key));
  }
  if (!problems.empty()) throw InputError(problems);
}

// The friction at the planned load, where the finger pressed a little otherwise: in proportion.
void to_load(FrictionReading& r, double load, std::vector<std::string>& notes) {
  const double by = r.experiment.at.load / load;
  const auto move = [&](double& force, double& sd) {
    const double moved = force * (by - 1);
    force += moved;
    sd = sd > 0 ? std::hypot(sd * by, kCorrectionError * moved) : 0;
  };
  move(r.off, r.off_sd);
  move(r.on, r.on_sd);
  if (std::abs(by - 1) > 0.01)
    notes.push_back(
        fmt::format("pressed with {} N where {} N were meant: friction taken in "
                    "proportion, half of the difference added to its error",
                    significant(load, 3), significant(r.experiment.at.load, 3)));
}

}  // namespace

Matched match_table(const MeasuredTable& table, const MatchContext& context,
                    const TellOptions& options, const std::string& file) {
  Matcher matcher(context, options, file);
  Matched out;
  out.notes = table.notes;
  std::map<std::string, int> seen;
  for (const MeasuredRow& row : table.rows) {
    auto reading = matcher.match(row);
    if (!reading) continue;
    if (!row.measured()) {
      ++out.empty;
      continue;
    }
    // Rows alike in everything are readings alike: the first, the second, ...
    reading->row = reading_text(
        row.load.value_or(reading->experiment.at.load),
        row.relative_humidity.value_or(reading->experiment.at.relative_humidity),
        row.voltage.value_or(reading->experiment.at.voltage), reading->off, reading->on);
    reading->key = key_of(*reading, context.designs);
    reading->key += fmt::format(" | {}", ++seen[reading->key]);
    out.readings.push_back(std::move(*reading));
  }
  matcher.tell_problems();
  note_conditions(matcher, out);
  return out;
}

Matched match_trace(const Trace& trace, const TraceReading& reading, const MatchContext& context,
                    const TellOptions& options, const std::string& file) {
  MeasuredRow row;
  by_name(file, context, row);
  by_head(trace, file, row);
  row.load = reading.load;
  if (reading.relative_humidity) row.relative_humidity = reading.relative_humidity;
  if (reading.on_sd > 0) row.voltage = reading.voltage;
  if (reading.off_sd > 0) {
    row.off = reading.off;
    row.off_sd = reading.off_sd;
  }
  if (reading.on_sd > 0) {
    row.on = reading.on;
    row.on_sd = reading.on_sd;
  }
  check_record(row, options, file);
  Matcher matcher(context, options, file, kOfRecords);
  Matched out;
  auto found = matcher.match(row);
  matcher.tell_problems();
  to_load(*found, reading.load, out.notes);
  note_conditions(matcher, out);
  found->key = key_of(*found, context.designs) + " | record";
  out.readings.push_back(std::move(*found));
  return out;
}

FrictionReading as_of_day(FrictionReading reading, const std::string& day,
                          const std::vector<LabDesign>& designs) {
  const std::size_t which = reading.key.rfind(" | ");  // of several alike, or a record
  const std::string tail = which == std::string::npos ? "" : reading.key.substr(which);
  reading.day = day;
  reading.key = key_of(reading, designs) + tail;
  return reading;
}

}  // namespace papilla::lab
