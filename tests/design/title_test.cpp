// What a design is called after some of its values were set.
#include "design/title.h"

#include <gtest/gtest.h>

#include "config/describe.h"

namespace papilla::tests::title_test {
namespace {

std::string title_of(const std::vector<std::string>& overrides) {
  return title_as_set(read_design(find_design("m3_samples/a3h600.toml"), overrides), overrides);
}
std::string own_title() { return title_of({}); }

TEST(Title, SaysWhatWasSetOfItsDesign) {
  EXPECT_EQ(title_of({"texture.depth=300nm"}), own_title() + "; texture.depth 300 nm");
  EXPECT_EQ(title_of({"texture.depth:=3e-7", "drive.amplitude=\"0.1 kV\""}),
            own_title() + "; texture.depth 300 nm; drive.amplitude 100 V");
  EXPECT_EQ(title_of({"finger.state=\"wet\"", "texture.depth=1um", "texture.depth=300 nm"}),
            own_title() + "; finger.state wet; texture.depth 300 nm");
  EXPECT_EQ(title_of({"finger.water.volume=[\"0 um3\",\"0 um3\",\"0 um3\",\"0 um3\"]"}),
            own_title() + "; finger.water.volume changed");
}

TEST(Title, IsTheFilesWhereNoOtherDesignIsMade) {
  EXPECT_EQ(title_of({"accuracy.level=draft", "environment.relative_humidity=[\"50 %\"]"}),
            own_title());
  EXPECT_EQ(title_of({"texture.depth=300nm", "title=mine"}), "mine");
  Design nameless;
  EXPECT_EQ(title_as_set(nameless, {"texture.depth=300nm"}), "");
}

TEST(Title, NamesSectionsOfManyValues) {
  EXPECT_EQ(title_of({"texture.depth=300nm", "texture.diameter=2um", "finger.load=1N",
                      "texture.edge_radius=0nm"}),
            own_title() + "; texture changed; finger changed");
  EXPECT_EQ(title_of({"texture={type=\"flat\"}", "surface.contact_angle=70deg", "finger.load=1N",
                      "drive.amplitude=100V"}),
            own_title() + "; texture changed; surface changed; finger changed; drive changed");
}

TEST(Title, SaysOfAValueThatIsSetAgainTheLastAlone) {
  Design design = read_design(find_design("m3_samples/a3h600.toml"), {"texture.depth=250nm"});
  design.title = "Holes; texture.depth 300 nm; finger.load 1 N";
  EXPECT_EQ(title_as_set(design, {"texture.depth=250nm"}),
            "Holes; finger.load 1 N; texture.depth 250 nm");
  EXPECT_EQ(title_as_set(design, {"texture.depth=250nm", "texture.period=6um",
                                  "texture.diameter=3um", "texture.edge_radius=0nm"}),
            "Holes; finger.load 1 N; texture changed");
}

TEST(Title, SaysWhatASearchChangedInFourDigits) {
  const Design own = read_design(find_design("m3_samples/a3h600.toml"));
  EXPECT_EQ(title_as_changed(own, own), own.title);
  Design found = own;
  set_number(found, "texture.depth", 345.678912e-9);
  EXPECT_EQ(title_as_changed(own, found), own.title + "; texture.depth 345.7 nm");
  set_number(found, "texture.depth", 600e-9 * (1 + 1e-13));  // rounding is no change
  set_number(found, "drive.amplitude", 100);
  EXPECT_EQ(title_as_changed(own, found), own.title + "; drive.amplitude 100 V");
  found.title = "another";
  EXPECT_EQ(title_as_changed(own, found), own.title + "; drive.amplitude 100 V");
}

// A surface without relief is not called by its holes alone, however much else is changed.
TEST(Title, SaysThatTheReliefWent) {
  const Design own = read_design(find_design("m3_samples/a3h600.toml"));
  const Design flat =
      read_design(find_design("m3_samples/a3h600.toml"),
                  {"texture.type=flat", "surface.contact_angle=70deg", "drive.amplitude=100V"});
  EXPECT_EQ(title_as_changed(own, flat),
            own.title + "; texture flat; surface.contact_angle 70 deg; drive.amplitude 100 V");
  Design shallow = own;
  set_number(shallow, "texture.depth", 0);
  EXPECT_EQ(title_as_changed(own, shallow), own.title + "; texture flat");
  Design many = flat;
  set_number(many, "drive.frequency", 2 * get_number(many, "drive.frequency"));
  set_number(many, "finger.load", 2 * get_number(many, "finger.load"));
  EXPECT_EQ(title_as_changed(own, many),
            own.title + "; texture flat; surface changed; finger changed; drive changed");
}

TEST(Title, IsNoLongerThanTitlesAre) {
  Design design = read_design(find_design("m3_samples/a3h600.toml"));
  design.title = std::string(kLongestTitle - 5, 'x');
  EXPECT_EQ(title_as_set(design, {"texture.depth=600nm"}), design.title);
}

}  // namespace
}  // namespace papilla::tests::title_test
