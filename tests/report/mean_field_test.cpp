// A mean-field case as people and programs read it: made-up numbers, each another.
#include <gtest/gtest.h>

#include <string>

#include "report/persson.h"
#include "tests/report/same_json.h"

namespace papilla::tests {
namespace {

MeanFieldPoint point() {
  MeanFieldPoint p;
  p.voltage = 150, p.load = 0.5, p.frequency = 2000;
  p.thickness = {3e-6, -4e-6};  // |h0| = 5 um
  p.area_off = 0.005;
  p.on.pull = {PullStatus::Solved, 12e3, 7e3, 0.0075, 4.5e-6};
  p.on.friction = 0.6, p.on.coefficient = 1.2;
  p.capacitance = 1.6e-10;
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

}  // namespace
}  // namespace papilla::tests
