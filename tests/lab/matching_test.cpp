// Which experiment a row or a record is of, and that none is guessed.
#include "lab/matching.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <tuple>

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

  Matched matched(const std::string& text) const {
    const MatchContext to{lab_, designs_, planned_};
    return match_table(read_measured_table(text, "table.csv"), to, {}, "table.csv");
  }
  FrictionReading told(const std::string& text) const { return matched(text).readings.front(); }
  FrictionReading record(Trace trace, TraceReading reading, const std::string& name) const {
    const MatchContext to{lab_, designs_, planned_};
    return match_trace(trace, reading, to, {}, name).readings.front();
  }
  // Of a record with such a head, "E01.csv"; "" where it is taken.
  std::string refused_head(const std::map<std::string, std::string>& head) const {
    TraceReading reading;
    reading.off = 0.1;
    reading.off_sd = 0.001;
    reading.load = 0.2;
    Trace trace;
    trace.said = head;
    return keyed_refusal_of([&] { record(trace, reading, "E01.csv"); });
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

TEST_F(Tell, RefusesConditionsInTheHeadOfARecordThatItCannotRead) {
  const std::map<std::string, std::string> good{{"design", "deep"}};
  EXPECT_EQ(refused_head(good), "");
  for (const auto& [key, value, expected] :
       {std::tuple("humidity", "75", "0 to 100 %, as \"75 %\""),
        std::tuple("humidity", "750 %", "0 to 100 %, as \"75 %\""),
        std::tuple("state", "Wet", "clean, natural, wet"),
        std::tuple("carrier", "50000", "a frequency, as \"5 kHz\""),
        std::tuple("carrier", "5 V", "a frequency, as \"5 kHz\""),
        std::tuple("repeat", "two", "a whole number from 1 on"),
        std::tuple("repeat", "1.9", "a whole number from 1 on")}) {
    std::map<std::string, std::string> head = good;
    head[key] = value;
    EXPECT_EQ(refused_head(head), std::string(key) + ": \"" + value +
                                      "\" in the head of the record: expected " + expected + "\n");
  }
  // All at once; a line that is left empty says nothing.
  EXPECT_EQ(refused_head({{"design", "deep"}, {"humidity", "75"}, {"state", "Wet"}}).substr(0, 14),
            "humidity: \"75\"");
  EXPECT_NE(refused_head({{"humidity", "75"}, {"state", "Wet"}}).find("\nstate: \"Wet\""),
            std::string::npos);
  EXPECT_EQ(refused_head({{"design", "deep"}, {"humidity", ""}}), "");
}

TEST_F(Tell, RefusesADesignThatIsNotThatOfItsExperimentOrField) {
  designs_.push_back({"flat", Design(), true});
  designs_.push_back({"a,b", Design(), true});
  lab_.fields = {field(0.2, 0.35)};
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.2, 0.35}};
  planned_ = {planned};
  EXPECT_EQ(told("experiment,design,F_off_N\nE01,deep,0.1\n").experiment.design, 0u);
  EXPECT_EQ(refused("experiment,design,F_off_N\nE01,flat,0.1\n"),
            "design: E01 is of deep, not flat\n");
  EXPECT_EQ(refused("field,design,F_off_N\nA3,flat,0.1\n"), "design: A3 is of deep, not flat\n");
  EXPECT_NE(refused("experiment,design,F_off_N\nE01,nonsense,0.1\n").find("no design \"nonsense\""),
            std::string::npos);
  EXPECT_EQ(refused_head({{"design", "flat"}}), "design: E01 is of deep, not flat\n");
  // A manifest names files, and a lab may know such a design by the name that a run gave it.
  EXPECT_EQ(told("field,design,F_off_N\nA3,designs/front_01.toml,0.1\n").experiment.design, 0u);
  // A plan has no comma in a cell.
  planned_.front().experiment.design = 2;
  EXPECT_EQ(told("experiment,design,F_off_N\nE01,a;b,0.1\n").experiment.design, 2u);
}

// A lab of an older program may hold two wafers whose labels are alike.
TEST_F(Tell, RefusesALabelOfTwoFieldsWithDifferentDesigns) {
  designs_.push_back({"flat", Design(), true});
  lab_.fields = {field(0.2, 0.35), field(0.2, 0.35)};
  EXPECT_EQ(told("field,F_off_N\nA3,0.1\n").experiment.design, 0u);
  lab_.fields.back().design = "flat";
  EXPECT_EQ(refused("field,F_off_N\nA3,0.1\n"),
            "field: A3 is a label of two fields of lab.toml, with deep and flat: tell it by its "
            "experiment, or by its design and conditions\n");
  EXPECT_EQ(told("design,F_off_N\nflat,0.1\n").experiment.design, 1u);
}

TEST_F(Tell, RefusesOptionsThatContradictTheExperiment) {
  designs_.push_back({"flat", Design(), true});
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.2, 0.35}};
  planned_ = {planned};
  const auto refused_with = [&](const TellOptions& options) {
    const MatchContext to{lab_, designs_, planned_};
    const MeasuredTable table = read_measured_table("experiment,F_off_N\nE01,0.1\n", "a.csv");
    return keyed_refusal_of([&] { match_table(table, to, options, "a.csv"); });
  };
  TellOptions options;
  options.design = "deep";
  EXPECT_EQ(refused_with(options), "");
  options.design = "flat";
  EXPECT_EQ(refused_with(options), "design: E01 is of deep, not flat\n");
  options.design = "";
  options.field = "Z9";
  EXPECT_EQ(refused_with(options), "field: E01 stands in no field, not in Z9\n");
  // In a table the column of a plan without fields is the user's.
  EXPECT_EQ(told("experiment,field,F_off_N\nE01,left,0.1\n").id, "E01");
}

// A plan that knows no other frequency than the design's own says 0 for it.
TEST_F(Tell, TakesAnotherFrequencyForAnotherExperimentAndSaysSo) {
  const Conditions planned{0.2, 0.35, 200, 0};
  const double own = designs_.front().design.drive.frequency;
  ASSERT_GT(own, 100);
  PlannedExperiment e;
  e.id = "E01";
  e.experiment = {0, planned};
  planned_ = {e};
  lab_.fields = {field(0.2, 0.35, 200)};
  for (const std::string name : {"experiment", "field", "design"}) {
    const std::string id = name == "experiment" ? "E01" : name == "field" ? "A3" : "deep";
    const auto at = [&](double frequency) {
      return matched(fmt::format("{},frequency_Hz,F_on_N\n{},{},0.1\n", name, id, frequency));
    };
    EXPECT_EQ(at(own).readings.front().experiment.at, planned) << name;
    EXPECT_TRUE(at(own).notes.empty()) << name;
    EXPECT_EQ(at(1.01 * own).readings.front().experiment.at, planned) << name;
    const Matched other = at(own / 5);
    EXPECT_EQ(other.readings.front().experiment.at, (Conditions{0.2, 0.35, 200, own / 5})) << name;
    if (name == "design") continue;  // nothing was planned of it
    ASSERT_EQ(at(1.01 * own).notes.size(), 1u);
    EXPECT_NE(at(1.01 * own).notes.front().find("2 % of frequency"), std::string::npos);
    ASSERT_EQ(other.notes.size(), 1u);
    EXPECT_EQ(other.notes.front(),
              fmt::format("measured otherwise than planned, and taken as measured: {} at 35 % RH, "
                          "0.2 N, 200 V at {} Hz, clean",
                          id, own / 5));
  }
  // A row that is not measured yet has nothing to say.
  EXPECT_TRUE(matched("experiment,frequency_Hz,F_on_N\nE01,77,\n").notes.empty());
}

// A lab that sets the design's own frequency by 0, beside another.
TEST_F(Tell, TakesTheDesignsOwnFrequencyForTheZeroOfItsLab) {
  lab_.conditions.frequency = {1000, 0};
  const double own = designs_.front().design.drive.frequency;
  for (const double is : {own, 1.01 * own}) {
    EXPECT_EQ(told(fmt::format("design,frequency_Hz,F_on_N\ndeep,{},0.1\n", is)).experiment.at,
              (Conditions{0.2, 0.35, 200, 0}));
  }
  EXPECT_EQ(told("design,frequency_Hz,F_on_N\ndeep,1010,0.1\n").experiment.at.frequency, 1000);
  // Without a voltage there is no frequency, as of what is planned.
  lab_.conditions.frequency = {own};
  EXPECT_EQ(told("design,voltage_V,F_off_N\ndeep,0,0.1\n").experiment.at,
            (Conditions{0.2, 0.35, 0, 0}));
}

// Conditions say the design's own frequency by 0; a row says a constant voltage by it.
TEST_F(Tell, RefusesAConstantVoltageOfADesignThatIsDrivenByAWave) {
  lab_.fields = {field(0.2, 0.35, 200)};
  for (const std::string table :
       {"field,frequency_Hz,F_on_N\nA3,0,0.1\n",
        "design,load_N,humidity_percent,voltage_V,frequency_Hz,F_on_N\ndeep,0.3,35,200,0,0.1\n"}) {
    EXPECT_TRUE(refused(table).starts_with("frequency: 0 Hz is a constant voltage")) << table;
  }
  EXPECT_GT(told("field,frequency_Hz,F_off_N\nA3,0,0.1\n").off, 0);  // of no voltage
  designs_.front().design.drive.waveform = Waveform::Dc;
  EXPECT_EQ(told("field,frequency_Hz,F_on_N\nA3,0,0.1\n").experiment.at,
            (Conditions{0.2, 0.35, 200, 0}));
}

// Both loads are within a tenth of .22 N.
TEST_F(Tell, TakesAReadingForTheNearestOfItsConditions) {
  lab_.conditions.load = {0.2, 0.22};
  EXPECT_EQ(told("design,load_N,F_off_N\ndeep,0.22,0.1\n").experiment.at.load, 0.22);
  EXPECT_EQ(told("design,load_N,F_off_N\ndeep,0.212,0.1\n").experiment.at.load, 0.22);
  EXPECT_EQ(told("design,load_N,F_off_N\ndeep,0.208,0.1\n").experiment.at.load, 0.2);
  lab_.fields = {field(0.2, 0.35), field(0.22, 0.35)};
  EXPECT_EQ(told("field,load_N,F_off_N\nA3,0.22,0.1\n").experiment.at.load, 0.22);
  EXPECT_EQ(told("field,load_N,F_off_N\nA3,0.2,0.1\n").experiment.at.load, 0.2);
}

// As they were measured, before they are rounded: 0.012 N is no 0.01 N, 13.6 % no 14 %.
TEST_F(Tell, TakesARecordAsPlannedWhereItIsNear) {
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.012, 0.124, 12.5}};
  planned_ = {planned};
  TraceReading reading;
  reading.off = 0.003;
  reading.on = 0.004;
  reading.off_sd = reading.on_sd = 1e-5;
  reading.load = 0.012;
  reading.relative_humidity = 0.136;
  reading.voltage = 12.4;
  const FrictionReading near = record({}, reading, "E01.csv");
  EXPECT_EQ(near.experiment.at, planned.experiment.at);
  EXPECT_EQ(near.off, 0.003);
  // Of none that was planned, by round numbers; a small load is not rounded away.
  reading.load = 0.0204;
  reading.relative_humidity = 0.433;
  reading.voltage = 151.3;
  const Conditions own = record({}, reading, "E01.csv").experiment.at;
  EXPECT_DOUBLE_EQ(own.load, 0.020);
  EXPECT_DOUBLE_EQ(own.relative_humidity, 0.43);
  EXPECT_DOUBLE_EQ(own.voltage, 151);
  reading.load = 0.00204;
  EXPECT_DOUBLE_EQ(record({}, reading, "E01.csv").experiment.at.load, 0.0020);
  // What it does not measure is as it was planned, to the last bit.
  reading.relative_humidity.reset();
  reading.on_sd = 0;
  const Conditions meant = record({}, reading, "E01.csv").experiment.at;
  EXPECT_EQ(meant.relative_humidity, 0.124);
  EXPECT_EQ(meant.voltage, 12.5);
}

// 0.01 times 35 is no 0.35: it is what was planned all the same.
TEST_F(Tell, SaysNothingOfARecordUnderWhatWasPlanned) {
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.2, 0.35}};
  planned_ = {planned};
  TraceReading reading;
  reading.off = 0.1;
  reading.off_sd = 0.001;
  reading.load = 0.2;
  const MatchContext to{lab_, designs_, planned_};
  const auto notes = [&] { return match_trace({}, reading, to, {}, "E01.csv").notes.size(); };
  EXPECT_EQ(notes(), 0u);
  reading.relative_humidity = 0.35;
  EXPECT_EQ(notes(), 0u);
  reading.relative_humidity = 0.36;
  EXPECT_EQ(notes(), 1u);
}

TEST_F(Tell, RefusesOfARecordWhatItRefusesOfATable) {
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.2, 0.35, 200}};
  planned_ = {planned};
  TraceReading good;
  good.off = 0.1;
  good.on = 0.12;
  good.off_sd = good.on_sd = 0.001;
  good.load = 0.2;
  good.voltage = 200;
  const auto refused_with = [&](const std::function<void(TraceReading&)>& change) {
    TraceReading reading = good;
    change(reading);
    return keyed_refusal_of([&] { record({}, reading, "E01.csv"); });
  };
  EXPECT_EQ(refused_with([](TraceReading&) {}), "");
  EXPECT_EQ(refused_with([](TraceReading& r) { r.relative_humidity = 0.0035; }),
            "humidity: 0.35 %: is it a share? Then 35 % is meant\n");
  EXPECT_EQ(refused_with([](TraceReading& r) { r.relative_humidity = 1.2; }),
            "humidity: 120 % lies outside 0 to 100 %\n");
  EXPECT_NE(refused_with([](TraceReading& r) { r.off = 90, r.on = 120; }).find("are these mN?"),
            std::string::npos);
  EXPECT_EQ(
      refused_with([](TraceReading& r) { r.load = 200; }),
      "normal: the finger pressed with 200 N, outside 1e-06 to 100 N: is the force in another "
      "unit?\n");
  EXPECT_NE(refused_with([](TraceReading& r) {
              r.on = 0.07;
            }).find("voltage: under voltage the finger rubs with 70 mN, without it with 100 mN"),
            std::string::npos);
  EXPECT_EQ(refused_with([](TraceReading& r) { r.on = 0.095; }), "");  // as touches scatter
}

TEST_F(Tell, RefusesAnOptionThatNamesAnotherExperimentThanTheRecord) {
  PlannedExperiment planned;
  planned.id = "E01";
  planned.experiment = {0, {0.2, 0.35}};
  planned_ = {planned, planned};
  planned_.back().id = "E02";
  TraceReading reading;
  reading.off = 0.1;
  reading.off_sd = 0.001;
  reading.load = 0.2;
  const auto refused_by = [&](const std::string& experiment) {
    TellOptions options;
    options.experiment = experiment;
    const MatchContext to{lab_, designs_, planned_};
    return keyed_refusal_of([&] { match_trace({}, reading, to, options, "E01_run1.csv"); });
  };
  EXPECT_EQ(refused_by("E01"), "");
  EXPECT_EQ(refused_by("E02"),
            "experiment: E01 by the record's head or name, E02 by --experiment: leave the option "
            "out, or correct the record\n");
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
