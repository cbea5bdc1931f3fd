// Which experiment a row or a record is of, and that none is guessed.
#include "lab/matching.h"

#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace papilla::tests::matching_test {
namespace {

FieldEntry field(double load, double humidity, double voltage = 0) {
  return {"A3", "deep", load, humidity, voltage, 0, FingerState::Clean};
}

class Tell : public testing::Test {
 protected:
  Tell() : designs_{{"deep", Design(), true}} {
    lab_.conditions = {{0.2}, {0.35}, {200}, {}, {"clean"}};
  }

  FrictionReading told(const std::string& text) const {
    const MatchContext to{lab_, designs_, planned_};
    return match_table(read_measured_table(text, "table.csv"), to, {}, "table.csv")
        .readings.front();
  }
  FrictionReading record(Trace trace, TraceReading reading, const std::string& name) const {
    const MatchContext to{lab_, designs_, planned_};
    return match_trace(trace, reading, to, {}, name).readings.front();
  }
  std::string refused(const std::string& text) const {
    return keyed_refusal_of([&] { told(text); });
  }

  LabFile lab_;
  std::vector<LabDesign> designs_;
  std::vector<PlannedExperiment> planned_;
};

TEST_F(Tell, AsksForWhatTellsTheConditionsOfAFieldApart) {
  lab_.fields = {field(0.2, 0.15), field(0.2, 0.75), field(0.5, 0.75)};
  EXPECT_EQ(refused("field,load_N,F_off_N\nA3,0.2,0.1\n").substr(0, 58),
            "field: A3 is to be measured at more than one humidity: say");
  EXPECT_NE(refused("field,humidity_percent,F_off_N\nA3,75,0.1\n").find("more than one load:"),
            std::string::npos);
  EXPECT_NE(refused("field,F_off_N\nA3,0.1\n").find("more than one load and humidity:"),
            std::string::npos);
  // Neither of them is guessed for a load that was not planned.
  EXPECT_NE(refused("field,load_N,F_off_N\nA3,1,0.1\n").find("more than one humidity:"),
            std::string::npos);
  EXPECT_EQ(told("field,humidity_percent,F_off_N\nA3,15,0.1\n").experiment.at,
            (Conditions{0.2, 0.15}));
  EXPECT_EQ(told("field,load_N,F_off_N\nA3,0.5,0.1\n").experiment.at, (Conditions{0.5, 0.75}));
}

TEST_F(Tell, TakesFrictionUnderVoltageForTheOnlyDrivenConditionsOfAField) {
  lab_.fields = {field(0.2, 0.15), field(0.2, 0.15, 200)};
  EXPECT_EQ(told("field,F_on_N\nA3,0.1\n").experiment.at.voltage, 200);
  EXPECT_GT(told("field,F_off_N\nA3,0.1\n").off, 0);
  lab_.fields.push_back(field(0.2, 0.15, 100));
  EXPECT_NE(refused("field,F_on_N\nA3,0.1\n").find("more than one voltage:"), std::string::npos);
}

TEST_F(Tell, ReadsConditionsThatARecordHasNoColumnOfFromItsHead) {
  lab_.fields = {field(0.2, 0.15), field(0.2, 0.75)};
  TraceReading reading;
  reading.off = 0.1;
  reading.off_sd = 0.001;
  reading.load = 0.2;
  Trace trace;
  EXPECT_NE(
      keyed_refusal_of([&] { record(trace, reading, "A3-75.csv"); }).find("`# humidity: 75 %`"),
      std::string::npos);
  trace.said["humidity"] = "75 %";
  EXPECT_EQ(record(trace, reading, "A3_run1.csv").experiment.at, (Conditions{0.2, 0.75}));
  reading.relative_humidity = 0.15;  // a column says more than a line
  EXPECT_EQ(record(trace, reading, "A3_run1.csv").experiment.at, (Conditions{0.2, 0.15}));
  lab_.fields.clear();
  lab_.conditions.states = {"clean", "natural"};
  lab_.conditions.humidity = {0.15};
  lab_.conditions.frequency = {1000, 5000};
  reading.on = 0.14;
  reading.on_sd = 0.001;
  reading.voltage = 200;
  trace.said = {{"design", "deep"}};
  EXPECT_NE(keyed_refusal_of([&] {
              record(trace, reading, "a.csv");
            }).find("frequency: not said, and the lab has more than one"),
            std::string::npos);
  trace.said["state"] = "natural";
  trace.said["carrier"] = "5 kHz";
  trace.said["frequency"] = "1 kHz";  // of the samples
  EXPECT_EQ(record(trace, reading, "a.csv").experiment.at,
            (Conditions{0.2, 0.15, 200, 5000, FingerState::Natural}));
}

TEST_F(Tell, TakesTheFingerToBeInTheOnlyStateOfTheLab) {
  const std::string table = "design,F_off_N\ndeep,0.1\n";
  lab_.conditions.states = {"natural"};
  EXPECT_EQ(told(table).experiment.at.state, FingerState::Natural);
  EXPECT_EQ(told("design,state,F_off_N\ndeep,clean,0.1\n").experiment.at.state, FingerState::Clean);
  lab_.conditions.states = {"clean", "natural"};
  EXPECT_EQ(refused(table), "state: not said, and the lab has more than one\n");
}

}  // namespace
}  // namespace papilla::tests::matching_test
