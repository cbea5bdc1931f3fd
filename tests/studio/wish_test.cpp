// A wish on the page as a study file, and the first answer's band.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/files.h"
#include "config/describe.h"
#include "studio/first_answer.h"
#include "studio/search_desk.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

using Json = nlohmann::ordered_json;

const std::string kHoles = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";

Study reread(const std::string& text) {
  const TemporaryFolder place;
  const std::string file = place.path() / "study.toml";
  write_bytes(file, text);
  return read_study(file);
}

SearchWish depth_wish() {
  SearchWish wish;
  wish.variables = {{"texture.depth", "100 nm", "800 nm"}, {"texture.period", "6 um", "6 um"}};
  wish.maximise = {"mean(modulation)"};
  wish.limits = {{"min_hole", "1 um"}, {"aspect_ratio", "1"}};
  wish.evaluations = 12;
  return wish;
}

TEST(SearchWish, IsAStudyOfTheDesignAtHand) {
  const Study study = read_study(kHoles, {"texture.diameter=2 um"});
  const Study made = reread(study_text(study, depth_wish()));
  EXPECT_EQ(made.design.texture, study.design.texture);
  EXPECT_EQ(made.design.finger, study.design.finger);
  ASSERT_EQ(made.variables.size(), 1u);  // the period is pinned
  EXPECT_EQ(made.variables[0].path, "texture.depth");
  EXPECT_DOUBLE_EQ(made.variables[0].low, 100e-9);
  EXPECT_DOUBLE_EQ(made.variables[0].high, 800e-9);
  ASSERT_EQ(made.constraints.size(), 2u);
  EXPECT_DOUBLE_EQ(made.constraints[0].limit, 1e-6);
  EXPECT_EQ(made.search.evaluations, 12);
}

TEST(SearchWish, SteersAStudyThatTheFileHasAlready) {
  const Study study = read_study(PAPILLA_DESIGNS_DIR "/two_level_glass/study.toml");
  Json proposed = proposed_wish(study);
  Json wanted{{"variables", Json::array()}, {"maximise", {"worst(modulation)"}}};
  for (const Json& v : proposed["variables"]) {
    if (v["vary"] == true) wanted["variables"].push_back(v);
  }
  const Study made = reread(study_text(study, search_wish(wanted)));
  EXPECT_EQ(made.variables.size(), wanted["variables"].size());
  EXPECT_EQ(made.objective.maximise, std::vector<std::string>{"worst(modulation)"});
  EXPECT_TRUE(made.objective.minimise.empty());
}

TEST(SearchWish, OffersTheMeasuresOfADesignWithoutAStudy) {
  const Json proposed = proposed_wish(read_study(kHoles));
  bool varied = false;
  for (const Json& v : proposed["variables"]) {
    if (v["path"] != "texture.depth") continue;
    varied = v["vary"];
    EXPECT_EQ(v["low"], "300 nm");
    EXPECT_EQ(v["high"], "1200 nm");
  }
  EXPECT_TRUE(varied);
  EXPECT_EQ(proposed["maximise"], Json({"mean(modulation)"}));
}

TEST(SearchWish, LeavesOutWhatIsExcluded) {
  SearchWish wish = depth_wish();
  wish.variables.front().excluding = "300 to 400 nm, 0.6 um to 650 nm";
  const Study made = reread(study_text(read_study(kHoles), wish));
  ASSERT_EQ(made.variables.size(), 1u);
  ASSERT_EQ(made.variables[0].excluded.size(), 2u);
  EXPECT_DOUBLE_EQ(made.variables[0].excluded[0].from, 300e-9);
  EXPECT_DOUBLE_EQ(made.variables[0].excluded[0].to, 400e-9);
  EXPECT_DOUBLE_EQ(made.variables[0].excluded[1].from, 600e-9);
  EXPECT_EQ(proposed_wish(made)["variables"][0]["excluding"], "300 nm to 400 nm, 600 nm to 650 nm");
  wish.variables.front().excluding = "about 300 nm";
  EXPECT_THROW(study_text(read_study(kHoles), wish), InputError);
}

TEST(SearchWish, RefusesWhatIsNoSearch) {
  const Study study = read_study(kHoles);
  SearchWish none = depth_wish();
  none.maximise.clear();
  EXPECT_THROW(study_text(study, none), InputError);
  SearchWish pinned = depth_wish();
  pinned.variables.erase(pinned.variables.begin());
  EXPECT_THROW(study_text(study, pinned), InputError);
  EXPECT_THROW(search_wish(Json{{"maximise", {"x"}}}), InputError);
}

// `optimize` that is ended by a signal leaves files, run.json too, and a journal without an end.
TEST(SearchDesk, FindsAnInterruptedSearchPaused) {
  const TemporaryFolder place;
  const std::filesystem::path folder = place.path() / "searches/001";
  std::filesystem::create_directories(folder);
  write_bytes(folder / "study.toml", study_text(read_study(kHoles), depth_wish()));
  write_bytes(folder / "origin.json", R"({"file":")" + kHoles + R"(","changes":[]})");
  write_bytes(folder / "journal", "");
  write_bytes(folder / "run.json", "{}");
  const SearchDesk desk(place.path(), "none", [] {});
  EXPECT_EQ(desk.json()["state"], "paused");
  EXPECT_EQ(desk.json()["total"], 12);
}

Response response_of(double modulation, double sampling) {
  Response out;
  out.driven = true;
  ResponsePoint point;
  point.modulation.value = modulation;
  point.modulation.parts.sampling = sampling;
  out.points = {point};
  return out;
}

constexpr double kUsual = 0.88, kDrift = 0.06, kUnusual = 0.5, kFloor = 0.012;

// Eq. studio.1, studio.2
TEST(FirstAnswer, IsCarriedByTheRatioOfTheLevelsNearby) {
  const Design at = read_design(kHoles);
  const Anchor anchor{at, response_of(0.5, 0.02), response_of(0.4, 0.01)};
  const Measured same = first_answer(response_of(0.5, 0.02), at, anchor).points[0].modulation;
  EXPECT_DOUBLE_EQ(same.value, 0.4);
  EXPECT_NEAR(same.se(), std::hypot(0.01, kFloor * 0.4), 1e-12);
  Design away = at;
  set_number(away, "texture.depth", 300e-9);  // half: ln 2 away
  const Measured moved = first_answer(response_of(0.25, 0.02), away, anchor).points[0].modulation;
  EXPECT_DOUBLE_EQ(moved.value, 0.2);
  const double drift =
      std::hypot(kFloor, (kDrift + kUnusual * std::log(kUsual / 0.8)) * std::log(2.0));
  EXPECT_NEAR(moved.se(), 0.2 * std::hypot(0.01 / 0.4, drift), 1e-12);
}

// Eq. studio.3
TEST(FirstAnswer, StandsAloneWithAWiderBandWhereNothingWasRefined) {
  const Design at = read_design(kHoles);
  const Measured alone =
      first_answer(response_of(0.5, 0.02), at, std::nullopt).points[0].modulation;
  EXPECT_DOUBLE_EQ(alone.value, kUsual * 0.5);
  EXPECT_NEAR(alone.se(), kUsual * std::hypot(0.02, 0.125 * 0.5), 1e-12);
}

TEST(FirstAnswer, IsCarriedByDesignsThatDifferInNumbersAlone) {
  const Design at = read_design(kHoles);
  const Anchor anchor{at, response_of(0.5, 0.02), response_of(0.4, 0.01)};
  EXPECT_NEAR(*distance(at, at), 0, 1e-15);
  Design near = at;
  set_number(near, "finger.load", 2 * at.finger.load);
  EXPECT_NEAR(*distance(at, near), std::log(2.0), 1e-12);
  EXPECT_TRUE(carries(anchor, near));
  Design pillars = at;
  pillars.texture = default_texture(2);
  EXPECT_EQ(distance(at, pillars), std::nullopt);
  EXPECT_FALSE(carries(anchor, pillars));
  Design off = at;
  off.drive.amplitude = 0;
  EXPECT_FALSE(carries(anchor, off));
  // Narrow holes are answered on other pixels: that ratio is another one.
  Design narrow = at;
  set_number(narrow, "texture.diameter", 0.5e-6);
  EXPECT_EQ(quick_fidelity(at).grid, 64);
  EXPECT_EQ(quick_fidelity(narrow).grid, 128);
  EXPECT_FALSE(carries(anchor, narrow));
}

// Eq. studio.4
TEST(FirstAnswer, DifferencesAreAsUnsureAsTheRatioBetweenThem) {
  const Design at = read_design(kHoles);
  const Anchor anchor{at, response_of(0.5, 0.02), response_of(0.4, 0.01)};
  Design a = at, b = at;
  set_number(a, "texture.depth", 300e-9);
  set_number(b, "texture.depth", 330e-9);
  EXPECT_NEAR(difference_drift(anchor, a, b),
              std::hypot(kFloor, (kDrift + kUnusual * std::log(kUsual / 0.8)) * std::log(1.1)),
              1e-12);
}

// A search whose program is this script; what became of it.
Json ended_search(const std::string& script) {
  const TemporaryFolder place;
  const std::filesystem::path program = place.path() / "program.sh";
  write_bytes(program, "#!/bin/sh\n# $1 optimize, $2 study, $3 --out, $4 folder\n" + script);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  SearchDesk desk(place.path(), program, [] {});
  const Study study = read_study(kHoles);
  desk.start({kHoles, {}}, study, depth_wish(), false);
  EXPECT_EQ(desk.json()["state"], "running");
  for (int i = 0; i < 500 && desk.json()["state"] == "running"; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return desk.json();
}

TEST(SearchDesk, AFinishedSearchShowsItsFront) {
  const Json json = ended_search(
      "echo looking\n[ $1$3 = optimize--out ] && [ $2 = $4/study.toml ] || exit 3\n"
      "echo '{}' > $4/run.json\n"
      "printf 'folder,mean\\nfront/01,0.5\\n\\nfront/02,0.4,more\\nfront/03\\n' > $4/pareto.csv\n"
      "exit 1\n");  // 1: with a remark
  EXPECT_EQ(json["state"], "finished") << json.dump();
  EXPECT_EQ(json["trouble"], "");
  EXPECT_EQ(json["number"], 1);
  EXPECT_EQ(json["folder"], "searches/001");
  EXPECT_EQ(json["confirmed"], Json::parse(R"([{"folder":"front/01","mean":"0.5"},
      {"folder":"front/02","mean":"0.4"},{"folder":"front/03"}])"));
}

TEST(SearchDesk, AFailedSearchSaysTheEndOfItsLog) {
  const Json json =
      ended_search("printf '%01000d' 7; echo no water\necho '{}' > $4/run.json\nexit 2\n");
  EXPECT_EQ(json["state"], "failed");
  EXPECT_EQ(json["trouble"], std::string(590, '0') + "7no water\n");
  EXPECT_EQ(json["confirmed"], Json::array());
}

// 128 and more: by a signal that it heard.
TEST(SearchDesk, ASearchThatWasEndedIsPaused) {
  EXPECT_EQ(ended_search("exit 128\n")["state"], "paused");
  EXPECT_EQ(ended_search("exit 127\n")["state"], "failed");
}

// Killed, or at its end without its results.
TEST(SearchDesk, ASearchWithoutAnEndFailed) {
  EXPECT_EQ(ended_search("echo '{}' > $4/run.json\nkill -9 $$\n")["state"], "failed");
  EXPECT_EQ(ended_search("exit 0\n")["state"], "failed");
}

}  // namespace
}  // namespace papilla::tests
