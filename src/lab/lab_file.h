// A lab as a file, lab.toml of its folder: what is decided, which designs and conditions can be
// measured, how the instrument scatters, what an experiment costs. People edit it.
#pragma once

#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "config/fields.h"
#include "design/design.h"
#include "lab/batch.h"
#include "lab/noise.h"
#include "scene/belief.h"

namespace papilla::lab {

// What can be set at the instrument: every design is measurable at every combination.
struct CandidateConditions {
  std::vector<double> load, humidity, voltage, frequency;
  std::vector<std::string> states;
};

std::vector<FingerState> finger_states(const CandidateConditions& conditions);
// [Hz]; 0: that of each design, which is the only one where the lab names none.
std::vector<double> carrier_frequencies(const CandidateConditions& conditions);

struct DesignEntry {
  std::string name, file;
  bool choice = true;  // one of those that are decided among
};

// Of a wafer's manifest: a design in a place, under conditions.
struct FieldEntry {
  std::string field, design;
  double load = 0.2, humidity = 0.15, voltage = 0, frequency = 0;
  FingerState state = FingerState::Clean;
};

struct LabFile {
  std::string source;  // what it was opened with, for people
  std::string belief = "prior.toml";
  std::string worth;            // what designs are chosen by; "": nothing is decided
  std::string worth_file;       // their worth at each member, of a run; "": by the model
  std::string risk = "regret";  // how belief decides among designs: parse_belief_risk reads it
  double limits = 0.9;          // probability that a choice keeps its limits
  double stop = 0.005;          // expected regret over the best worth: more is not worth it
  double discrepancy = 0.2;     // size of a model's error that is looked for, a share
  Instrument instrument;
  Costs costs;
  CandidateConditions conditions;
  std::vector<DesignEntry> designs;
  std::vector<FieldEntry> fields;  // none: every design at all conditions
};

void fields(FieldVisitor& v, CandidateConditions& s);
void fields(FieldVisitor& v, DesignEntry& s);
void fields(FieldVisitor& v, FieldEntry& s);
void fields(FieldVisitor& v, LabFile& s);

// The lab of a folder. Throws InputError with every mistake and its place.
LabFile read_lab_file(const std::string& folder);
// A lab before it has a folder, with other values: "instrument.repeatability=2 %". Throws
// InputError, also for what a lab is opened with (designs, belief, worth).
LabFile with_values(const LabFile& file, const std::vector<std::string>& values);
std::string lab_file_text(const LabFile& file);

// A limit of the run's study, and with which probability a design keeps it, by the run's belief.
struct RunLimit {
  std::string name;
  double probability = 1;
};

// What the run that a lab stands on says of its designs at each member.
struct RunWorth {
  std::string name;                        // what they are compared in
  std::vector<std::string> designs;        // in the order of the file
  std::vector<std::vector<double>> worth;  // [design][member]; NaN: none
  std::vector<std::vector<bool>> kept;     // [design][member]: every limit
  // [design][skin]: what the run's skins leave open of them, deviations by each. Eq. lab.3
  std::vector<std::vector<double>> by_skin;
  std::vector<std::vector<RunLimit>> limits{};  // [design]; empty: a file of an older program
};
std::string run_worth_text(const RunWorth& worth);
RunWorth read_run_worth(const std::string& text, const std::string& file);

}  // namespace papilla::lab
