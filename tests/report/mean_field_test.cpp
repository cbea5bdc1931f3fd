// A mean-field case as people and programs read it: made-up numbers, each another.
#include <gtest/gtest.h>

#include <string>

#include "report/persson.h"
#include "tests/report/same_json.h"

namespace papilla::tests::mean_field_test {
namespace {

MeanFieldPoint point() {
  MeanFieldPoint p;
  p.voltage = 150, p.load = 0.5, p.frequency = 2000;
  p.thickness = {3e-6, -4e-6};  // |h0| = 5 um
  p.area_off = 0.005;
  p.on.pull = {PullStatus::Solved, 12e3, 7e3, 0.0075, 4.5e-6};
  p.on.friction = 0.6, p.on.coefficient = 1.2;
  p.capacitance = 1.6e-10;
  p.dielectric_margin = 8;
  return p;
}

TEST(MeanFieldReport, ForPeopleHasEachNumberInTheUnitBesideIt) {
  MeanFieldCase c;
  c.title = "a case";
  c.touch.finite_size_pressure = 10e3;
  MeanFieldResult r;
  r.rms = 22e-6, r.slope = 0.9, r.contact_modulus = 3e6;
  r.point = point();
  r.voltage = {point()};
  EXPECT_EQ(
      mean_field_text(c, r, 0.25),
      "a case\n"
      "roughness        rms 22 um, slope 0.9\n"
      "pressure         12 kPa, of it pull 7 kPa\n"
      "contact area     0.75 % of the nominal area; off 0.5 %, ratio 1.5\n"
      "mean gap         4.5 um\n"
      "friction         0.6 N (coefficient 1.2)\n"
      "capacitance      160 pF\n"
      "\nover voltage\n"
      "       V        N         Hz     pull Pa        A/A0    on/off    gap um friction N     "
      " mu\n"
      "     150      0.5       2000        7000      0.0075       1.5       4.5        0.6     "
      "1.2\n"
      "0.25 s\n");
  // Below the pressure of the finite body the gaps are held; without a load there is no
  // coefficient.
  r.voltage[0].on.pull.pressure = 9e3;
  r.voltage[0].load = 0;
  r.voltage[0].area_off = 0;
  const std::string held = mean_field_text(c, r, 0);
  EXPECT_NE(held.find("        -       4.5        0.6       -  gap held\n"), std::string::npos)
      << held;
  EXPECT_NE(held.find("gap held: limited by the finite body; below 10 kPa"), std::string::npos);
  EXPECT_EQ(held.find("4.5 um, held"), std::string::npos);  // the case's own point is not
  r.voltage.clear();
  EXPECT_EQ(mean_field_text(c, r, 0).find("held"), std::string::npos);
  r.point.on.pull.status = PullStatus::Collapsed;
  EXPECT_NE(mean_field_text(c, r, 0).find("pulled in"), std::string::npos);
}

TEST(MeanFieldReport, ForProgramsIsInSi) {
  MeanFieldCase c;
  c.title = "a case";
  MeanFieldResult r;
  r.rms = 22e-6, r.slope = 0.9, r.contact_modulus = 3e6;
  r.point = point();
  r.load = {point()};
  const nlohmann::json p{{"voltage", 150},        {"load", 0.5},
                         {"frequency", 2000},     {"equivalent_thickness", 5e-6},
                         {"collapsed", false},    {"pressure", 12e3},
                         {"breaks_down", false},  {"dielectric_margin", 8},
                         {"pull", 7e3},           {"area_off", 0.005},
                         {"area_on", 0.0075},     {"area_ratio", 1.5},
                         {"mean_gap", 4.5e-6},    {"gap_held", false},
                         {"friction", 0.6},       {"coefficient", 1.2},
                         {"capacitance", 1.6e-10}};
  expect_document(mean_field_json(c, r, 0.25), {{"schema", 1},
                                                {"title", "a case"},
                                                {"rms", 22e-6},
                                                {"slope", 0.9},
                                                {"contact_modulus", 3e6},
                                                {"point", p},
                                                {"over_voltage", nlohmann::json::array()},
                                                {"over_load", nlohmann::json::array({p})},
                                                {"over_frequency", nlohmann::json::array()},
                                                {"seconds", 0.25}});
}

TEST(MeanFieldReport, CurvesHaveTheColumnsOfTheirHead) {
  MeanFieldPoint unloaded = point();
  unloaded.load = 0;
  EXPECT_EQ(mean_field_grid_csv({point(), unloaded}),
            "voltage,load,pull,area,area_off,mean_gap,friction,coefficient\n"
            "150,0.5,7000,0.0075,0.005,4.5e-06,0.6,1.2\n"
            "150,0,7000,0.0075,0.005,4.5e-06,0.6,\n");
  MeanFieldCurves curves;
  curves.roughness = {{2000, 1e-12, 2e-12, 0.5, 0.25, 0.125}, {5000, 3e-12, 4e-12, 0.4, 0.3, 0.2}};
  EXPECT_EQ(roughness_csv(curves),
            "wave_number,magnification,density,density_smoothed,area,area_elastic,area_yielded\n"
            "2000,1,1e-12,2e-12,0.5,0.25,0.125\n5000,2.5,3e-12,4e-12,0.4,0.3,0.2\n");
  curves.stress = {{1e-6, 20, 0.5, 700}};
  EXPECT_EQ(stress_csv(curves), "gap,stress,density,pull_per_decade\n1e-06,20,0.5,700\n");
  curves.separation = {{3e3, 4e-6, 5e-6}};
  EXPECT_EQ(separation_csv(curves), "pressure,mean_gap,mean_gap_held\n3000,4e-06,5e-06\n");
  curves.step = {{0.01, 2e6, 300}};
  EXPECT_EQ(step_csv(curves), "time,field_in_mean_gap,pull\n0.01,2e+06,300\n");
}

// Below the pressure of the finite body, at it, and above; without a load or a contact; pulled in.
TEST(MeanFieldReport, SaysWhatHasNoNumberAndWhatIsHeld) {
  MeanFieldCase c;
  c.touch.finite_size_pressure = 12e3;  // that of the point
  MeanFieldResult r;
  r.point = point();
  EXPECT_EQ(mean_field_text(c, r, 0).find("held"), std::string::npos);
  MeanFieldPoint lighter = point();
  lighter.on.pull.pressure = 11e3;
  lighter.load = 0, lighter.area_off = 0;
  for (auto* points : {&r.voltage, &r.load, &r.frequency}) {
    *points = {point(), lighter};
    const std::string text = mean_field_text(c, r, 0);
    EXPECT_NE(text.find("gap held: limited by the finite body; below 12 kPa"), std::string::npos);
    EXPECT_NE(text.find("    -  gap held\n"), std::string::npos) << text;
    points->clear();
  }
  const auto json = [&] { return nlohmann::json::parse(mean_field_json(c, r, 0))["point"]; };
  EXPECT_EQ(json()["gap_held"], false);
  EXPECT_EQ(json()["area_ratio"], 1.5);
  r.point = lighter;
  r.point.on.pull.status = PullStatus::Collapsed;
  EXPECT_TRUE(json()["area_ratio"].is_null() && json()["coefficient"].is_null());
  EXPECT_EQ(json()["gap_held"], false);
  EXPECT_EQ(json()["collapsed"], true);
  r.point.on.pull.status = PullStatus::Solved;
  EXPECT_EQ(json()["gap_held"], true);
  const std::string text = mean_field_text(c, r, 0.25);
  EXPECT_NE(text.find("off 0 %, ratio -\nmean gap         4.5 um, held\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("(coefficient -)"), std::string::npos);
  EXPECT_TRUE(text.ends_with("0.25 s\n"));
}

// A point without an equilibrium, or whose film breaks down, has no state under voltage.
TEST(MeanFieldReport, APointWithoutAStateHasNoNumbersUnderVoltage) {
  MeanFieldCase c;
  for (const bool breaks : {false, true}) {
    MeanFieldResult r;
    MeanFieldPoint none = point();
    if (breaks) {
      none.dielectric_margin = 0.99;
    } else {
      none.on.pull.status = PullStatus::Collapsed;
    }
    r.point = none;
    r.voltage = {point(), none};
    const std::string text = mean_field_text(c, r, 0);
    const std::string why = breaks ? "breaks down" : "pulled in";
    EXPECT_NE(text.find("off 0.5 % of the nominal area; under 150 V no number: " + why + "\n"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("friction  "), std::string::npos) << text;
    EXPECT_NE(text.find("     150      0.5       2000           -           -         -         - "
                        "         -       -  " +
                        why + "\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\n" + why + ": "), std::string::npos);
    const auto json = nlohmann::json::parse(mean_field_json(c, r, 0));
    EXPECT_EQ(json["point"]["collapsed"], !breaks);
    EXPECT_EQ(json["point"]["breaks_down"], breaks);
    EXPECT_EQ(json["point"]["area_off"], 0.005);
    for (const char* key : {"pressure", "pull", "area_on", "area_ratio", "mean_gap", "friction",
                            "coefficient", "capacitance"})
      EXPECT_TRUE(json["point"][key].is_null()) << key;
    EXPECT_EQ(json["over_voltage"][0]["friction"], 0.6);
    EXPECT_EQ(mean_field_grid_csv({none}),
              "voltage,load,pull,area,area_off,mean_gap,friction,coefficient\n"
              "150,0.5,,,0.005,,,\n");
    r.point = point();  // in a table alone it is told as well
    EXPECT_NE(mean_field_text(c, r, 0).find("\n" + why + ": "), std::string::npos);
  }
}

// A pull that presses beyond the hardness, of the point and in a table.
TEST(MeanFieldReport, SaysWhereAllOfTheSkinYields) {
  MeanFieldCase c;
  MeanFieldResult r;
  r.point = point();
  r.voltage = {point(), point()};
  EXPECT_FALSE(nlohmann::json::parse(mean_field_json(c, r, 0))["point"].contains("yielded"));
  c.skin.hardness = 11e3;
  EXPECT_EQ(mean_field_text(c, r, 0).find("yields"), std::string::npos);
  r.voltage[1].yielded = r.point.yielded = true;
  const std::string text = mean_field_text(c, r, 0);
  EXPECT_NE(text.find("\nyields everywhere: the pressure is beyond the hardness, 11 kPa, "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("1.2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("1.2  yields everywhere\n"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(mean_field_json(c, r, 0));
  EXPECT_EQ(json["point"]["yielded"], true);
  EXPECT_EQ(json["over_voltage"][0]["yielded"], false);
}

}  // namespace
}  // namespace papilla::tests::mean_field_test
