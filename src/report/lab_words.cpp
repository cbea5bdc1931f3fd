#include "report/lab_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "metrics/shown.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

std::string lab_percent(double share) {
  if (share > 0.99 && share < 1 - 1e-9) return "over 99 %";
  if (share > 1e-9 && share < 0.01) return "under 1 %";
  return fmt::format("{:.0f} %", 100 * share);
}

const std::string& choice_name(const Lab& lab, const Standing& s, std::size_t choice) {
  return lab.designs()[s.choices[choice]].name;
}

// What designs are compared in, where it is one metric: a run may compare them by more.
std::optional<MetricExpression> worth_metric(const LabFile& file) {
  try {
    return parse_metric(file.worth);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string newtons(double force) { return significant(1e3 * force, 3) + " mN"; }

std::string hours(double seconds) {
  const long minutes = std::lround(seconds / 60);
  return minutes < 60 ? fmt::format("{} min", minutes)
                      : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

std::string hypotheses_text(const Ensemble& e, const std::vector<double>& p) {
  std::vector<std::string> out;
  for (std::size_t h = 0; h < p.size(); ++h)
    out.push_back(fmt::format("\"{}\" {}", e.hypotheses[h], lab_percent(p[h])));
  return join_names(out);
}

std::string in_worth_unit(const Lab& lab, double difference) {
  const ShownUnit shown = worth_unit(lab.file());
  return significant(shown.scale * difference, 2) + (shown.unit.empty() ? "" : " " + shown.unit);
}

// best_worth: of the same time; 0: not known.
std::string regret_text(const Lab& lab, double best_worth, double regret) {
  if (best_worth == 0) return in_worth_unit(lab, regret);
  return fmt::format("{} ({} %)", in_worth_unit(lab, regret),
                     significant(100 * regret / std::abs(best_worth), 2));
}

bool of_run(const Lab& lab) { return !lab.file().worth_file.empty(); }

std::string choices_table(const Lab& lab, const Standing& s) {
  const ShownUnit shown = worth_unit(lab.file());
  const std::string unit = shown.unit.empty() ? "" : " [" + shown.unit + "]";
  const bool limited = std::any_of(s.prospects.begin(), s.prospects.end(),
                                   [](const Prospect& p) { return p.p_limits < 1 - 1e-9; });
  std::vector<std::string> head{"design", "p(best)", "expected regret",
                                "worth" + unit + ", median (95 %)",
                                "behind the best" + unit + ", median (95 %)"};
  if (limited) head.push_back(of_run(lab) ? "p(every limit)" : "p(has a value)");
  std::string out = markdown_head(head);
  for (std::size_t i = 0; i < s.prospects.size(); ++i) {
    const auto band = [&](const Standing::Interval& v) {
      return fmt::format("{} ({} to {})", significant(shown.scale * v.median, 3),
                         significant(shown.scale * v.low, 3), significant(shown.scale * v.high, 3));
    };
    std::vector<std::string> row{choice_name(lab, s, i), lab_percent(s.prospects[i].p_best),
                                 regret_text(lab, s.best_worth, s.prospects[i].regret),
                                 band(s.worth[i].times(worth_sign(lab.file(), s))),
                                 i == s.best ? "" : band(s.behind[i])};
    if (limited) row.push_back(lab_percent(s.prospects[i].p_limits));
    out += markdown_row(row);
  }
  return out;
}

// Whether the best keeps its limits: "front/01 keeps every limit of its study with probability 9 %,
// where 90 % are wanted (`limits` in lab.toml). ..."; "" where it does as surely as is wanted.
// Readings move the probability of all limits together: of each alone the run's is known.
std::string limits_text(const Lab& lab, const Standing& s) {
  if (s.keeps_limits()) return {};
  std::vector<std::string> unsure;
  for (const RunLimit& limit : lab.run_limits(s.best)) {
    if (limit.probability < 1 - 1e-9)
      unsure.push_back(fmt::format("{} ({})", limit.name, lab_percent(limit.probability)));
  }
  return fmt::format(
      "{} {} with probability {}, where {} are wanted (`limits` in lab.toml).{}",
      choice_name(lab, s, s.best),
      of_run(lab) ? "keeps every limit of its study" : "has a value of " + lab.file().worth,
      lab_percent(s.prospects[s.best].p_limits), lab_percent(s.limits.wanted),
      unsure.empty() ? ""
                     : " It may break, with the probability that the run gave to keeping it: " +
                           join_names(unsure) + ".");
}

// What to do where the choice is settled and none of the designs keeps its limits surely enough.
std::string broken_limits_text(const Lab& lab, const Standing& s) {
  if (s.keeps_limits()) return {};
  const std::string& folder = lab.folder().path();
  std::string out = fmt::format(
      "\n**To stop does not mean that the design is good enough.** {} None of the {} designs "
      "reaches that. What can be done:\n\n",
      limits_text(lab, s), s.prospects.size());
  if (const std::optional<Aim> aim = aim_at_limits(s))
    out += fmt::format(
        "- Measure more: members of the belief differ in whether it does, and `papilla next {} "
        "--for {}` plans readings that tell them apart.\n",
        folder, aim_names()[static_cast<std::size_t>(*aim)]);
  if (!lab.readings().empty())
    out += fmt::format(
        "- Search again with what the readings say: set `belief = \"{}/belief.toml\"` in the "
        "study's [finger] and run `papilla optimize`.\n",
        folder);
  return out +
         "- Give the search more room, or loosen the limit in the study, and open a lab for the "
         "new run.\n";
}

std::string discrepancy_text(const Standing& s) {
  const Discrepancies& d = s.discrepancies;
  if (d.found.empty()) return {};
  const Discrepancy& first = d.found.front();
  std::string out = fmt::format(
      "The members explain all readings with probability {} (chi squared {} a reading).",
      lab_percent(d.none), significant(d.misfit, 2));
  if (d.none > 0.5) return out;
  out += fmt::format(
      " What no member explains is most likely found {} (probability {}): friction is {:+.0f} % ± "
      "{:.0f} % off there.",
      first.where, lab_percent(first.probability), 100 * first.change(),
      100 * first.change_deviation());
  if (d.found.size() > 1 && d.found[1].probability > 0.05)
    out += fmt::format(" If not, it is found {} (probability {}).", d.found[1].where,
                       lab_percent(d.found[1].probability));
  return out;
}

std::string gauge_text(const Lab& lab, const Standing& s) {
  std::string out;
  const Instrument& stated = lab.file().instrument;
  const auto line = [&](const char* name, const GaugeSpread& found, double is, double used) {
    if (found.freedom == 0) return;
    out += fmt::format("- {}: the readings show {} % ({}), lab.toml states {} %{}\n", name,
                       significant(100 * found.deviation, 2), counted(found.freedom, "difference"),
                       significant(100 * is, 2), used > is ? "; that of the readings is used" : "");
  };
  line("repeatability", s.gauge.repeatability, stated.repeatability, s.instrument.repeatability);
  line("day to day", s.gauge.day_to_day, stated.day_to_day, s.instrument.day_to_day);
  line("finger to finger", s.gauge.finger_to_finger, stated.finger_to_finger,
       s.instrument.finger_to_finger);
  return out.empty() ? out : "\nThe instrument:\n\n" + out;
}

bool of_several_fingers(const Lab& lab) {
  const std::vector<FrictionReading> readings = lab.readings();
  return std::any_of(readings.begin(), readings.end(),
                     [&](const FrictionReading& r) { return r.finger != readings.front().finger; });
}

std::string members_text(const Lab& lab, const Standing& s) {
  std::string out = fmt::format("The belief is as good as {} equally weighted members.",
                                significant(s.effective_members, 3));
  if (s.effective_members < kFewMembers)
    out += fmt::format(
        " These are too few to rely on: fit it again to all readings{} (`papilla calibrate` takes "
        "readings.csv of this folder; add the rows of the table that the belief was fitted to), "
        "with more `belief.members` where it had hardly more from the start, and open a new lab "
        "with the belief of that fit.",
        of_several_fingers(lab) ? " of one finger, which `data_finger` names" : "");
  return out;
}

// "below 61 mN: front/02 (80 %); between: ...; above 75 mN: front/05 (64 %)"
std::string thirds_text(const std::vector<Foreseen>& thirds) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < thirds.size(); ++k) {
    const std::string where = k == 0                   ? "below " + newtons(thirds[k].high)
                              : k + 1 == thirds.size() ? "above " + newtons(thirds[k].low)
                                                       : std::string("between");
    out.push_back(
        fmt::format("{}: {} ({})", where, thirds[k].design, lab_percent(thirds[k].p_choice)));
  }
  return join_names(out, "; ");
}

bool changes(const std::vector<Foreseen>& thirds) {
  return !thirds.empty() && std::any_of(thirds.begin(), thirds.end(), [&](const Foreseen& o) {
    return o.choice != thirds.front().choice || o.p_choice < 0.9;
  });
}

std::string outcomes_text(const PlanRecord& plan) {
  std::string out;
  for (const PlannedExperiment& e : plan.experiments) {
    for (const auto& [name, thirds] : {std::pair("F_off", &e.off), std::pair("F_on", &e.on)}) {
      if (changes(*thirds)) out += fmt::format("- {}, {} {}\n", e.id, name, thirds_text(*thirds));
    }
  }
  if (out.empty()) return "\nNo single outcome changes the choice.\n";
  return "\nWhat each outcome would change, once the whole batch is in (the design that is then "
         "chosen most often):\n\n" +
         out;
}

std::string expectation(const std::vector<double>& e) {
  if (e.empty()) return "";
  return fmt::format("{} ({} to {})", significant(1e3 * e[0], 3), significant(1e3 * e[1], 3),
                     significant(1e3 * e[2], 3));
}

std::string plan_table(const Lab& lab, const PlanRecord& plan) {
  const bool fields = std::any_of(plan.experiments.begin(), plan.experiments.end(),
                                  [](const PlannedExperiment& e) { return !e.field.empty(); });
  std::vector<std::string> head{
      "experiment", "design", "conditions", "touches", "F_off expected [mN]", "F_on expected [mN]"};
  if (fields) head.insert(head.begin() + 1, "field");
  std::string out = markdown_head(head);
  for (const PlannedExperiment& e : plan.experiments) {
    std::vector<std::string> row{e.id,
                                 lab.designs()[e.experiment.design].name,
                                 text(e.experiment.at),
                                 std::to_string(e.repeats),
                                 expectation(e.expected_off),
                                 expectation(e.expected_on)};
    if (fields) row.insert(row.begin() + 1, e.field);
    out += markdown_row(row);
  }
  return out;
}

// That no more is worth measuring, and why; "" where it is.
std::string stop_reason_text(const Lab& lab, const PlanRecord& plan) {
  if (plan.aim != Aim::Decision || !plan.stop_reason) return {};
  const std::string regret = regret_text(lab, plan.best_worth, plan.regret_now);
  switch (*plan.stop_reason) {
    case StopReason::Regret:
      return fmt::format(
          "Stop: the expected regret of the choice, {}, is below the least that is worth measuring "
          "(`stop` in lab.toml).",
          regret);
    case StopReason::NoChange:
      return fmt::format(
          "Stop: more experiments would hardly change the choice. Of its expected regret, {}, they "
          "would save less than is worth measuring (`stop` in lab.toml).",
          regret);
  }
  return {};
}

std::string stop_text(const Lab& lab, const Standing& s, const PlanRecord& plan) {
  if (plan.aim != Aim::Decision) return {};
  if (const std::string reason = stop_reason_text(lab, plan); !reason.empty())
    return "\n" + reason + "\n" + broken_limits_text(lab, s);
  return "\nStop when the expected regret is below `stop` of lab.toml: `papilla tell` says it "
         "after "
         "every table.\n";
}

// Why a plan is empty.
std::string empty_text(const PlanRecord& plan) {
  if (plan.ended != BatchEnd::Time) return "No experiment of this lab would tell anything new.\n";
  return fmt::format(
      "Nothing fits into the time that was given: the shortest experiment that tells anything "
      "takes {}.\n",
      hours(plan.shortest));
}

std::string decision_line(const Lab& lab, const DecisionRecord& d) {
  std::string out =
      fmt::format("{}, {}", d.date, counted(static_cast<long long>(d.readings), "reading"));
  if (!d.best.empty())
    out += fmt::format(": {} is the best with probability {}, expected regret {}", d.best,
                       lab_percent(d.p_best), in_worth_unit(lab, d.regret));
  return out + fmt::format("; as good as {} members", significant(d.effective_members, 3));
}

// That measurements are valued by another criterion than the one that decides; "" where they are
// not.
std::string criterion_text(const Lab& lab, const Standing& s) {
  if (s.risk.regret) return {};
  return fmt::format(
      "What a measurement is worth, whether to stop and which design is chosen after it are by "
      "the least expected regret alone, not by `risk` = \"{}\" of lab.toml: for one criterion in "
      "both set `risk` to \"regret\".",
      lab.file().risk);
}

std::string decision_reason(const Lab& lab, const Standing& s, const PlanRecord& plan) {
  const std::string now = regret_text(lab, plan.best_worth, plan.regret_now),
                    then = regret_text(lab, plan.best_worth, plan.regret_after);
  const std::string why =
      plan.regret_after < plan.regret_now && then != now
          ? fmt::format(
                "they lower the expected regret of the choice most for the time they take, from {} "
                "to {}",
                now, then)
          : fmt::format(
                "they tell the designs apart most for the time they take; the expected regret of "
                "the choice does not fall by them, {} now and {} then{}",
                now, then,
                plan.regret_after > plan.regret_now
                    ? ", as what they say of the limits may leave worse designs to choose among"
                    : "");
  const std::string criterion = criterion_text(lab, s);
  return fmt::format(
      "Why these: of all that can be measured {}; with probability {} another design is chosen "
      "after them.{}",
      why, lab_percent(plan.p_change), criterion.empty() ? "" : " " + criterion);
}

}  // namespace

ShownUnit worth_unit(const LabFile& file) {
  const std::optional<MetricExpression> metric = worth_metric(file);
  return metric ? shown_unit(*metric) : ShownUnit{};
}

// A run may maximise what is better lower: the sign of what is never negative says which it does.
double worth_sign(const LabFile& file, const Standing& s) {
  const std::optional<MetricExpression> metric = worth_metric(file);
  if (!metric) return 1;
  const bool less = keeps_sign(metric->summary, metric->metric)
                        ? s.best_worth < 0
                        : better_direction(*metric) == Better::Lower;
  return less ? -1 : 1;
}

std::string lab_standing_text(Lab& lab) {
  const Standing& s = lab.standing();
  std::string out;
  if (s.decided()) {
    const Prospect& best = s.prospects[s.best];
    out += fmt::format("{} is the best of {} in {} with probability {}; expected regret {}.\n\n",
                       choice_name(lab, s, s.best), s.prospects.size(), lab.file().worth,
                       lab_percent(best.p_best), regret_text(lab, s.best_worth, best.regret));
    if (!s.risk.regret)
      out += fmt::format(
          "It is chosen by `risk` = \"{}\" of lab.toml, not by the least expected "
          "regret.\n\n",
          lab.file().risk);
    out += choices_table(lab, s) + "\n";
    if (const std::string limits = limits_text(lab, s); !limits.empty()) out += limits + "\n\n";
    if (of_run(lab) && lab.readings().empty())
      out +=
          "p(best) and regret are not quite those of the run, which asks each member as it is, "
          "with what the skins leave open at that member: the lab also counts what lies between "
          "the members, so that readings can move it, and what the skins leave open on average "
          "over the members.\n\n";
  }
  if (s.unanswered > 0)
    out += fmt::format("At members with {} of belief no design has a value of {}: {}.\n\n",
                       lab_percent(s.unanswered), lab.file().worth,
                       s.decided() ? "the others alone decide" : "nothing is decided");
  if (s.ensemble.hypotheses.size() > 1)
    out += "Hypotheses: " + hypotheses_text(s.ensemble, s.p_hypothesis) + ".\n";
  out += members_text(lab, s) + "\n";
  if (const std::string found = discrepancy_text(s); !found.empty()) out += found + "\n";
  return out + gauge_text(lab, s);
}

std::string lab_summary_text(Lab& lab) {
  const Standing& s = lab.standing();
  // The newest decision, and the one that the last file found: plans keep theirs too.
  const DecisionRecord *newest = nullptr, *before = nullptr;
  const PlanRecord* plan = nullptr;  // that nothing was told since
  long long files = 0;
  for (const JournalEntry& e : lab.entries()) {
    if (e.tell) {
      before = newest;
      plan = nullptr;
      ++files;
    }
    if (e.plan) plan = &*e.plan;
    if (e.decision) newest = &*e.decision;
  }
  std::string out = "Nothing is to be decided";
  if (s.decided()) {
    const std::string& name = choice_name(lab, s, s.best);
    out = fmt::format("{} is the best with probability {}", name,
                      lab_percent(s.prospects[s.best].p_best));
    if (before && !before->best.empty())
      out += fmt::format(" (before {}{})", before->best == name ? "" : before->best + " with ",
                         lab_percent(before->p_best));
    out += ", expected regret " + regret_text(lab, s.best_worth, s.prospects[s.best].regret);
  }
  out += files == 0 ? "."
                    : fmt::format("; {} of {} told.",
                                  counted(static_cast<long long>(lab.readings().size()), "reading"),
                                  counted(files, "file"));
  std::vector<std::string> more{discrepancy_text(s)};
  if (s.effective_members < kFewMembers) more.push_back(members_text(lab, s));
  if (s.decided()) more.push_back(limits_text(lab, s));
  if (plan) more.push_back(stop_reason_text(lab, *plan));
  for (const std::string& sentence : more) out += (sentence.empty() ? "" : " ") + sentence;
  return out;
}

std::string lab_plan_reason(Lab& lab, const PlanRecord& plan) {
  const Standing& s = lab.standing();
  switch (plan.aim) {
    case Aim::Decision:
      return decision_reason(lab, s, plan);
    case Aim::Hypotheses:
      return "Why these: the hypotheses of the model differ most there for the scatter of a "
             "reading (T-optimal). They weigh now: " +
             hypotheses_text(s.ensemble, s.p_hypothesis) + ".";
    case Aim::Parameters:
      return "Why these: they shrink most of all that the members of belief differ in (D-optimal).";
  }
  return {};
}

std::string lab_plan_text(Lab& lab, const PlanRecord& plan) {
  const Standing& s = lab.standing();
  std::string out = "# What to measure next\n\n" + lab_standing_text(lab) + "\n";
  if (plan.experiments.empty()) {
    const std::string criterion = plan.aim == Aim::Decision ? criterion_text(lab, s) : "";
    return out + empty_text(plan) + criterion + (criterion.empty() ? "" : "\n") +
           stop_text(lab, s, plan);
  }
  out += plan_table(lab, plan) + "\n" + lab_plan_reason(lab, plan) +
         fmt::format(" It takes {}.\n", hours(plan.seconds));
  if (plan.aim == Aim::Decision) out += outcomes_text(plan);
  return out + stop_text(lab, s, plan);
}

std::string lab_told_text(const Lab& lab, const Told& told) {
  std::string out;
  const std::string& file = told.record.file;
  const auto count = static_cast<long long>(told.record.readings.size());
  if (count > 0) {
    out += fmt::format("{}: {} told\n", file, counted(count, "reading"));
    for (const FrictionReading& r : told.record.readings) {
      std::vector<std::string> forces;
      const auto add = [&](const char* name, double force, double sd) {
        if (force > 0)
          forces.push_back(fmt::format(
              "{} {} mN", name,
              sd > 0 ? with_error(1e3 * force, 1e3 * sd) : significant(1e3 * force, 4)));
      };
      add("F_off", r.off, r.off_sd);
      add("F_on", r.on, r.on_sd);
      out += fmt::format("- {}{}, {}: {}\n", r.id.empty() ? "" : r.id + " ",
                         lab.designs()[r.experiment.design].name, text(r.experiment.at),
                         join_names(forces));
    }
  }
  if (told.already > 0)
    out += fmt::format("{}: {} told already, in {}: not counted again\n", file,
                       counted(told.already, "reading"), told.already_of);
  if (told.fitted > 0)
    out += fmt::format(
        "{}: {} left out, since the belief is made of {} (`readings` in {}): counted again they "
        "would make it surer than it is. What is measured from now on tells more\n",
        file, counted(told.fitted, "reading"), told.fitted == 1 ? "it" : "them", lab.file().belief);
  if (told.empty > 0)
    out += fmt::format("{}: {} not measured yet, left planned\n", file, counted(told.empty, "row"));
  for (const std::string& n : told.record.notes) out += "- " + n + "\n";
  if (!told.after) return out;
  out += "\nBefore: " + decision_line(lab, *told.before) + ".\n";
  out += "Now:    " + decision_line(lab, *told.after) + ".\n";
  if (told.before->best != told.after->best)
    out += fmt::format("The recommendation changes from {} to {}.\n", told.before->best,
                       told.after->best);
  return out;
}

std::string lab_page(Lab& lab) {
  std::string out = "# Lab: " + lab.file().source + "\n\n" + lab_standing_text(lab);
  std::vector<std::string> decisions, told;
  const PlanRecord* last = nullptr;
  for (const JournalEntry& e : lab.entries()) {
    if (e.plan) last = &*e.plan;
    if (e.decision)
      decisions.push_back(
          decision_line(lab, *e.decision) +
          (e.plan ? fmt::format(
                        " ({} planned)",
                        counted(static_cast<long long>(e.plan->experiments.size()), "experiment"))
                  : " (" + e.tell->file + " told)"));
    if (!e.tell) continue;
    told.push_back(
        fmt::format("{}, {}: {}", e.tell->date, e.tell->file,
                    counted(static_cast<long long>(e.tell->readings.size()), "reading")));
    for (const std::string& n : e.tell->notes) told.push_back("  - " + n);
  }
  if (last && !last->experiments.empty()) out += "\n## Planned last\n\n" + plan_table(lab, *last);
  if (!told.empty()) {
    out += "\n## Told\n\n";
    for (const std::string& t : told) out += t.starts_with("  ") ? t + "\n" : "- " + t + "\n";
  }
  if (!decisions.empty()) out += "\n## Decisions\n\n";
  for (const std::string& d : decisions) out += "- " + d + "\n";
  return out;
}

namespace {

// Of the carrier [Hz].
double frequency_of(const Lab& lab, const Experiment& e) {
  if (e.at.frequency > 0) return e.at.frequency;
  return lab.designs()[e.design].design.drive.frequency;
}

// The last touch of an experiment that was planned or told before this plan.
int last_touch_before(const Lab& lab, const PlannedExperiment& planned) {
  int last = 0;
  for (const JournalEntry& e : lab.entries()) {
    if (e.plan) {
      for (const PlannedExperiment& p : e.plan->experiments) {
        if (p.id == planned.id) return last;
        if (p.experiment == planned.experiment) last += p.repeats;
      }
    }
    if (!e.tell) continue;
    for (const FrictionReading& r : e.tell->readings) {
      if (r.experiment == planned.experiment) last = std::max(last, r.repeat);
    }
  }
  return last;
}

}  // namespace

std::string lab_plan_csv(const Lab& lab, const PlanRecord& plan) {
  std::string out =
      "experiment,field,design,repeat,load_N,humidity_percent,voltage_V,frequency_Hz,state,finger,"
      "day,F_off_N,F_off_sd_N,F_on_N,F_on_sd_N\n";
  for (const PlannedExperiment& e : plan.experiments) {
    const Conditions& at = e.experiment.at;
    const int before = last_touch_before(lab, e);
    for (int k = 1; k <= e.repeats; ++k)
      out += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},,,,,,\n", e.id,
                         csv_cell(e.field), csv_cell(lab.designs()[e.experiment.design].name),
                         before + k, at.load, 100 * at.relative_humidity, at.voltage,
                         at.driven() ? frequency_of(lab, e.experiment) : 0,
                         finger_state_names()[static_cast<std::size_t>(at.state)]);
  }
  return out;
}

std::string lab_readings_csv(const Lab& lab) {
  std::string out =
      "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,"
      "F_on_sd_N,finger,state\n";
  const double own = lab.file().instrument.repeatability;
  const auto cells = [&](double force, double stated) {
    return force > 0 ? fmt::format("{:.6g},{:.3g}", force, std::hypot(stated, own * force)) : ",";
  };
  for (const FrictionReading& r : lab.readings()) {
    const Conditions& at = r.experiment.at;
    out += fmt::format("{},{:.4g} %,{:.6g},{:.6g},{:.6g},{},{},{},{}\n",
                       lab.file().designs[r.experiment.design].file, 100 * at.relative_humidity,
                       at.voltage, frequency_of(lab, r.experiment), at.load, cells(r.off, r.off_sd),
                       cells(r.on, r.on_sd), csv_cell(r.finger),
                       finger_state_names()[static_cast<std::size_t>(at.state)]);
  }
  return out;
}

}  // namespace papilla::report
