// The form of a design: what a page may write into a key, and from where to where its sliders go.
#include "studio/form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/describe.h"
#include "design/study.h"
#include "studio/safety.h"
#include "tests/temporary.h"

namespace papilla::tests::form_test {
namespace {

using Type = KeyType;

FormKey key_of(Type type, const std::string& unit) {
  FormKey out;
  out.path = "a.key", out.type = type, out.unit = unit;
  out.choices = {"one", "two"};
  if (type == Type::Integer) out.low = -1e9, out.high = 1e9;
  return out;
}

// The text of the setting; "refused" where it is no value of the key.
std::string written(const FormKey& key, const std::string& text) {
  try {
    const studio::Change change = checked_change({key}, "a.key", text);
    EXPECT_EQ(change.path, "a.key");
    return change.text;
  } catch (const InputError&) {
    return "refused";
  }
}
// Why it is none.
std::string refusal_of(const FormKey& key, const std::string& text) {
  try {
    return "taken as " + checked_change({key}, "a.key", text).text;
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
}

TEST(FormValues, AreOfTheirTypeAndInTheirUnit) {
  const FormKey length = key_of(Type::Number, "nm"), plain = key_of(Type::Number, "");
  EXPECT_EQ(written(length, "262"), "262 nm");
  EXPECT_EQ(written(length, "0.3 um"), "300 nm");
  for (const char* wrong : {"", "nm", "3 V", "1e400", "262 nm; x"})
    EXPECT_EQ(written(length, wrong), "refused") << wrong;
  EXPECT_EQ(written(plain, "0.25"), "0.25");
  EXPECT_EQ(written(plain, "25 %"), "0.25");
  EXPECT_EQ(written(plain, "3 nm"), "refused");
  const FormKey whole = key_of(Type::Integer, "");
  for (const auto& [text, expected] : {std::pair{"7", "7"},
                                       {"-3", "-3"},
                                       {"1000000000", "1000000000"},
                                       {"-1e9", "-1000000000"},
                                       {"1000000001", "refused"},
                                       {"-1000000001", "refused"},
                                       {"7.5", "refused"},
                                       {"x", "refused"}})
    EXPECT_EQ(written(whole, text), expected) << text;
  const FormKey flag = key_of(Type::Flag, "");
  EXPECT_EQ(written(flag, "true"), "true");
  EXPECT_EQ(written(flag, "false"), "false");
  EXPECT_EQ(written(flag, "yes"), "refused");
  const FormKey choice = key_of(Type::Choice, "");
  EXPECT_EQ(written(choice, "two"), "two");
  EXPECT_EQ(written(choice, "three"), "refused");
  // Texts cannot leave their quotes.
  EXPECT_EQ(written(key_of(Type::Text, ""), "a\"b\\c\nd e"), "\"a\\\"b\\\\c\\nd e\"");
  EXPECT_EQ(written(key_of(Type::Path, ""), "scan.gsf"), "refused");
}

// A bare number is in the unit of its key unless it may be meant otherwise: then as a file asks.
TEST(FormValues, WithoutAUnitAreAskedForItWhereTheyMayBeMeantInAnother) {
  const FormKey share = key_of(Type::Numbers, "%"), length = key_of(Type::Number, "nm");
  EXPECT_EQ(refusal_of(share, "0.15"),
            "needs a unit: \"15 %\" if 0.15 is a share of 1, \"0.15 %\" if it is in percent");
  EXPECT_EQ(refusal_of(length, "6e-7"),
            "needs a unit: \"600 nm\" if 6e-7 is in m, \"6e-7 nm\" if it is in nm");
  EXPECT_EQ(written(share, "15, 0"), "[\"15 %\", \"0 %\"]");
  EXPECT_EQ(written(length, "0.5"), "0.5 nm");
  EXPECT_EQ(refusal_of(length, "1,200 nm"),
            "\"1,200 nm\" may be of a decimal comma or of thousands; write a point (1.2) or the "
            "digits alone (1200)");
  EXPECT_EQ(refusal_of(length, "thin, thick"), "expected a number in nm");
}

TEST(FormValues, OfWholeNumbersSayWhatIsWrongWithThem) {
  FormKey seed = key_of(Type::Integer, "");
  seed.low = 0, seed.high = 1000;
  EXPECT_EQ(refusal_of(seed, ""), "expected a whole number");
  EXPECT_EQ(refusal_of(seed, "500 %"), "expected a whole number");
  EXPECT_EQ(refusal_of(seed, "1e10"), "1e10 is outside 0 to 1000");
  EXPECT_EQ(refusal_of(seed, "-1"), "-1 is outside 0 to 1000");
}

TEST(FormValues, OfListsAreAtMostSixtyFour) {
  const FormKey shares = key_of(Type::Numbers, "%"), plain = key_of(Type::Numbers, "");
  EXPECT_EQ(written(shares, "15, 0.35 %,55 %"), "[\"15 %\", \"0.35 %\", \"55 %\"]");
  EXPECT_EQ(written(plain, "1, 2"), "[1, 2]");
  EXPECT_EQ(written(plain, ""), "[]");
  EXPECT_EQ(written(plain, "1, x"), "refused");
  std::string many = "1";
  for (int i = 1; i < 64; ++i) many += ",1";
  EXPECT_NE(written(plain, many), "refused");
  EXPECT_EQ(written(plain, many + ",1"), "refused");
}

TEST(FormValues, AreShortAndOfAKeyThatIsThere) {
  const FormKey text = key_of(Type::Text, "");
  EXPECT_NE(written(text, std::string(2000, 'a')), "refused");
  EXPECT_EQ(written(text, std::string(2001, 'a')), "refused");
  EXPECT_THROW(checked_change({text}, "another.key", "a"), InputError);
}

TEST(FormSliders, GoAroundTheValueThatTheFileHad) {
  Study study = read_study(PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml");
  const Design opened = study.design;
  const auto row = [&](const std::string& path, const std::vector<studio::Change>& changes = {}) {
    for (const auto& r : form_json(study, opened, changes)) {
      if (r["path"] == path) return r;
    }
    ADD_FAILURE() << path;
    return nlohmann::ordered_json();
  };
  const auto expect_slider = [&](const std::string& path, double low, double high, bool log) {
    const auto s = row(path)["slider"];
    EXPECT_NEAR(s["low"].get<double>(), low, 1e-9) << path;
    EXPECT_NEAR(s["high"].get<double>(), high, 1e-9) << path;
    EXPECT_EQ(s["log"], log) << path;
  };
  // A quarter to four times, by factors; angles and shares over their whole range.
  expect_slider("texture.depth", 150, 2400, true);
  expect_slider("texture.period", 1.5, 24, true);
  expect_slider("texture.wall_angle", 1, 90, false);
  EXPECT_DOUBLE_EQ(row("texture.depth")["shown"].get<double>(), 600);
  EXPECT_FALSE(row("texture.depth")["changed"]);
  const std::string place = row("texture.depth")["place"];
  EXPECT_TRUE(place.starts_with("a3h600.toml, line ")) << place;
  EXPECT_EQ(row("texture.depth", {{"texture.depth", "700 nm"}})["place"], "changed here");
  EXPECT_TRUE(row("texture.depth", {{"texture.depth", "700 nm"}})["changed"]);
  // Of a variable of the study its bounds, and whatever holds the value.
  study.variables = {{"texture.depth", "nm", 100e-9, 400e-9, {}}};
  expect_slider("texture.depth", 100, 600, false);
  // From nothing there is no factor.
  study.variables.clear();
  std::get<HoleArray>(study.design.texture.kind).depth = 0;
  const auto zero = row("texture.depth")["slider"];
  EXPECT_EQ(zero["low"], 0);
  EXPECT_FALSE(zero["log"]);
  // A whole number: eight beyond its least, twice itself where that is more, and no further than
  // the key goes.
  study.design.texture = default_texture(0);
  for (const auto& [number, high] : {std::pair{1, 9}, {4, 9}, {7, 15}, {20, 41}, {40, 64}}) {
    Design at = opened;
    at.accuracy.droplet_seeds = number;
    study.design.accuracy.droplet_seeds = number;
    bool found = false;
    for (const auto& r : form_json(study, at, {})) {
      if (r["path"] != "accuracy.droplet_seeds") continue;
      found = true;
      EXPECT_EQ(r["slider"]["low"], 1) << number;
      EXPECT_EQ(r["slider"]["high"], high) << number;
      EXPECT_FALSE(r["slider"]["log"]) << number;
    }
    EXPECT_TRUE(found);
  }
}

TEST(FormRows, ThatMovedMakeTheNewFormOfTheOneBefore) {
  const Study study = read_study(PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml");
  const auto rows_with = [&](const char* path, double si, const char* text) {
    Study at = study;
    set_number(at.design, path, si);
    return form_json(at, study.design, {{path, text}});
  };
  const auto told = form_json(study, study.design, {});
  auto patched = told;
  const auto now = rows_with("texture.depth", 700e-9, "700 nm");
  const auto moved = moved_since(told, now);
  ASSERT_TRUE(moved);
  ASSERT_EQ(moved->size(), 1U) << *moved;
  for (auto& row : patched) {
    if (row["path"] == (*moved)[0]["path"]) row.update((*moved)[0]);
  }
  EXPECT_EQ(patched, now);
  EXPECT_EQ(moved_since(told, told), nlohmann::ordered_json::array());
  // Beyond its slider, which ends elsewhere now: other words.
  EXPECT_FALSE(moved_since(told, rows_with("texture.depth", 3000e-9, "3000 nm")));
  Study other = study;
  other.design.texture = default_texture(0);
  EXPECT_FALSE(moved_since(told, form_json(other, study.design, {})));
}

// Letters that a name may not have, one by one; up to two hundred of the others.
TEST(Inside, TakesPlainLettersAlone) {
  const TemporaryFolder place;
  const auto taken = [&](const std::string& name) {
    try {
      inside(place.path(), name);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  for (const char c : {'\x01', '\x1f', '\x7f', '\\', ':'})
    EXPECT_FALSE(taken(std::string("a") + c + "b")) << int{c};
  for (const char c : {' ', '~', '(', '-', '_'}) EXPECT_TRUE(taken(std::string("a") + c + "b"));
  EXPECT_TRUE(taken(std::string(200, 'a')));
  EXPECT_FALSE(taken(std::string(201, 'a')));
  EXPECT_TRUE(taken("a/" + std::string(200, 'b')));
}

}  // namespace
}  // namespace papilla::tests::form_test
