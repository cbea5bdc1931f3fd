// Tables of measured friction, right and wrong.
#include "scene/measured_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/refusal.h"

namespace papilla::tests::measured_table_test {
namespace {

MeasuredTable table(const std::string& text) { return read_measured_table(text, "table.csv"); }
std::string refused(const std::string& text) {
  return refusal_of([&] { table(text); });
}
bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(MeasuredTable, ReadsThePlanFilledIn) {
  const MeasuredTable t = table(
      "experiment,field,design,repeat,load_N,humidity_percent,voltage_V,frequency_Hz,state,finger,"
      "day,F_off_N,F_off_sd_N,F_on_N,F_on_sd_N\n"
      "E01,A3,front/01,1,0.2,35,150,5000,natural,Ada,2026-03-02,0.081,0.004,0.142,0.006\n"
      "E02,,flat,1,0.2,75,0,,clean,,,,,,\n");
  ASSERT_EQ(t.rows.size(), 2u);
  const MeasuredRow& r = t.rows[0];
  EXPECT_EQ(r.experiment + r.field + r.design + r.finger + r.day, "E01A3front/01Ada2026-03-02");
  EXPECT_EQ(r.repeat, 1);
  EXPECT_DOUBLE_EQ(*r.relative_humidity, 0.35);
  EXPECT_DOUBLE_EQ(*r.off, 0.081);
  EXPECT_DOUBLE_EQ(*r.on_sd, 0.006);
  EXPECT_EQ(*r.state, FingerState::Natural);
  EXPECT_TRUE(r.measured());
  EXPECT_FALSE(t.rows[1].measured());
  EXPECT_TRUE(t.notes.empty());
}

TEST(MeasuredTable, ReadsTheColumnsOfCalibrateAndOtherUnits) {
  const MeasuredTable t = table(
      "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,F_on_sd_N"
      "\nflat.toml,35 %,200,5000,0.2,0.081,0.004,0.142,0.006\n");
  EXPECT_DOUBLE_EQ(*t.rows[0].relative_humidity, 0.35);
  EXPECT_DOUBLE_EQ(*t.rows[0].voltage, 200);
  const MeasuredTable m = table(
      "design;load [mN];humidity [%];voltage_kV;frequency_kHz;F_off [mN];photo\n"
      "flat;200;35;0.2;5;81;a.jpg\n");
  EXPECT_DOUBLE_EQ(*m.rows[0].load, 0.2);
  EXPECT_DOUBLE_EQ(*m.rows[0].voltage, 200);
  EXPECT_DOUBLE_EQ(*m.rows[0].frequency, 5000);
  EXPECT_DOUBLE_EQ(*m.rows[0].off, 0.081);
  EXPECT_EQ(*m.rows[0].relative_humidity, 0.35);  // to the last bit: not 35 times 0.01
  ASSERT_EQ(m.notes.size(), 1u);
  EXPECT_EQ(m.notes[0], "columns that are not read: photo");
}

// Its unit in the head is the column's; without one its cells say theirs.
TEST(MeasuredTable, ReadsRelativeHumidityInTheUnitOfItsHead) {
  const auto of_head = [](const std::string& head, const std::string& cell) {
    return "design," + head + ",load_N,F_off_N\nflat," + cell + ",0.2,0.1\n";
  };
  for (const char* head : {"humidity_percent", "relative_humidity_percent", "relative_humidity [%]",
                           "relative_humidity (percent)"}) {
    const MeasuredTable t = table(of_head(head, "35"));
    EXPECT_DOUBLE_EQ(*t.rows[0].relative_humidity, 0.35) << head;
    EXPECT_TRUE(t.has("humidity")) << head;
    EXPECT_TRUE(says(refused(of_head(head, "0.9")), "is it a share? Then 90 % is meant")) << head;
    EXPECT_TRUE(says(refused(of_head(head, "101")), "lies outside")) << head;
  }
  for (const char* cell : {"0.35", "35 %"})
    EXPECT_DOUBLE_EQ(*table(of_head("relative_humidity", cell)).rows[0].relative_humidity, 0.35);
  EXPECT_TRUE(
      says(refused(of_head("relative_humidity_mN", "35")),
           "\"mN\" is no unit of a plain number or a percentage; write relative_humidity_percent"));
  EXPECT_TRUE(says(refused(of_head("humidity_percent,relative_humidity_percent", "35,35")),
                   "a second column of the same quantity"));
}

TEST(MeasuredTable, RefusesWrongUnitsWithTheWayOut) {
  const std::string head = "design,load_N,humidity_percent,voltage_V,F_off_N,F_on_N\n";
  EXPECT_TRUE(says(refused("design,load,humidity_percent,F_off_N\nflat,0.2,35,0.1\n"),
                   "load: a column without a unit: write load_N"));
  EXPECT_TRUE(says(refused("design,load_V,humidity_percent,F_off_N\nflat,0.2,35,0.1\n"),
                   "\"V\" is no unit of a force; write load_N"));
  EXPECT_TRUE(says(refused(head + "flat,0.2,35,200,81,142\n"), "are these mN?"));
  EXPECT_TRUE(says(refused(head + "flat,0.2,0.35,200,.081,.142\n"), "is it a share? Then 35 %"));
  EXPECT_TRUE(says(refused(head + "flat,200,35,200,.081,.142\n"), "lies outside"));
  EXPECT_TRUE(says(refused(head + "flat,0.2,35,200,.142,.081\n"), "exchanged?"));
  EXPECT_TRUE(says(refused(head + "flat,0.2,35,0,.142,.181\n"), "but the voltage is 0"));
  EXPECT_TRUE(says(refused("design,load_N,humidity_percent,F_of_N\nflat,0.2,35,0.1\n"),
                   "is it `F_off_N`?"));
}

// A bound in another unit than the cell's would say that 150 lies outside 0 to 1 %.
TEST(MeasuredTable, SaysBoundsInTheUnitOfTheColumn) {
  for (const auto& [head, cell, bounds] :
       {std::tuple{"humidity_percent", "150", "150 lies outside 0 to 100 %"},
        {"relative_humidity", "1.5", "1.5 lies outside 0 to 1 "},
        {"load_mN", "2000000", "2000000 lies outside 0.001 to 100000 mN"},
        {"voltage_kV", "200", "200 lies outside 0 to 100 kV"},
        {"voltage_V", "200000", "200000 lies outside 0 to 100000 V"}})
    EXPECT_TRUE(says(refused(fmt::format("design,{},F_off_N\nflat,{},0.1\n", head, cell)), bounds))
        << head;
}

// Touches scatter by percent, whatever each states of itself.
TEST(MeasuredTable, TakesForExchangedOnlyWhatScatterCannotExplain) {
  const std::string head = "design,load_N,humidity_percent,voltage_V,F_off_N,F_off_sd_N,F_on_N\n",
                    touch = "flat,0.2,35,20,0.1,0.0005,0.099\n",
                    less = "flat,0.2,35,200,0.1,0.005,0.08\n";
  const MeasuredTable t = table(head + touch);
  ASSERT_EQ(t.notes.size(), 1u);
  EXPECT_TRUE(says(t.notes[0], "by no more than touches scatter"));
  // A fifth less is 3.1 deviations of one touch; half of that needs four.
  EXPECT_TRUE(says(refused(head + less), "exchanged?"));
  const std::string half = "flat,0.2,35,200,0.1,0.005,0.089\n";
  EXPECT_EQ(table(head + half).rows.size(), 1u);
  EXPECT_TRUE(says(refused(head + half + half + half + half), "exchanged?"));
  // What is stated to scatter more is believed.
  EXPECT_EQ(table(head + "flat,0.2,35,200,0.1,0.02,0.08\n").rows.size(), 1u);
  EXPECT_TRUE(table(head + touch + "flat,0.2,35,200,0.1,0.005,0.12\n").notes.empty());
}

// One number that is ten times too large is no exchange of columns.
TEST(MeasuredTable, NamesTheRowWhoseFrictionIsOffAmongOthers) {
  const std::string head = "design,load_N,humidity_percent,voltage_V,F_off_N,F_on_N\n",
                    row = "flat,0.2,35,200,0.1,0.16\n", off = "flat,0.2,35,200,1.0,0.16\n";
  const auto problems = refused(head + row + off + "flat,0.2,35,200,0.1,0.099\n" + row + row);
  EXPECT_TRUE(says(problems,
                   "F_off: 1 N is 6.25 times the F_on of the same line, where other rows "
                   "have 0.625: one of the two is off by a factor of 10"));
  EXPECT_TRUE(says(problems, ":3:"));
  EXPECT_FALSE(says(problems, "exchanged?"));
  EXPECT_FALSE(says(problems, ":4:"));  // within what touches scatter
  EXPECT_TRUE(says(refused(head + row + off + off), "exchanged?"));
}

TEST(MeasuredTable, RefusesEveryMistakeAtOnceWithItsLine) {
  const std::string all = refused(
      "design,load_N,humidity_percent,state,F_off_N\n"
      "flat,x,35,clean,0.1\nflat,0.2,35,dirty,0.1\nflat,0.2,35\n");
  EXPECT_TRUE(says(all, "table.csv:2:2: load: expected a number, got \"x\""));
  EXPECT_TRUE(says(all, "table.csv:3:4: state: \"dirty\" is no state"));
  EXPECT_TRUE(says(all, "table.csv:4:0: expected 5 cells, got 3"));
  EXPECT_TRUE(says(refused("design,load_N,F_off_N\nflat,0.2,0.1\nflat,0."), "the file is cut off"));
  EXPECT_TRUE(says(refused(""), "no header line"));
  EXPECT_TRUE(says(refused("design,F_off_N\n"), "no rows below the header"));
}

TEST(MeasuredTable, RefusesTwoColumnsOfTheHumidity) {
  EXPECT_TRUE(says(refused("design,humidity_percent,relative_humidity,load_N,F_off_N\n"
                           "flat,35,0.75,0.2,0.1\n"),
                   "relative_humidity: a second column of the humidity"));
}

TEST(MeasuredTable, RefusesARepeatThatIsNoWholeNumber) {
  const std::string head = "design,repeat,load_N,F_off_N\n";
  EXPECT_TRUE(says(refused(head + "flat,1.9,0.2,0.1\n"),
                   "table.csv:2:2: repeat: expected a whole number, got \"1.9\""));
  EXPECT_EQ(table(head + "flat,2,0.2,0.1\n").rows.front().repeat, 2);
}

// Nothing but a constant voltage has a frequency of 0.
TEST(MeasuredTable, AFrequencyOfNothingIsThatOfAConstantVoltage) {
  Drive drive;
  drive.frequency = 5e3;
  EXPECT_EQ(frequency_problem(drive, 5e3), "");
  EXPECT_EQ(frequency_problem(drive, 1), "");
  EXPECT_EQ(
      frequency_problem(drive, 0),
      "0 Hz is a constant voltage, and the design is driven at 5000 Hz: give the frequency of "
      "the drive, or set drive.waveform = \"dc\" in the design");
  drive.frequency = 0;
  EXPECT_EQ(frequency_problem(drive, 0), "");
  drive = {};
  drive.waveform = Waveform::Dc;
  EXPECT_EQ(frequency_problem(drive, 0), "");
}

TEST(MeasuredTable, AsksWhetherAFileWithoutItsLastLineEndIsWhole) {
  const MeasuredTable t = table("design,load_N,F_off_N\nflat,0.2,0.1\nflat,0.2,0.1");
  ASSERT_EQ(t.notes.size(), 1u);
  EXPECT_TRUE(says(t.notes[0], "is the file whole?"));
}

}  // namespace
}  // namespace papilla::tests::measured_table_test
