// Tables of friction and files of fits as wholes: what is read, what lies at a border, and every
// refusal in its words.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "design/design.h"
#include "tests/calibrate/files.h"
#include "tests/support/refusal.h"

namespace papilla::tests::tables_and_files_test {
namespace {

using TablesAndFiles = Calibrate;

// "line:column: key: message" of every problem.
std::string refusal(const std::function<void()>& work) {
  std::string out;
  for (const Problem& p : problems_of(work))
    out += fmt::format("{}:{}: {}: {}\n", p.line, p.column, p.key, p.message);
  return out;
}

TEST_F(TablesAndFiles, ARowIsReadByItsColumnsInAnyOrder) {
  const FrictionTable table = read_friction(
      write("a.csv",
            "\xEF\xBB\xBF# by hand\n\n"
            "load_N,F_on_sd_N,design,F_on_N,F_off_sd_N,relative_humidity,F_off_N,amplitude_V,"
            "frequency_Hz\r\n"
            "0.3,0.02,m3_samples/flat.toml,0.25,0.01,45 %,0.125,150,2000\r\n"
            ",,,,,,,,\n"
            "0.4,,m3_samples/flat.toml,,0.03,0.5,0.2,0,\n"));
  const std::vector<FrictionDatum>& rows = table.rows;
  EXPECT_TRUE(table.notes.empty());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].design, find_design("m3_samples/flat.toml"));
  EXPECT_EQ(rows[0].relative_humidity, 0.45);
  EXPECT_EQ(rows[0].amplitude, 150);
  EXPECT_EQ(rows[0].frequency, 2000);
  EXPECT_EQ(rows[0].load, 0.3);
  EXPECT_EQ(rows[0].off, 0.125);
  EXPECT_EQ(rows[0].off_sd, 0.01);
  EXPECT_EQ(rows[0].on, 0.25);
  EXPECT_EQ(rows[0].on_sd, 0.02);
  EXPECT_EQ(rows[0].line, 4);
  EXPECT_EQ(rows[1].relative_humidity, 0.5);
  EXPECT_EQ(rows[1].amplitude, 0);
  EXPECT_EQ(rows[1].frequency, 0);
  EXPECT_EQ(rows[1].on, 0);
  EXPECT_EQ(rows[1].on_sd, 0);
  EXPECT_EQ(rows[1].line, 6);
}

// A table that a lab reads is one that a fit reads: units in the header, days and repeats beside.
TEST_F(TablesAndFiles, UnitsStandInTheHeaderAndOtherColumnsAreNamed) {
  const FrictionTable table = read_friction(
      write("u.csv",
            "design;load [mN];humidity_percent;repeat;day;F_off_mN;F_off_sd_mN;F_on_mN;F_on_sd_mN;"
            "voltage_V;frequency_kHz;photo\n"
            "m3_samples/flat.toml;200;35;1;2026-03-02;81;4;142;6;200;5;a.jpg\n"
            "m3_samples/flat.toml;200;75;1;2026-03-02;;;;;200;5;\n"));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_DOUBLE_EQ(table.rows[0].load, 0.2);
  EXPECT_DOUBLE_EQ(table.rows[0].relative_humidity, 0.35);
  EXPECT_DOUBLE_EQ(table.rows[0].off, 0.081);
  EXPECT_DOUBLE_EQ(table.rows[0].on_sd, 0.006);
  EXPECT_DOUBLE_EQ(table.rows[0].frequency, 5000);
  EXPECT_EQ(table.notes, (std::vector<std::string>{"columns that are not read: photo",
                                                   "1 row without a friction are left out"}));
}

// humidity, amplitude, frequency, load, off, its deviation, on, its deviation.
TEST_F(TablesAndFiles, NumbersLieInTheirRanges) {
  const auto told = [&](const std::string& cells) {
    return refusal([&] {
      read_friction(write("r.csv", std::string(kHeader) + "m3_samples/flat.toml," + cells + "\n"));
    });
  };
  EXPECT_EQ(told("0,0,0,0.2,0.1,1e-9,,"), "");
  EXPECT_EQ(told("100 %,1e5,1e9,100,1000,1000,1000,1000"), "");
  EXPECT_EQ(told("0.5,1,1,1e-6,1e-9,1e-9,1e-9,1e-9"), "");
  EXPECT_EQ(told("1.01,0,0,0.2,0.1,1,,"), "2:2: relative_humidity: 1.01 lies outside 0 to 1 \n");
  EXPECT_EQ(told("30,0,0,0.2,0.1,1,,"),
            "2:2: relative_humidity: 30 lies outside 0 to 1: write it as \"30 %\"\n");
  EXPECT_EQ(told("130 %,0,0,0.2,0.1,1,,"),
            "2:2: relative_humidity: 130 % lies outside 0 to 100 %\n");
  EXPECT_EQ(told("-0.1,0,0,0.2,0.1,1,,"), "2:2: relative_humidity: -0.1 lies outside 0 to 1 \n");
  EXPECT_EQ(told("0.5,-1,5,0.2,0.1,1,,"), "2:3: voltage: -1 lies outside 0 to 100000 V\n");
  EXPECT_EQ(told("0.5,1,2e9,0.2,0.1,1,,"), "2:4: frequency: 2e9 lies outside 0 to 1000000000 Hz\n");
  EXPECT_EQ(told("0.5,1,,0.2,0.1,1,,"), "2:0: frequency: expected a number, got \"\"\n");
  EXPECT_EQ(told("0.5,1,5,1e-7,0,1,,"),
            "2:5: load: 1e-7 lies outside 1e-06 to 100 N\n"
            "2:6: F_off: 0 lies outside 1e-09 to 1000 N\n");
  EXPECT_EQ(told("0.5,1,5,101,0.1,1,,"), "2:5: load: 101 lies outside 1e-06 to 100 N\n");
  EXPECT_EQ(told("0.5,1,5,,0.1,1,,"), "2:0: load: expected a number, got \"\"\n");
  EXPECT_EQ(told("0.5,1,5,0.2,0.1,,,"), "2:0: F_off_sd: expected a number, got \"\"\n");
  EXPECT_EQ(told("0.5,1,5,0.2,1,1,1,"), "2:0: F_on_sd: expected a number, got \"\"\n");
  EXPECT_EQ(told("0.5,1,5,0.2,,,1,1"), "");
  EXPECT_EQ(told("0.5,0,0,0.2,1,1,1,1"),
            "2:0: F_on: a friction under voltage, but the voltage is 0\n");
  EXPECT_EQ(told("half,1,5,0.2,1 N,1,1,1"),
            "2:2: relative_humidity: expected a number, got \"half\"\n"
            "2:6: F_off: expected a number, got \"1 N\"\n");
  // Ten times the load is the most; of more than fifty times it is another unit.
  EXPECT_EQ(told("0.5,1,5,0.2,2,1,2,1"), "");
  EXPECT_EQ(told("0.5,1,5,0.2,2.1,1,10.2,1"),
            "2:0: F_off: 2.1 N is 10.5 times the load of 0.2 N; no finger rubs so\n"
            "2:0: F_on: 10.2 N is 51 times the load of 0.2 N: are these mN? Then 0.0102 N is "
            "meant\n");
  EXPECT_EQ(told("0.5,1,5,0.2,1"), "2:0: : expected 9 cells, got 6\n");
  EXPECT_EQ(told("0.5,0,0,0.2,,,,"), "1:0: F_off: no row has a friction\n");
}

TEST_F(TablesAndFiles, ATableIsOfOneFinger) {
  const std::string head = "design,load_N,humidity_percent,F_off_N,F_off_sd_N,finger,state\n",
                    row = "m3_samples/flat.toml,0.2,35,0.1,0.01,";
  const auto told = [&](const std::string& rows) {
    return refusal([&] { read_friction(write("f.csv", head + rows)); });
  };
  EXPECT_EQ(told(row + "Ada,clean\n" + row + "Ada,clean\n"), "");
  EXPECT_EQ(told(row + "Ada,clean\n" + row + "Ben,natural\n"),
            "3:0: finger: \"Ben\", and \"Ada\" in line 2: a fit is of one finger, so say which one "
            "by data_finger in the calibration\n");
}

// The readings of a lab with several fingers are one table, of which a calibration takes one.
TEST_F(TablesAndFiles, ACalibrationTakesTheRowsOfItsFinger) {
  const std::string row = "m3_samples/flat.toml,0.2,35,";
  write("f.csv", "design,load_N,humidity_percent,F_off_N,F_off_sd_N,finger\n" + row +
                     "0.1,0.01,Ada\n" + row + "0.2,0.01,Ben\n" + row + "0.11,0.01,Ada\n");
  const auto of = [&](const std::string& finger) {
    return read(write(
        "f.toml", "schema_version = 1\nfinger = \"fingers/reference.toml\"\ndata = \"f.csv\"\n" +
                      finger + "[parameters]\n\"skin.softening\" = { low = 1.2, high = 4.0 }\n"));
  };
  const Calibration ben = of("data_finger = \"Ben\"\n");
  ASSERT_EQ(ben.data.size(), 1u);
  EXPECT_EQ(ben.data.front().off, 0.2);
  EXPECT_EQ(ben.data_notes,
            std::vector<std::string>{"2 rows of other fingers (\"Ada\") are left out"});
  EXPECT_EQ(of("data_finger = \"Ada\"\n").data.size(), 2u);
  EXPECT_EQ(refusal([&] { of("data_finger = \"Cleo\"\n"); }),
            "1:0: finger: no row with a friction is of \"Cleo\" (data_finger); there are \"Ada\", "
            "\"Ben\"\n");
}

// "" in data_finger is no finger.
TEST_F(TablesAndFiles, AFingerIsNamedOfATableThatSaysFingers) {
  const auto told = [&](const std::string& keys) {
    return refusal([&] {
      read(write("n.toml", "schema_version = 1\nfinger = \"fingers/reference.toml\"\n" + keys +
                               "[parameters]\n\"skin.softening\" = { low = 1.2, high = 4.0 }\n"));
    });
  };
  write(
      "n.csv",
      "design,load_N,humidity_percent,F_off_N,F_off_sd_N\nm3_samples/flat.toml,0.2,35,0.1,0.01\n");
  const std::string data = "data = \"n.csv\"\n", ada = "data_finger = \"Ada\"\n";
  EXPECT_EQ(told(data), "");
  EXPECT_EQ(told(data + ada),
            "1:0: finger: no such column: write whose finger each row is of, or leave data_finger "
            "out\n");
  const std::string alone = told("fit = [\"M1\"]\n" + ada);
  EXPECT_NE(alone.find("data_finger: says whose rows of a table are taken, but no table is named"),
            std::string::npos)
      << alone;
}

// Ben's touches were driven, Ada's were not: a fit to hers needs nothing that only his have.
TEST_F(TablesAndFiles, RowsOfOtherFingersNeedNoColumns) {
  const std::string row = "m3_samples/flat.toml,0.2,35,";
  const std::string file =
      write("o.csv", "design,load_N,humidity_percent,voltage_V,F_off_N,F_off_sd_N,F_on_N,finger\n" +
                         row + "0,0.1,0.01,,Ada\n" + row + "200,0.1,0.01,0.2,Ben\n");
  EXPECT_EQ(read_friction(file, "Ada").rows.size(), 1u);
  EXPECT_EQ(refusal([&] { read_friction(file, "Ben"); }),
            "1:0: F_on_sd: no such column: write F_on_sd_N, one standard deviation of the value\n"
            "1:0: frequency: no such column: write frequency_Hz\n");
}

TEST_F(TablesAndFiles, ARowSaysItsStateOrHasThatOfItsDesign) {
  const std::string row = "m3_samples/flat.toml,0.2,35,200,5000,";
  const std::vector<FrictionDatum> rows =
      read_friction(
          write("s.csv",
                "design,load_N,humidity_percent,voltage_V,frequency_Hz,F_off_N,F_off_sd_N,"
                "F_on_N,F_on_sd_N,state\n" +
                    row + "0.1,0.01,,,\n" + row + ",,0.2,0.02,natural\n"))
          .rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].state, std::nullopt);
  EXPECT_EQ(rows[1].state, FingerState::Natural);
  EXPECT_EQ(rows[1].off_sd, 0);
  EXPECT_EQ(rows[1].on, 0.2);
}

TEST_F(TablesAndFiles, AFileWithoutAHeadOrRowsIsRefused) {
  const auto told = [&](const std::string& text) {
    return refusal([&] { read_friction(write("t.csv", text)); });
  };
  EXPECT_EQ(told(""), "0:0: : no header line\n");
  EXPECT_EQ(told("# nothing\n\n"), "2:0: : no header line\n");
  EXPECT_EQ(told(kHeader), "1:0: : no rows below the header\n");
}

// However many rows there are, what no row has is said once.
TEST_F(TablesAndFiles, MissingColumnsAreSaidOnceWithWhatStandsThere) {
  EXPECT_EQ(refusal([&] {
              read_friction(write("p.csv",
                                  "plate,load_N,humidity_percent,F_off_N,F_off_sd_N,F_on_N\n"
                                  "A,0.2,35,0.1,0.01,0.2\nB,0.2,35,0.1,0.01,0.2\n"));
            }),
            "1:0: design: no such column: the file of the surface, beside the table or a shipped "
            "one; columns that are not read: plate\n"
            "1:0: F_on_sd: no such column: write F_on_sd_N, one standard deviation of the value; "
            "columns that are not read: plate\n"
            "1:0: voltage: no such column: write voltage_V, the amplitude; columns that are not "
            "read: plate\n"
            "1:0: frequency: no such column: write frequency_Hz; columns that are not read: "
            "plate\n");
}

// Under a voltage a frequency is needed, of a friction without it too.
TEST_F(TablesAndFiles, AMissingFrequencyIsSaidOnceOfADrivenTable) {
  const std::string head = "design,load_N,humidity_percent,voltage_V,F_off_N,F_off_sd_N\n";
  const auto told = [&](const std::string& volts) {
    const std::string row = "m3_samples/flat.toml,0.2,35," + volts + ",0.1,0.01\n";
    return refusal([&] { read_friction(write("q.csv", head + row + row)); });
  };
  EXPECT_EQ(told("200"), "1:0: frequency: no such column: write frequency_Hz\n");
  EXPECT_EQ(told("0"), "");
}

// Forces in N with deviations in mN: what most rows say so large is another unit; one row is not.
TEST_F(TablesAndFiles, StandardDeviationsOfAnotherUnitAreAskedAbout) {
  const auto told = [&](const std::string& rows) {
    return refusal([&] { read_friction(write("d.csv", std::string(kHeader) + rows)); });
  };
  const std::string row = "m3_samples/flat.toml,0.5,200,5000,0.2,", large = row + "0.035,1.4,,\n";
  EXPECT_EQ(told(row + "0.035,0.0014,0.06,0.0023\n" + large + large),
            "3:0: F_off_sd: 1.4 N is 40 times the value, and 2 of 3 rows state more than 3 times "
            "theirs: is the standard deviation in mN? Then 0.0014 N is meant\n");
  EXPECT_EQ(told(row + "0.035,0.001,0.06,0.24\n").substr(0, 40),
            "2:0: F_on_sd: 0.24 N is 4 times the valu");
  EXPECT_EQ(told(row + "0.035,0.105,0.06,0.18\n"), "");
  EXPECT_EQ(told(row + "0.035,0.001,,\n" + large), "");
}

TEST_F(TablesAndFiles, CopiesAndRowsFarApartAreRemarked) {
  const std::string row = "m3_samples/flat.toml,0.5,200,5000,0.2,",
                    first = row + "0.03,0.003,0.06,0.004\n",
                    other = "m3_samples/flat.toml,0.6,200,5000,0.2,0.09,0.003,0.12,0.004\n";
  const auto notes = [&](const std::string& rows) {
    return read_friction(write("c.csv", std::string(kHeader) + rows)).notes;
  };
  using Notes = std::vector<std::string>;
  EXPECT_EQ(notes(first + other), Notes{});
  EXPECT_EQ(notes(first + other + first),
            Notes{"copies count as measurements of their own: line 4 of line 2"});
  // Up to five deviations of the difference are chance.
  EXPECT_EQ(notes(row + "0.0549,0.004,,\n" + first), Notes{});
  EXPECT_EQ(notes(row + "0.07,0.004,0.05,0.003\n" + other + first),
            Notes{"lines 2 and 4 are of the same conditions, and their F_off are 8 standard "
                  "deviations of their difference apart"});
  // What another column tells apart is no copy.
  const std::string days =
      "design,load_N,humidity_percent,F_off_N,F_off_sd_N,day\n"
      "m3_samples/flat.toml,0.2,35,0.1,0.01,1\nm3_samples/flat.toml,0.2,35,0.1,0.01,2\n";
  EXPECT_EQ(read_friction(write("e.csv", days)).notes, Notes{});
}

// Half a micrometre of SiO2 at 1 GV/m holds 500 V.
TEST_F(TablesAndFiles, AFrictionAboveTheFilmsBreakdownIsRefusedWithItsLine) {
  const auto told = [&](const std::string& rows) {
    write("v.csv", std::string(kHeader) + rows);
    return refusal([&] {
      read(write("v.toml",
                 "schema_version = 1\nfinger = \"fingers/reference.toml\"\ndata = \"v.csv\"\n"
                 "[parameters]\n\"skin.softening\" = { low = 1.2, high = 4.0 }\n"));
    });
  };
  const auto row = [](const std::string& volts, const std::string& on) {
    return "m3_samples/flat.toml,20 %," + volts + ",5000,0.2,0.05,0.01," + on + "\n";
  };
  EXPECT_EQ(told(row("490", "0.5,0.2")), "");
  EXPECT_EQ(told(row("150", "0.1,0.02") + row("1500", "0.5,0.2")),
            "3:0: voltage: 1500 V, but the film breaks down at 500 V: leave F_on out, or state in "
            "flat.toml the strength of a film that withstood it\n");
  EXPECT_EQ(told(row("1500", ",")), "");  // without a voltage nothing breaks
}

// A constant voltage pulls otherwise than a sine, which the design has: neither stands for the
// other.
TEST_F(TablesAndFiles, AConstantVoltageIsOfADesignThatIsDrivenByOne) {
  write("wave.toml", "schema_version = 1\n");
  write("dc.toml", "schema_version = 1\n[drive]\nwaveform = \"dc\"\n");
  const auto told = [&](const std::string& design, const std::string& rest) {
    write("z.csv", std::string(kHeader) + design + ",20 %," + rest + "\n");
    return refusal([&] {
      read(write("z.toml",
                 "schema_version = 1\nfinger = \"fingers/reference.toml\"\ndata = \"z.csv\"\n"
                 "[parameters]\n\"skin.softening\" = { low = 1.2, high = 4.0 }\n"));
    });
  };
  EXPECT_TRUE(
      told("wave.toml", "150,0,0.2,0.05,0.01,0.1,0.02")
          .starts_with("2:0: frequency: 0 Hz is a constant voltage, and the design is driven "
                       "at 5000 Hz: "))
      << told("wave.toml", "150,0,0.2,0.05,0.01,0.1,0.02");
  EXPECT_EQ(told("wave.toml", "150,5000,0.2,0.05,0.01,0.1,0.02"), "");
  EXPECT_EQ(told("dc.toml", "150,0,0.2,0.05,0.01,0.1,0.02"), "");
  EXPECT_EQ(told("wave.toml", "0,0,0.2,0.05,0.01,,"), "");  // no voltage, no frequency
}

// A design beside the table comes before one of the same name among the designs.
TEST_F(TablesAndFiles, ADesignBesideItsTableComesFirst) {
  std::filesystem::create_directories(folder_ + "/m3_samples");
  const std::string own = write("m3_samples/flat.toml", "schema_version = 1\n");
  const auto rows =
      read_friction(write("d.csv", std::string(kHeader) +
                                       "m3_samples/flat.toml,0.5,0,0,0.2,0.1,0.01,,\n"
                                       "m3_samples/a3h350.toml,0.5,0,0,0.2,0.1,0.01,,\n"))
          .rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].design, own);
  EXPECT_EQ(rows[1].design, find_design("m3_samples/a3h350.toml"));
  EXPECT_EQ(refusal([&] {
              read_friction(write("e.csv", std::string(kHeader) + ",0.5,0,0,0.2,0.1,1,,\n"));
            }),
            "2:0: design: no file \"\" beside the table\n");
}

constexpr const char* kHead = "schema_version = 1\nfinger = \"fingers/reference.toml\"\n";
constexpr const char* kSoftening = "[parameters]\n\"skin.softening\" = { low = 1.2, high = 4.0 }\n";

TEST_F(TablesAndFiles, AFileThatSaysLittleHasTheseDefaults) {
  const Calibration c = read(write("a.toml", std::string(kHead) + "fit = [\"M1\"]\n" + kSoftening));
  EXPECT_EQ(c.title, "");
  EXPECT_EQ(c.sampling.level, "draft");
  EXPECT_EQ(c.sampling.skins, 12);
  EXPECT_EQ(c.sampling.first_skin, 0);
  EXPECT_EQ(c.sampling.grid, 0);
  EXPECT_EQ(c.check.level, "design");
  EXPECT_EQ(c.check.skins, 40);
  EXPECT_EQ(c.check.first_skin, 5000);
  EXPECT_EQ(c.iterations, 15);
  EXPECT_FALSE(c.profiles);
  EXPECT_EQ(c.fit, std::vector<std::string>{"M1"});
  ASSERT_EQ(c.parameters.size(), 1u);
  const FitParameter& fit = c.parameters[0].fit;
  EXPECT_EQ(fit.name, "skin.softening");
  EXPECT_EQ(fit.start, read_finger(find_design("fingers/reference.toml")).skin.softening);
  EXPECT_EQ(fit.step, 0.04);
  EXPECT_EQ(fit.low, 1.2);
  EXPECT_EQ(fit.high, 4);
  EXPECT_FALSE(fit.logarithmic);
}

TEST_F(TablesAndFiles, AFileSaysEveryNumberOfAFit) {
  const Calibration c = read(write("a.toml", std::string(kHead) + R"(title = "mine"
iterations = 7
profiles = true
fit = ["M1", "M2"]
hold_out = ["M8"]
[sampling]
level = "reference"
skins = 4
first_skin = 0
grid = 32
[check]
level = "draft"
skins = 10000
first_skin = 9
grid = 2048
[parameters]
"water.scale" = { low = 0.5, high = 4.0, start = 2.0, prior = 1.5, factor = 2.0 }
[parameters.skin]
rms = { low = "100 nm", high = "400 nm", start = "300 nm", prior = "250 nm", sd = "20 nm" }
)"));
  EXPECT_EQ(c.title, "mine");
  EXPECT_EQ(c.iterations, 7);
  EXPECT_TRUE(c.profiles);
  EXPECT_EQ(c.hold_out, std::vector<std::string>{"M8"});
  EXPECT_EQ(c.sampling.level, "reference");
  EXPECT_EQ(c.sampling.skins, 4);
  EXPECT_EQ(c.sampling.grid, 32);
  EXPECT_EQ(c.check.level, "draft");
  EXPECT_EQ(c.check.skins, 10000);
  EXPECT_EQ(c.check.first_skin, 9);
  EXPECT_EQ(c.check.grid, 2048);
  ASSERT_EQ(c.parameters.size(), 2u);
  const FitParameter &water = c.parameters[0].fit, &rms = c.parameters[1].fit;
  EXPECT_EQ(c.parameters[0].path, "water.scale");
  EXPECT_EQ(water.low, 0.5);
  EXPECT_EQ(water.high, 4);
  EXPECT_EQ(water.start, 2);
  EXPECT_EQ(water.prior, 1.5);
  EXPECT_DOUBLE_EQ(water.prior_sd, std::log(2));
  EXPECT_TRUE(water.logarithmic);
  EXPECT_EQ(c.parameters[1].path, "skin.rms");
  EXPECT_EQ(c.parameters[1].unit, "nm");
  EXPECT_NEAR(rms.low, 100e-9, 1e-20);
  EXPECT_NEAR(rms.high, 400e-9, 1e-20);
  EXPECT_NEAR(rms.start, 300e-9, 1e-20);
  EXPECT_NEAR(rms.prior, 250e-9, 1e-20);
  EXPECT_NEAR(rms.prior_sd, 20e-9, 1e-20);
  EXPECT_FALSE(rms.logarithmic);
  // Parameters set: all volumes by their factor, the others as they are.
  const std::vector<double> values{3, 123e-9};
  const Finger set = with_parameters(c, values);
  EXPECT_EQ(set.skin.rms, 123e-9);
  Finger expected = c.finger;
  expected.skin.rms = 123e-9;
  for (double& v : expected.water.volume) v *= 3;
  EXPECT_EQ(set, expected);
}

TEST_F(TablesAndFiles, MistakesOfAFitAreToldInTheirWords) {
  const auto told = [&](const std::string& rest) {
    return refusal([&] { read(write("w.toml", std::string(kHead) + rest)); });
  };
  const auto parameter = [&](const std::string& text) {
    return told("fit = [\"M1\"]\n[parameters]\n" + text + "\n");
  };
  const std::string where = "5:18: parameters.skin.softening: ";
  EXPECT_EQ(parameter("skin.softening = { low = 1.2 }"),
            where + "a parameter needs `low` and `high`\n");
  EXPECT_EQ(parameter("skin.softening = { high = 3.0 }"),
            where + "a parameter needs `low` and `high`\n");
  EXPECT_EQ(parameter("skin.softening = { low = 2.0, high = 2.0 }"),
            where + "expected low < high\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 2.0 }"),
            where + "a prior needs its width: `factor` or `sd`\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, sd = 2.0 }"),
            where + "a prior needs its width: `factor` or `sd`\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 2.0, factor = 1.5, sd = "
                      "0.2 }"),
            where + "a prior has one width: `factor` or `sd`\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 2.0, sd = 0.0 }"),
            where + "expected `sd` above 0: what is known exactly stands in the finger's file\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 3.5, sd = 0.2 }"),
            "5:51: parameters.skin.softening.prior: 3.5 lies outside the bounds 1.2 to 3\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 1.1, factor = 2.0 }"),
            "5:51: parameters.skin.softening.prior: 1.1 lies outside the bounds 1.2 to 3\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 3.0, sd = 0.2 }"), "");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, start = 3.1 }"),
            where + "the finger's 3.1 lies outside the bounds\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, start = 1.1 }"),
            where + "the finger's 1.1 lies outside the bounds\n");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, start = 3.0 }"), "");
  EXPECT_EQ(parameter("skin.softening = { low = 1.2, high = 3.0, start = 1.2 }"), "");
  EXPECT_EQ(
      parameter("skin.rms = { low = \"0 nm\", high = \"900 nm\", prior = \"250 nm\", factor = "
                "2.0 }"),
      "5:12: parameters.skin.rms: a prior by a factor needs low above 0\n");
  EXPECT_EQ(parameter("\"skin.softening\" = 2.0"),
            "5:20: parameters.skin.softening: expected { low = ..., high = ..., prior = ..., "
            "factor = ... or sd = ... }\n");
  EXPECT_EQ(
      parameter("skin.softening = { low = 1.2, high = 3.0, least = 1.0 }"),
      "5:43: parameters.skin.softening: unknown key `least`; use low, high, start, prior, and "
      "factor or sd\n");
  EXPECT_NE(parameter("skin.softening = { low = 1.2, high = 3.0, prior = 2.0, factor = 1.0 }"), "");
  EXPECT_NE(parameter("skin.softening = { low = 0.9, high = 3.0 }"), "");  // below the key's own
  const std::string none = "expected a section [parameters] with what is fitted\n";
  EXPECT_NE(told("fit = [\"M1\"]\n").find(none), std::string::npos);
  EXPECT_NE(told("fit = [\"M1\"]\n[parameters]\n").find(none), std::string::npos);
  EXPECT_NE(told("fit = [\"M1\"]\nparameters = 3\n").find(none), std::string::npos);
  EXPECT_NE(
      told(kSoftening).find("fit: nothing to fit to: name claims in `fit` or a table in `data`\n"),
      std::string::npos);
  EXPECT_EQ(told(std::string("fit = \"M1\"\n") + kSoftening).substr(0, 41),
            "3:7: fit: expected a list of claims, got ");
  for (const auto& [key, low, high] :
       {std::tuple{"skins", 4, 10000}, std::tuple{"first_skin", 0, 1 << 30},
        std::tuple{"grid", 32, 2048}}) {
    const auto section = [&](const std::string& value) {
      return told(std::string("fit = [\"M1\"]\n") + kSoftening +
                  fmt::format("[sampling]\n{} = {}\n", key, value));
    };
    EXPECT_EQ(section(std::to_string(low)), "") << key;
    EXPECT_EQ(section(std::to_string(high)), "") << key;
    const std::string message =
        fmt::format("sampling.{}: expected a whole number from {} to {}\n", key, low, high);
    for (const std::string& wrong :
         {std::to_string(low - 1), std::to_string(high + 1), std::string("5.5")})
      EXPECT_NE(section(wrong).find(message), std::string::npos) << key << " = " << wrong;
  }
  const auto also = [&](const std::string& line) {
    return told(line + "\nfit = [\"M1\"]\n" + kSoftening);
  };
  EXPECT_EQ(also("iterations = -1"), "3:14: iterations: expected a whole number from 0 to 1000\n");
  EXPECT_EQ(also("iterations = 1001"),
            "3:14: iterations: expected a whole number from 0 to 1000\n");
  EXPECT_EQ(also("iterations = 0"), "");
  EXPECT_EQ(also("iterations = 1000"), "");
  EXPECT_EQ(also("profiles = 1"), "3:12: profiles: expected true or false\n");
  EXPECT_EQ(also("data = \"none.csv\""), "3:8: data: no file \"none.csv\"\n");
  EXPECT_EQ(also("title = 3").substr(0, 29), "3:9: title: expected a text, ");
  EXPECT_NE(also("sampling = 3").find("sampling: expected a section, got"), std::string::npos);
  const auto of_sampling = [&](const std::string& line) {
    return told(std::string("fit = [\"M1\"]\n") + kSoftening + "[check]\n" + line + "\n");
  };
  EXPECT_NE(
      of_sampling("pixels = 3").find("unknown key `pixels`; use level, skins, first_skin, grid"),
      std::string::npos);
  EXPECT_NE(of_sampling("level = \"finest\"").find("check.level: expected one of "),
            std::string::npos);
  EXPECT_EQ(of_sampling("level = \"reference\""), "");
}

}  // namespace
}  // namespace papilla::tests::tables_and_files_test
