// What a lab folder remembers: how it was opened, experiments planned, readings told, decisions
// with their dates. Each is one record of the journal, so it is there as a whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/batch.h"
#include "lab/decision_gain.h"
#include "lab/experiment.h"

namespace papilla::lab {

// An experiment to make. Readings of it name it, or its field.
struct PlannedExperiment {
  std::string id;     // "E07"
  std::string field;  // of the wafer; "": none
  Experiment experiment;
  int repeats = 1;                // touches
  double gain = 0;                // of what there is to gain, when it was chosen
  std::vector<Foreseen> off, on;  // thirds of its readings; empty without a decision
  // Of a touch, by belief and the readings before the plan [N]: median and 95 % interval.
  std::vector<double> expected_off, expected_on;
};

// Why no more experiments are worth it.
enum class StopReason {
  Regret,    // what is expected to be lost is below what is worth measuring
  NoChange,  // what can be measured changes no decision, and saves less than that
};
const std::vector<std::string>& stop_reason_names();  // "regret", "no change"

struct PlanRecord {
  std::string date;
  Aim aim = Aim::Decision;
  std::vector<PlannedExperiment> experiments;
  double seconds = 0;                       // of work
  double regret_now = 0, regret_after = 0;  // expected, without a decision 0
  // Of the best choice when it was planned, as a regret is a share of it; 0: as above, or a plan of
  // an older program.
  double best_worth = 0;
  double p_change = 0;                    // that the readings choose another design
  bool stop = false;                      // no more experiments are worth it
  std::optional<StopReason> stop_reason;  // none: no stop, or a plan of an older program
  std::optional<BatchEnd> ended;          // none: a plan of an older program
  double shortest = 0;                    // of what took too long for the time [s]
};

// A friction that was measured, off and on where both were.
struct FrictionReading {
  Experiment experiment;
  std::string id, field;  // of the plan and the wafer, where it names them
  std::string finger, day;
  int repeat = 0;
  double off = 0, off_sd = 0, on = 0, on_sd = 0;  // [N]; 0: not measured
  int line = 0;                                   // of the table; 0: a trace
  std::string key;  // what it is of its design, which it names, and which of several alike
  std::string row;  // as its table has it (reading_text), before it was taken as planned
};

struct TellRecord {
  std::string date, file, sha256;
  bool trace = false;
  std::vector<FrictionReading> readings;  // new ones
  std::vector<std::string> notes;
  std::vector<std::string> replaced{};  // keys of what the same file was told as before
};

// What belief says of the designs at a time.
struct DecisionRecord {
  std::string date;
  std::size_t readings = 0;
  std::string best;  // design; "": there is no decision
  double p_best = 0, regret = 0;
  std::vector<double> p_designs;  // p(best) of each choice of then, in the order of lab.toml
  std::vector<double> p_hypothesis;
  double effective_members = 0;
  double explained = 1;     // probability that the members explain all readings
  std::string discrepancy;  // the likeliest place where they do not
  // Of p_designs; empty: a record of an older program, whose choices are not known any more.
  std::vector<std::string> designs{};
};

// Told and what came of it, in one record.
struct JournalEntry {
  std::optional<PlanRecord> plan;
  std::optional<TellRecord> tell;
  std::optional<DecisionRecord> decision;
};

// designs: the names of the lab's list. A record names its designs, so that it is of the same ones
// wherever they stand in the list later.
std::string entry_text(const JournalEntry& entry, const std::vector<std::string>& designs);
// Throws InputError for what this program has not written, and for a design that is not in the list
// any more. Records of an older program have designs by their places in the list.
JournalEntry read_entry(const std::string& text, const std::vector<std::string>& designs);

}  // namespace papilla::lab
