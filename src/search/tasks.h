// The work that one design is: each finger in each scenario, as designed and within its scatter.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/study.h"

namespace papilla::search {

// One finger in one scenario, as designed or with one number at an end of its scatter: the unit of
// work.
struct StudyTask {
  std::string name;  // "reference", "moist, worn"
  double weight = 1;
  Finger finger;
  std::vector<Setting> settings;  // of the scenario
  int scattered = -1;             // which of the study's scatter; -1: as designed
  int sign = 0;                   // -1, +1: the end
  bool driven = true;             // some design of the study has a voltage or a current in it

  bool nominal() const { return scattered < 0; }
};

// Those as designed first, then of each of them every scatter low and high; none of a scenario
// without weight. Throws InputError when no scenario has one, when all of them set a number that is
// searched, or when a searched drive.frequency is felt by none.
std::vector<StudyTask> study_tasks(const Study& study);

// The design of a task: finger, scenario, then the end of the scatter, within the range that the
// number may have at all. flat: the surface without its relief, whatever the scenario makes of it.
Design task_design(const Study& study, Design design, const StudyTask& task, bool flat = false);

// Plates of a design: all numbers that scatter set together.
class Plates {
 public:
  Plates(const Study& study, const Design& design);
  Plates(const Plates&) = delete;
  Plates& operator=(const Plates&) = delete;

  // deviation: of each scatter of the study, in units of its end. Valid until the next call.
  const Design& plate(const std::vector<double>& deviation);

 private:
  struct Number {
    double* value;                   // of design_; null: this design does not have it
    double nominal, end, low, high;  // SI
  };
  Design design_;
  std::vector<Number> numbers_;
};

// What is wrong with the shape, as designed or within its scatter; empty: nothing.
std::string shape_trouble(const Study& study, const std::vector<StudyTask>& tasks,
                          const Design& design);

// Why drive.frequency changes nothing on this design; "" where it may.
std::string frequency_not_felt(const Design& design);

}  // namespace papilla::search
