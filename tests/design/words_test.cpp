#include "design/words.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "design/study.h"
#include "report/reference.h"
#include "tests/support/refusal.h"

namespace papilla::tests::words_test {
namespace {

TEST(Words, EachStandsForAKeyOfTheReference) {
  for (const Word& w : words()) {
    std::string path = w.key;
    if (path == "surface.dielectric.0.thickness") path = "surface.dielectric";  // of a list's item
    EXPECT_NO_THROW(reference_section(path, ReferenceFormat::Text)) << w.word << ": " << w.key;
  }
}

TEST(Words, TheSectionDecides) {
  EXPECT_EQ(key_for_word("voltage", "drive"), "drive.amplitude");
  EXPECT_EQ(key_for_word("voltage", ""), "drive.amplitude");
  EXPECT_EQ(key_for_word("stiffness", "finger"), "finger.skin.layer_modulus");
  EXPECT_EQ(key_for_word("stiffness", "finger.skin"), "finger.skin.layer_modulus");
  EXPECT_EQ(key_for_word("stiffness", "surface"), "surface.modulus");
  EXPECT_EQ(key_for_word("roughness", "texture"), "texture.rms");
  EXPECT_EQ(key_for_word("xyzzy", "finger"), "");
}

std::string mistakes(const std::string& text) {
  return refusal_of([&] { parse_study("schema_version = 1\n" + text, "design.toml"); });
}

TEST(Words, AreTheHintOfAnUnknownKey) {
  EXPECT_NE(mistakes("[drive]\nvoltage = \"100 V\"\n")
                .find("unknown key `voltage`, did you mean `drive.amplitude`?"),
            std::string::npos)
      << mistakes("[drive]\nvoltage = \"100 V\"\n");
  EXPECT_NE(mistakes("[finger]\nstiffness = \"1 MPa\"\n")
                .find("did you mean `finger.skin.layer_modulus`?"),
            std::string::npos);
  // A slip of the keyboard is still one.
  EXPECT_NE(mistakes("[drive]\namplitud = \"100 V\"\n").find("did you mean `amplitude`?"),
            std::string::npos);
}

// Who gives a file of another kind is told what takes it, not that each of its keys is unknown.
TEST(Words, AFileThatIsNoDesignSaysWhatTakesIt) {
  const std::string designs = PAPILLA_SOURCE_DIR "/designs/";
  const std::vector<std::pair<std::string, std::string>> others{
      {"fingers/belief.toml", "no design but a belief: a finger names it"},
      {"fingers/reference.calibration.toml",
       "no design but a calibration: `papilla calibrate FILE`"},
      {"fingers/moist.toml",
       "no design but a finger: a design names it in its [finger], base = \"FILE\""},
      {"physics/rough_contact.toml", "no design but a case of `papilla solve contact`"},
      {"physics/fingertip_drive.toml", "no design but a case of `papilla solve drive`"},
      {"physics/wrist_on_glass.toml", "no design but a case of `papilla solve persson`"}};
  for (const auto& [file, said] : others)
    EXPECT_NE(refusal_of([&] { read_study(designs + file); }).find(said), std::string::npos)
        << refusal_of([&] { read_study(designs + file); });
}

// "0.05" of one or of a hundred: both are shown, none is taken.
TEST(Words, AShareWithoutAUnitIsAskedBack) {
  EXPECT_NE(
      mistakes("[accuracy]\ntarget = \"0.05\"\n")
          .find("needs a unit: \"5 %\" if 0.05 is a share of 1, \"0.05 %\" if it is in percent"),
      std::string::npos)
      << mistakes("[accuracy]\ntarget = \"0.05\"\n");
  EXPECT_EQ(mistakes("[accuracy]\ntarget = \"5 %\"\n"), "");
}

// "5000" in a key of kHz is most likely in Hz, "3e-6" in one of um in m: both are shown.
TEST(Words, ANumberInTheUnitOfTheSiIsAskedBack) {
  EXPECT_NE(mistakes("[drive]\nfrequency = 5000\n")
                .find("needs a unit: \"5 kHz\" if 5000 is in Hz, \"5000 kHz\" if it is in kHz"),
            std::string::npos)
      << mistakes("[drive]\nfrequency = 5000\n");
  EXPECT_NE(mistakes("[drive]\nfrequency = 5\n").find("needs a unit, e.g. \"5 kHz\""),
            std::string::npos);
  EXPECT_NE(mistakes("[texture]\ntype = \"hole_array\"\nperiod = 6e-6\n")
                .find("needs a unit: \"6 um\" if 6e-6 is in m"),
            std::string::npos)
      << mistakes("[texture]\ntype = \"hole_array\"\nperiod = 6e-6\n");
}

// Behind a kind that is spelled wrong its keys are read as of the one that is meant.
TEST(Words, KeysOfAMisspelledKindAreJudgedAtOnce) {
  const std::string said =
      mistakes("[texture]\ntype = \"hole_aray\"\nperiod = \"6 V\"\ndepht = \"350 nm\"\n");
  EXPECT_NE(said.find("did you mean \"hole_array\"?"), std::string::npos) << said;
  EXPECT_NE(said.find("texture.period: expected a length, got \"6 V\""), std::string::npos) << said;
  EXPECT_NE(said.find("did you mean `depth`?"), std::string::npos) << said;
}

constexpr const char* kRough = R"toml(
[texture]
type = "random_rough"
[design_space]
"texture.rms" = ["5 nm", "200 nm"]
"surface.contact_angle" = ["40 deg", "80 deg"]
[scatter]
"texture.rms" = "5 nm"
[objective]
minimise = "mean(friction)"
)toml";

// What a base lets vary of its kind of texture goes with that kind, and the study says so.
TEST(Base, VariablesOfAnotherKindFallAwayWithIt) {
  const Study study = parse_study(std::string("schema_version = 1\n") + kRough, "rough.toml",
                                  {"texture.type=hole_array"});
  ASSERT_EQ(study.variables.size(), 1u);
  EXPECT_EQ(study.variables[0].path, "surface.contact_angle");
  EXPECT_TRUE(study.scatter.empty());
  EXPECT_EQ(study.fallen_away,
            (std::vector<std::string>{"design_space.texture.rms", "scatter.texture.rms"}));
  // Its resolved file is the same study again.
  const Study again = parse_study(resolved_toml(study), "resolved.toml");
  EXPECT_EQ(again.variables, study.variables);
  EXPECT_TRUE(again.fallen_away.empty());
}

// What no kind of texture has is no variable of another kind, wherever the kind is said.
TEST(Base, AVariableThatIsWrittenWrongIsRefused) {
  const std::string text =
      "base = \"m3_samples/a3h350.toml\"\n[objective]\nminimise = \"mean(friction)\"\n"
      "[design_space]\n\"texture.dept\" = [\"200 nm\", \"500 nm\"]\n";
  EXPECT_NE(mistakes(text).find("`texture.dept` is no number of this design, did you mean "
                                "`texture.depth`?"),
            std::string::npos)
      << mistakes(text);
  const std::string own = "schema_version = 1\n" + text;
  EXPECT_NE(refusal_of([&] {
              parse_study(own, "own.toml", {"texture.type=waves"});
            }).find("`texture.dept` is no number of this design"),
            std::string::npos);
  // One of another kind goes where the caller names a base of another kind.
  std::string right = own;
  right.replace(right.find("texture.dept"), 12, "texture.depth");
  const Study rough = parse_study(right + "\"surface.contact_angle\" = [\"40 deg\", \"80 deg\"]\n",
                                  "own.toml", {"base=m3_samples/screen_rough.toml"});
  EXPECT_EQ(rough.fallen_away, std::vector<std::string>{"design_space.texture.depth"});
}

// In one file it is a mistake.
TEST(Base, AVariableOfAnotherKindBesideTheKindIsRefused) {
  std::string text = kRough;
  text.replace(text.find("random_rough"), 12, "hole_array");
  EXPECT_NE(mistakes(text).find("`texture.rms` is no number of this design"), std::string::npos);
  EXPECT_EQ(mistakes(kRough), "");
}

}  // namespace
}  // namespace papilla::tests::words_test
