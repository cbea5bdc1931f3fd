// [counterface] as people write it: read, written back, and what is missing named.
#include <gtest/gtest.h>

#include "config/writer.h"
#include "design/study.h"
#include "tests/support/refusal.h"

namespace papilla::tests::counterface_test {
namespace {

const std::string kHead = "schema_version = 1\n[texture]\ntype = \"flat\"\n";
const std::string kPin =
    "[counterface]\ntype = \"pin\"\nload = \"1 N\"\nmodulus = \"3 GPa\"\nradius = \"0.7 mm\"\n"
    "coefficient = 0.2\n";

Design read(const std::string& text) { return parse_study(kHead + text, "text").design; }

std::string refused(const std::string& text) {
  return keyed_refusal_of([&] { read(text); });
}

TEST(CounterfaceFile, APinReadsAndReadsBack) {
  const Design d = read(kPin + "roughness = { rms = \"0.3 um\" }\n");
  EXPECT_EQ(d.counterface.type, CounterfaceType::Pin);
  EXPECT_EQ(d.counterface.pin.modulus, 3e9);
  EXPECT_EQ(d.counterface.pin.roughness.rms, 0.3e-6);
  EXPECT_EQ(parse_study(to_toml(d), "again").design.counterface, d.counterface);
  const Scene scene = scene_of(d);
  EXPECT_EQ(scene.finger.load, 1);
  EXPECT_EQ(scene.touch.coefficient, 0.2);
}

TEST(CounterfaceFile, AFingerIsWhatItWas) {
  const Design d = read("");
  EXPECT_EQ(scene_of(d), (Scene{d.surface, d.finger, d.environment, d.drive, d.model}));
}

TEST(CounterfaceFile, WhatIsMissingIsNamed) {
  const std::string all = refused("[counterface]\ntype = \"pin\"\n");
  for (const char* key : {"counterface.load", "counterface.modulus", "counterface.radius",
                          "counterface.shear_strength"})
    EXPECT_NE(all.find(key), std::string::npos) << key;
  EXPECT_NE(refused(kPin + "shear_strength = \"5 MPa\"\n").find("one law"), std::string::npos);
  EXPECT_NE(refused(kPin + "area = \"1 mm2\"\n").find("both a radius"), std::string::npos);
  EXPECT_NE(refused("[counterface]\nload = \"1 N\"\n").find("counterface.type"), std::string::npos);
  EXPECT_NE(refused("[counterface]\ntype = \"pen\"\n").find("no pen"), std::string::npos);
  EXPECT_NE(refused("[counterface.pen]\nload = \"1 N\"\n").find("counterface.pen.modulus"),
            std::string::npos);
}

TEST(CounterfaceFile, ThePenIsJudgedInItsPlace) {
  Design d = read(
      "[counterface.pen]\nload = \"1 N\"\nmodulus = \"3 GPa\"\nradius = \"0.7 mm\"\n"
      "shear_strength = \"20 MPa\"\nconducting = false\n");
  EXPECT_EQ(scene_of(d).touch.name, "");
  EXPECT_EQ(scene_of(under_pen(d)).touch.name, "pen");
  d.drive.amplitude = 100;
  EXPECT_FALSE(scene_of(under_pen(d)).drive.driven());
}

TEST(CounterfaceFile, ARelaxationThatContradictsIsNamed) {
  EXPECT_NE(refused("[surface]\ndielectric = [{ relaxation = { law = \"debye\" } }]\n")
                .find("surface.dielectric.0.relaxation.time"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::counterface_test
