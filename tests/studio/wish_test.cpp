// A wish on the page as a study file, and the first answer's band.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/files.h"
#include "config/describe.h"
#include "metrics/metrics.h"
#include "optim/journal.h"
#include "search/protocol.h"
#include "search/records.h"
#include "studio/files.h"
#include "studio/first_answer.h"
#include "studio/search_desk.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::wish_test {
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
  wish.variables = {{"texture.depth", "100 nm", "800 nm"}};
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
  ASSERT_EQ(made.variables.size(), 1u);
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
  EXPECT_EQ(made.objective.maximise, std::vector{parse_metric("worst(modulation)")});
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

TEST(SearchWish, LetsTheChosenKindsAndFingersCompete) {
  const Study study = read_study(PAPILLA_DESIGNS_DIR "/electroadhesive_glass/study.toml");
  const Json proposed = proposed_wish(study);
  EXPECT_EQ(proposed["known_fingers"], (Json{"reference", "smooth", "rough", "moist"}));
  EXPECT_EQ(proposed["fingers"], proposed["known_fingers"]);
  EXPECT_EQ(proposed["kinds"].size(), 5u);
  EXPECT_GT(proposed["known_kinds"].size(), 5u);
  SearchWish wish = depth_wish();
  wish.kinds = {"hole_array", "waves"};
  wish.fingers = {"smooth", "moist"};
  const Study made = reread(study_text(study, wish));
  ASSERT_EQ(made.population.size(), 2u);
  ASSERT_EQ(made.variables.size(), 2u);
  const auto kind = std::find_if(made.variables.begin(), made.variables.end(),
                                 [](const Variable& v) { return v.is_kind(); });
  ASSERT_NE(kind, made.variables.end());
  EXPECT_EQ(kind->choices.size(), 2u);
  wish.kinds = {"waves"};
  EXPECT_NE(refusal_of([&] { study_text(study, wish); }).find("waves alone is another kind"),
            std::string::npos);
}

TEST(SearchWish, IsShownAsThePageLeftIt) {
  const Study study = read_study(kHoles);
  const Json shown = proposed_wish(study, R"({"kinds":["waves"],"evaluations":37,"variables":[
      {"path":"texture.depth","low":"1 nm","high":"2 nm","vary":false},{"path":"texture.nothing","low":"1"}]})");
  EXPECT_EQ(shown["evaluations"], 37);
  EXPECT_EQ(shown["kinds"], Json{"waves"});
  EXPECT_EQ(shown["variables"].size(), proposed_wish(study)["variables"].size());
  for (const Json& v : shown["variables"]) {
    if (v["path"] != "texture.depth") continue;
    EXPECT_EQ(v["low"], "1 nm");
    EXPECT_EQ(v["vary"], false);
  }
  EXPECT_EQ(proposed_wish(study, "damaged"), proposed_wish(study));
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

// Not at the value that the design at hand happens to have.
TEST(SearchWish, PinsAVariableAtTheValueThatItIsGiven) {
  for (const char* high : {"200 nm", "0.2 um"}) {
    SearchWish wish = depth_wish();
    wish.variables.push_back({"texture.diameter", "1 um", "3 um"});
    wish.variables.front() = {"texture.depth", "200 nm", high};
    const Study made = reread(study_text(read_study(kHoles), wish));  // 600 nm deep
    ASSERT_EQ(made.variables.size(), 2u);
    EXPECT_EQ(made.variables[0].path, "texture.depth");
    ASSERT_EQ(made.variables[0].choices.size(), 1u);
    EXPECT_NEAR(made.variables[0].choices[0], 200e-9, 1e-18);
    EXPECT_TRUE(made.variables[1].choices.empty());
  }
}

TEST(SearchWish, RefusesWhatIsNoSearch) {
  const Study study = read_study(kHoles);
  SearchWish none = depth_wish();
  none.maximise.clear();
  EXPECT_THROW(study_text(study, none), InputError);
  SearchWish pinned = depth_wish();
  pinned.variables = {{"texture.period", "6 um", "6000 nm"}};
  EXPECT_THROW(study_text(study, pinned), InputError);
  SearchWish twice = depth_wish();
  twice.limits.push_back({"min_hole", "2 um"});
  EXPECT_NE(
      refusal_of([&] { study_text(study, twice); }).find("min_hole: stands twice: remove one"),
      std::string::npos);
  EXPECT_THROW(search_wish(Json{{"maximise", {"x"}}}), InputError);
}

// Half to twice of each number, as far as its key goes; what is usually searched is let vary.
TEST(SearchWish, ProposesHalfToTwiceOfWhatADesignHas) {
  const auto rows = [](const Study& study) {
    std::vector<std::string> out;
    const Json wish = proposed_wish(study);
    for (const Json& v : wish["variables"]) {
      EXPECT_EQ(v["excluding"], "");
      out.push_back(v["path"].get<std::string>() + " " + v["low"].get<std::string>() + " to " +
                    v["high"].get<std::string>() + (v["vary"] == true ? " *" : ""));
    }
    return out;
  };
  Study holes = read_study(kHoles);
  EXPECT_EQ(rows(holes),
            (std::vector<std::string>{
                "texture.period 3 um to 12 um", "texture.diameter 1.5 um to 6 um *",
                "texture.depth 300 nm to 1200 nm *", "texture.wall_angle 45 deg to 90 deg",
                "surface.contact_angle 25 deg to 100 deg", "drive.amplitude 100 V to 400 V"}));
  holes.variables = {{"texture.depth", "nm", 100e-9, 800e-9, {}}};  // its own come first, alone
  EXPECT_EQ(rows(holes),
            (std::vector<std::string>{
                "texture.depth 100 nm to 800 nm *", "texture.period 3 um to 12 um",
                "texture.diameter 1.5 um to 6 um", "texture.wall_angle 45 deg to 90 deg",
                "surface.contact_angle 25 deg to 100 deg", "drive.amplitude 100 V to 400 V"}));
}

TEST(SearchWish, ProposesTheGoalsAndLimitsOfItsStudy) {
  Study study = read_study(kHoles);
  Json wish = proposed_wish(study);
  EXPECT_EQ(wish["minimise"], Json({"variation(modulation)"}));
  EXPECT_EQ(wish["limits"], Json::array());
  EXPECT_EQ(wish["kinds"], Json::array());
  EXPECT_EQ(wish["evaluations"], 0);
  study.design.drive.amplitude = 0;
  wish = proposed_wish(study);
  EXPECT_EQ(wish["maximise"], Json({"mean(friction)"}));
  EXPECT_EQ(wish["minimise"], Json::array());
  study.objective.minimise = {parse_metric("worst(friction)")};
  study.constraints = {read_constraint("min_hole", 1.5e-6), read_constraint("aspect_ratio", 2)};
  study.search.evaluations = 40;
  wish = proposed_wish(study);
  EXPECT_EQ(wish["maximise"], Json::array());
  EXPECT_EQ(wish["minimise"], Json({"worst(friction)"}));
  EXPECT_EQ(wish["limits"], Json::parse(R"([{"name":"min_hole","limit":"1.5 um"},
      {"name":"aspect_ratio","limit":"2"}])"));
  EXPECT_EQ(wish["evaluations"], 40);
  bool known = false;
  for (const Json& limit : wish["known_limits"])
    known = known ||
            (limit["name"] == "min_hole" && limit["unit"] == "um" && limit["at_least"] == true);
  EXPECT_TRUE(known);
  int of_modulation = 0;  // felt, voltage_for
  for (const Json& metric : wish["metrics"]) {
    EXPECT_NE(metric["name"], "haze");
    // As the page writes it; "felt" alone is no metric.
    const bool at_modulation = metric["at_modulation"].get<bool>();
    const auto name = metric["name"].get<std::string>();
    EXPECT_NO_THROW(
        parse_own_metric("mean(" + name + (at_modulation ? "(modulation = 0.2)" : "") + ")"))
        << metric;
    of_modulation += at_modulation;
  }
  EXPECT_EQ(of_modulation, 2);
}

// Of a limit on a metric, which no list has, the page knows its side, unit and meaning.
TEST(SearchWish, TellsWhatALimitOnAMetricIs) {
  Study study = read_study(kHoles);
  study.constraints = {read_constraint("worst(voltage_for(modulation = 0.5))", 150),
                       read_constraint("worst(modulation)", 0.3)};
  // And of one that the page has kept; what is none is left alone.
  const Json wish = proposed_wish(study), kept = proposed_wish(study, R"j({"limits":[
      {"name":"worst(friction)","limit":"0.5 N"},{"name":"nothing","limit":"1"},{"name":3},4]})j");
  const auto known = [](const Json& of, const std::string& name) {
    for (const Json& limit : of["known_limits"]) {
      if (limit["name"] == name) return limit;
    }
    return Json();
  };
  const std::string voltage = wish["limits"][0]["name"];
  ASSERT_TRUE(known(wish, voltage).is_object()) << wish["known_limits"];
  EXPECT_EQ(known(wish, voltage)["at_least"], false);
  EXPECT_EQ(known(wish, voltage)["unit"], "V");
  EXPECT_NE(known(wish, voltage)["doc"], "");
  EXPECT_EQ(known(wish, "worst(modulation)")["at_least"], true);
  EXPECT_EQ(known(kept, "worst(friction)")["at_least"], false);
  EXPECT_TRUE(known(kept, "nothing").is_null());
}

TEST(SearchWish, IsReadAsThePageSendsIt) {
  const Json sent = Json::parse(R"({"variables":[{"path":"a","low":"1 nm","high":"2 nm"},
      {"path":"b","low":"3","high":"4","excluding":"3.2 to 3.4"}],"kinds":["x","y"],
      "maximise":["m"],"minimise":["n","o"],"limits":[{"name":"p","limit":"5"}],"evaluations":7})");
  const SearchWish wish = search_wish(sent);
  ASSERT_EQ(wish.variables.size(), 2u);
  EXPECT_EQ(wish.variables[0].path + wish.variables[0].low + wish.variables[0].high, "a1 nm2 nm");
  EXPECT_EQ(wish.variables[0].excluding, "");
  EXPECT_EQ(wish.variables[1].excluding, "3.2 to 3.4");
  EXPECT_EQ(wish.kinds, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(wish.maximise, std::vector<std::string>{"m"});
  EXPECT_EQ(wish.minimise, (std::vector<std::string>{"n", "o"}));
  ASSERT_EQ(wish.limits.size(), 1u);
  EXPECT_EQ(wish.limits[0].name + wish.limits[0].limit, "p5");
  EXPECT_EQ(wish.evaluations, 7);
  EXPECT_EQ(search_wish(Json{{"variables", Json::array()}}).evaluations, 0);
  const auto refused = [&](const char* key, const Json& value) {
    Json other = sent;
    other[key] = value;
    return refusal_of([&] { search_wish(other); });
  };
  const std::string why =
      "a search needs variables, each with path, low and high, and an objective";
  EXPECT_EQ(refused("variables", 3), why);
  EXPECT_EQ(refused("variables", Json::parse(R"([{"path":"a","low":"1"}])")), why);
  EXPECT_EQ(refused("variables", Json::parse(R"([{"path":"a","low":1,"high":2}])")), why);
  EXPECT_EQ(refused("limits", Json::parse(R"([{"name":"p"}])")), why);
  EXPECT_EQ(refused("evaluations", "many"), why);
  EXPECT_EQ(refused("maximise", "m"), why);
  for (const char* key : {"kinds", "maximise", "minimise"}) {
    EXPECT_EQ(refused(key, std::vector<std::string>(40, "x")), "");
    EXPECT_EQ(refused(key, std::vector<std::string>(41, "x")),
              std::string(key) + ": too many of them");
  }
}

TEST(SearchWish, KeepsWhatThePageDoesNotSay) {
  const Study study = reread(study_text(read_study(kHoles), depth_wish()));
  SearchWish wish;
  wish.variables = {{"surface.contact_angle", "30 deg", "80 deg"}};
  wish.minimise = {"mean(modulation)"};
  const Study made = reread(study_text(study, wish));
  EXPECT_TRUE(made.objective.maximise.empty());
  EXPECT_EQ(made.objective.minimise, std::vector{parse_metric("mean(modulation)")});
  EXPECT_TRUE(made.constraints.empty());
  EXPECT_EQ(made.search.evaluations, 12);  // 0: as it was
  wish.evaluations = 1;
  wish.kinds = {"hole_array"};  // one is no choice
  const Study one = reread(study_text(study, wish));
  EXPECT_EQ(one.search.evaluations, 1);
  ASSERT_EQ(one.variables.size(), 1u);
  EXPECT_EQ(one.variables[0].path, "surface.contact_angle");
  wish.kinds = {"hole_array", "pillar_array"};
  const Study two = reread(study_text(study, wish));
  ASSERT_EQ(two.variables.size(), 2u);
  EXPECT_TRUE(two.variables[0].is_kind() || two.variables[1].is_kind());
  EXPECT_EQ(proposed_wish(two)["kinds"], Json({"hole_array", "pillar_array"}));
}

// A study of depths at two angles that aims at a modulation.
Study choosing_study(const std::string& objective = "") {
  return reread(
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[design_space]\n"
      "\"texture.depth\" = [\"100 nm\", \"800 nm\"]\n"
      "\"surface.contact_angle\" = { choice = [\"30 deg\", \"80 deg\"] }\n"
      "[objective]\ntarget = { modulation = 0.8 }\n" +
      objective);
}

TEST(SearchWish, KeepsChoicesOfTheStudyThatItDoesNotName) {
  const Study study = choosing_study();
  EXPECT_EQ(proposed_wish(study)["kept"],
            Json({"surface.contact_angle 30 deg, 80 deg", "target modulation = 0.8"}));
  EXPECT_EQ(proposed_wish(read_study(kHoles))["kept"], Json::array());
  const auto variables = [&](const std::vector<VariableWish>& wanted) {
    SearchWish wish = depth_wish();
    wish.variables = wanted;
    return reread(study_text(study, wish)).variables;
  };
  const VariableWish depth{"texture.depth", "100 nm", "800 nm"};
  EXPECT_EQ(variables({depth}), study.variables);
  EXPECT_EQ(variables({}), std::vector{study.variables[1]});
  const std::vector<Variable> pinned =
      variables({depth, {"surface.contact_angle", "50 deg", "50 deg"}});
  ASSERT_EQ(pinned.size(), 2u);
  EXPECT_EQ(pinned[1].choices.size(), 1u);
  const std::vector<Variable> ranges =
      variables({depth, {"surface.contact_angle", "40 deg", "60 deg"}});
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_TRUE(ranges[1].choices.empty());
}

TEST(SearchWish, KeepsTargetsOfTheStudyUnlessAnotherGoalIsOfTheirMetric) {
  const Study study = choosing_study(), steady = choosing_study("minimise = \"std(modulation)\"\n");
  EXPECT_EQ(proposed_wish(study)["maximise"], Json::array());
  const auto objective = [](const Study& of, std::vector<std::string> maximise,
                            std::vector<std::string> minimise) {
    SearchWish wish = depth_wish();
    wish.maximise = std::move(maximise), wish.minimise = std::move(minimise);
    return reread(study_text(of, wish)).objective;
  };
  EXPECT_EQ(objective(study, {}, {}), study.objective);
  EXPECT_EQ(objective(steady, {}, {"std(modulation)"}), steady.objective);
  EXPECT_EQ(objective(study, {}, {"mean(friction)"}).targets, study.objective.targets);
  EXPECT_TRUE(objective(study, {"mean(modulation)"}, {}).targets.empty());
}

TEST(SearchWish, AnExcludedRangeHasItsUnitOnceOrTwice) {
  const auto excluded = [](const char* text) {
    SearchWish wish = depth_wish();
    wish.variables.front().excluding = text;
    const Study made = reread(study_text(read_study(kHoles), wish));
    EXPECT_EQ(made.variables.at(0).excluded.size(), 1u);
    const Excluded e = made.variables.at(0).excluded.at(0);
    return std::pair(std::lround(1e9 * e.from), std::lround(1e9 * e.to));
  };
  EXPECT_EQ(excluded("300 to 400 nm"), std::pair(300l, 400l));
  EXPECT_EQ(excluded("300 nm to 0.4 um"), std::pair(300l, 400l));
  EXPECT_EQ(excluded("0.3 to 0.4 um"), std::pair(300l, 400l));
  for (const char* wrong : {"300 nm", "300 nm to", "to 400 nm", "300-400 nm", "x to 400 nm"}) {
    SearchWish wish = depth_wish();
    wish.variables.front().excluding = wrong;
    EXPECT_THROW(study_text(read_study(kHoles), wish), InputError) << wrong;
  }
}

// A search of two designs that were judged, one that failed and one too weak, left in its middle.
class LeftSearch : public ::testing::Test {
 protected:
  LeftSearch() {
    std::filesystem::create_directories(folder_);
    SearchWish wish = depth_wish();
    wish.limits.push_back({"oxide_breakdown_margin", "1"});  // asks for an evaluation
    write_bytes(folder_ / "study.toml", study_text(read_study(kHoles), wish));
    write_bytes(folder_ / "origin.json",
                R"({"file":")" + kHoles + R"(","changes":[["texture.depth","500 nm"]]})");
    journal_ = head();
    add(Stage::Draft, 0.1);
    add(Stage::Search, 0.5, judged(-0.3));
    add(Stage::Search, 0, judged(-0.6, 0.5));
    Outcome failed;
    failed.reason = "crashed";
    add(Stage::Search, 1, failed);
    add(Stage::Search, 0.2, judged(-0.4));
  }
  static Outcome judged(double objective, double constraint = -1) {
    Outcome out;
    out.ok = true, out.objectives = {objective}, out.constraints = {constraint};
    return out;
  }
  // Of its study, or of one with other lines.
  std::string head(const std::string& without = "") const {
    std::string text = read_bytes(folder_ / "study.toml");
    if (!without.empty()) text.erase(text.find(without), text.find('\n', text.find(without)));
    const Study study = reread(text);
    return "papilla-journal 2 " + search::journal_key(StudyProblem(study)) + "\n";
  }
  static std::string record(Stage stage, const Point& unit, const std::string& payload) {
    TaskRequest request;
    request.stage = stage, request.unit = unit;
    return journal_line({encode(request), payload});
  }
  static std::string line(Stage stage, double unit, const Outcome& outcome) {
    return record(stage, {unit}, encode(search::Judgement{outcome, 0}));
  }
  void add(Stage stage, double unit, const Outcome& outcome) {
    journal_ += line(stage, unit, outcome);
  }
  // The answer of a task: its one objective at each humidity.
  void add(Stage stage, double unit) {
    TaskAnswer answer;
    const std::size_t humidities =
        read_study(folder_ / "study.toml").design.environment.relative_humidity.size();
    answer.objectives = {{0.3, 0.01, std::vector<double>(humidities, 0.3)}};
    journal_ += record(stage, {unit}, encode(answer));
  }
  Json json() const {
    write_bytes(folder_ / "journal", journal_);
    return SearchDesk(place_.path(), "none", [] {}).json();
  }

  const TemporaryFolder place_;
  const std::filesystem::path folder_ = place_.path() / "searches/003";
  std::string journal_;
};

TEST_F(LeftSearch, ShowsWhatWasFound) {
  const std::string next = line(Stage::Search, 0.3, judged(-0.5));
  journal_ += next.substr(0, next.size() - 2);  // still being written
  Json left = json();
  EXPECT_EQ(left["points"],
            Json::parse(R"([{"values":["450 nm"],"objectives":[0.3],"ok":true,"feasible":true},
      {"values":["100 nm"],"objectives":[0.6],"ok":true,"feasible":false},
      {"values":["800 nm"],"objectives":[],"ok":false,"feasible":false},
      {"values":["240 nm"],"objectives":[0.4],"ok":true,"feasible":true}])"));
  left.erase("points");
  EXPECT_EQ(left,
            Json::parse(R"json({"state":"paused","number":3,"numbers":[3],"folder":"searches/003",
      "stage":"search","done":4,"total":12,"trouble":"","progress":null,
      "variables":[{"path":"texture.depth","unit":"nm"}],"fingers":["reference"],
      "objectives":[{"name":"mean(modulation)","maximise":true,"scale":1.0,"unit":""}],
      "worth":{"scale":1.0,"unit":""},"front":[3],"confirmed":[],
      "recommended":{"design":null,"words":""}})json"));
}

// Values are told in SI, as in its files: with them how people read them.
TEST_F(LeftSearch, TellsTheUnitsOfWhatIsWanted) {
  std::string text = read_bytes(folder_ / "study.toml");
  const std::string wanted = "\"mean(modulation)\"";
  ASSERT_NE(text.find(wanted), std::string::npos) << text;
  text.replace(text.find(wanted), wanted.size(), "\"mean(friction)\"");
  write_bytes(folder_ / "study.toml", text);
  journal_ = head();
  EXPECT_EQ(json()["objectives"], Json::parse(R"json([{"name":"mean(friction)","maximise":true,
      "scale":1e3,"unit":"mN"}])json"));
  EXPECT_EQ(json()["worth"], Json::parse(R"({"scale":1e3,"unit":"mN"})"));
}

TEST_F(LeftSearch, SaysHowFarItCame) {
  for (const auto& [stage, name] : {std::pair{Stage::Narrow, "narrow"},
                                    {Stage::Confirm, "confirm"},
                                    {Stage::Stability, "check"},
                                    {Stage::Sensitivity, "check"},
                                    {Stage::Draft, "search"}}) {
    add(stage, 0.2);
    EXPECT_EQ(json()["stage"], name) << json()["trouble"];
    EXPECT_EQ(json()["done"], 4);
    EXPECT_EQ(json()["state"], "paused");
  }
  journal_ += record(Stage::Done, {0}, "");
  EXPECT_EQ(json()["state"], "paused");  // its results are not there
  write_bytes(folder_ / "pareto.csv", "folder,mean\nfront/01,0.4\n");
  EXPECT_EQ(json()["confirmed"], Json::array());
  write_bytes(folder_ / "run.json", "{}");
  EXPECT_EQ(json()["state"], "finished");
  EXPECT_EQ(json()["confirmed"], Json::parse(R"([{"folder":"front/01","mean":"0.4"}])"));
  // The newest is shown; what is no search is passed over.
  std::filesystem::create_directories(place_.path() / "searches/007");
  EXPECT_EQ(json()["number"], 3);
  write_bytes(place_.path() / "searches/007/study.toml", "nothing");
  EXPECT_EQ(json()["number"], 7);
  EXPECT_EQ(json()["state"], "failed");
}

TEST_F(LeftSearch, IsShownBesideEarlierOnes) {
  write_bytes(folder_ / "journal", journal_);
  std::filesystem::copy(folder_, place_.path() / "searches/005");
  SearchDesk desk(place_.path(), "none", [] {});
  EXPECT_EQ(desk.json()["number"], 5);
  EXPECT_EQ(desk.json()["numbers"], Json({3, 5}));
  desk.show(3);
  EXPECT_EQ(desk.json()["folder"], "searches/003");
  EXPECT_EQ(desk.json()["done"], 4);
  EXPECT_EQ(desk.json()["state"], "paused");
  EXPECT_EQ(refusal_of([&] { desk.show(4); }), "there is no search 004");
  EXPECT_EQ(desk.json()["number"], 3);
}

// As far as a run that is resumed would go.
TEST_F(LeftSearch, EndsAtTheFirstDamagedRecord) {
  journal_ += "damaged\n" + line(Stage::Search, 0.3, judged(-0.5));
  EXPECT_EQ(json()["done"], 4);
  EXPECT_EQ(json()["state"], "paused");
}

// What no run of the study wrote is said, not drawn: points without objectives, or with a hundred
// thousand, would be read beyond their ends.
TEST_F(LeftSearch, RefusesRecordsThatNoRunOfItsStudyWrote) {
  const std::string sound = journal_;
  const auto many = [](std::size_t objectives, std::size_t constraints) {
    Outcome out;
    out.ok = true;
    out.objectives.assign(objectives, -0.3);
    out.constraints.assign(constraints, -1);
    return encode(search::Judgement{out, 0});
  };
  Outcome nan = judged(std::nan(""));
  TaskAnswer short_answer;
  short_answer.objectives = {{0.3, 0.01, {0.3}}};
  for (const std::string& hostile :
       {record(Stage::Search, {0.5}, many(0, 1)), record(Stage::Search, {0.5}, many(9, 1)),
        record(Stage::Search, {0.5}, many(100000, 1)), record(Stage::Search, {0.5}, many(1, 0)),
        record(Stage::Search, {0.5}, many(1, 3)), record(Stage::Search, {}, many(1, 1)),
        record(Stage::Search, {0.5, 0.5}, many(1, 1)),
        record(Stage::Search, {std::nan("")}, many(1, 1)),
        record(Stage::Search, {0.5}, encode(search::Judgement{nan, 0})),
        record(Stage::Search, {0.5}, ""), record(Stage::Search, {0.5}, encode(short_answer)),
        record(Stage::Confirm, {0.5}, encode(short_answer)),
        record(Stage::Confirm, {0.5}, encode(TaskAnswer{})),
        record(Stage::Confirm, {0.5}, many(1, 1)), record(Stage::Done, {0}, "more"),
        journal_line({"no request", many(1, 1)})}) {
    journal_ = sound + hostile;
    const Json left = json();
    EXPECT_EQ(left["state"], "failed") << hostile.substr(0, 200);
    EXPECT_NE(left["trouble"].get<std::string>().find("holds what no run of its study wrote"),
              std::string::npos);
    EXPECT_EQ(left["done"], 4);
  }
}

// Of another study, though its records look alike: what it says of one objective is none of
// another.
TEST_F(LeftSearch, RefusesTheJournalOfAnotherStudy) {
  const std::string records = journal_.substr(head().size());
  journal_ = head("oxide_breakdown_margin") + records;
  EXPECT_EQ(json()["state"], "failed");
  EXPECT_NE(json()["trouble"].get<std::string>().find("written for another study"),
            std::string::npos);
  EXPECT_EQ(json()["done"], 0);
  journal_ = head() + records;
  EXPECT_EQ(json()["state"], "paused");
}

// A stranger's folder: neither its searches nor a file of one is behind a link.
TEST_F(LeftSearch, FollowsNoLink) {
  const TemporaryFolder outside;
  std::filesystem::rename(folder_, outside.path() / "search");
  std::filesystem::create_directory_symlink(outside.path() / "search", folder_);
  write_bytes(outside.path() / "search/journal", journal_);
  EXPECT_EQ(SearchDesk(place_.path(), "none", [] {}).json()["state"], "none");
  std::filesystem::remove(folder_);
  std::filesystem::rename(outside.path() / "search", folder_);
  std::filesystem::rename(folder_ / "journal", outside.path() / "journal");
  std::filesystem::create_symlink(outside.path() / "journal", folder_ / "journal");
  EXPECT_EQ(SearchDesk(place_.path(), "none", [] {}).json()["done"], 0);
}

TEST_F(LeftSearch, GivesItsDesigns) {
  write_bytes(folder_ / "journal", journal_);
  const SearchDesk desk(place_.path(), "none", [] {});
  EXPECT_EQ(desk.design_of(0), (Draft{kHoles, {{"texture.depth", "450 nm"}}}));
  EXPECT_EQ(desk.design_of(3), (Draft{kHoles, {{"texture.depth", "240 nm"}}}));
  EXPECT_THROW(desk.design_of(4), InputError);
  EXPECT_THROW(desk.design_of("front/01"), InputError);
  std::filesystem::create_directories(folder_ / "front/01");
  write_design((folder_ / "front/01/design.toml").string(),
               read_design(kHoles, {"texture.depth=300 nm", "drive.amplitude=100 V"}));
  EXPECT_EQ(desk.design_of("front/01"),
            (Draft{kHoles, {{"texture.depth", "300 nm"}, {"drive.amplitude", "100 V"}}}));
  EXPECT_THROW(desk.design_of("front/../front/01"), InputError);
}

// A design of two parts that a search began with, and one on its front that has one of them.
class FewerParts : public ::testing::Test {
 protected:
  explicit FewerParts(const std::string& sections = "") {
    std::filesystem::create_directories(folder_ / "front/01");
    write_bytes(file_,
                "schema_version = 1\nbase = \"m3_samples/common.toml\"\n\n[texture]\n"
                "type = \"stack\"\n\n[[texture.parts]]  # coarse\ntype = \"waves\"\n"
                "period = \"6 um\"\ndepth = \"100 nm\"\n\n[[texture.parts]]\n"
                "type = \"waves\"\nperiod = \"3 um\"\ndepth = \"50 nm\"\n\n"
                "# dry\n[drive]\namplitude = \"120 V\"\n" +
                    sections);
    one_ = read_design(file_);
    std::vector<Texture>* parts = roles(one_.texture).parts;
    parts->pop_back();
    write_design((folder_ / "front/01/design.toml").string(), one_);
    write_bytes(folder_ / "study.toml", study_text(read_study(kHoles), depth_wish()));
    write_bytes(folder_ / "origin.json", Json{{"file", file_}, {"changes", Json::array()}}.dump());
    write_bytes(folder_ / "journal", "");
  }

  const TemporaryFolder place_;
  const std::filesystem::path folder_ = place_.path() / "searches/001";
  const std::string file_ = (place_.path() / "two.toml").string();
  Design one_;
};

// The part that is not there is neither shown nor saved.
TEST_F(FewerParts, AreThoseOfThePickedDesign) {
  const SearchDesk desk(place_.path(), "none", [] {});
  const Draft draft = desk.design_of("front/01");
  ASSERT_EQ(draft.changes.size(), 1u);
  EXPECT_EQ(draft.changes.front().path, "texture.parts");
  EXPECT_EQ(study_of(draft).design, one_);
  const Files files(place_.path());
  files.save(draft, study_of(draft), files.target("two.toml", true));
  EXPECT_EQ(read_design(file_), one_);
  EXPECT_NE(read_bytes(file_).find("\n# dry\n[drive]\namplitude = \"120 V\"\n"), std::string::npos)
      << read_bytes(file_);
}

class FewerPartsOfAStudy : public FewerParts {
 protected:
  FewerPartsOfAStudy()
      : FewerParts(
            "\n[design_space]\n\"texture.levels\" = { choice = [1, 2] }\n\n[objective]\n"
            "maximise = \"mean(modulation)\"\n") {}
};

// A study that varies two parts is none with one of them.
TEST_F(FewerPartsOfAStudy, AreRefusedWithTheFileThatHasThem) {
  const SearchDesk desk(place_.path(), "none", [] {});
  const std::string why = refusal_of([&] { desk.design_of("front/01"); });
  EXPECT_TRUE(why.starts_with("no changes of two.toml make this design: ")) << why;
  EXPECT_NE(why.find("open searches/001/front/01/design.toml itself"), std::string::npos) << why;
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

// Its design has the name that its folder, its report and its lab have.
TEST(SearchDesk, AFinishedSearchSaysWhatIsRecommended) {
  const std::string run =
      R"(echo '{"design": "front/02", "recommendation": "Build design 02."}' > $4/run.json; exit 0)";
  EXPECT_EQ(ended_search(run)["recommended"],
            (Json{{"design", "front/02"}, {"words", "Build design 02."}}));
  for (const char* other :
       {R"(echo '{"design": null, "recommendation": ""}' > $4/run.json; exit 0)",
        "echo '{' > $4/run.json; exit 0", "exit 2"})
    EXPECT_EQ(ended_search(other)["recommended"], (Json{{"design", nullptr}, {"words", ""}}))
        << other;
}

// As it was before the studio went: there is nothing to resume.
TEST(SearchDesk, FindsASearchThatWasRefusedFailed) {
  const TemporaryFolder place;
  const std::filesystem::path folder = place.path() / "searches/001";
  std::filesystem::create_directories(folder);
  write_bytes(folder / "study.toml", study_text(read_study(kHoles), depth_wish()));
  write_bytes(folder / "origin.json", R"({"file":")" + kHoles + R"(","changes":[]})");
  const auto left_with = [&](const std::string& log) {
    write_bytes(folder / "log.txt", log);
    SearchDesk desk(place.path(), "none", [] {});
    return desk.json();
  };
  const std::string log = "expected: 3 min\nerror: constraints: no texture keeps it\n";
  EXPECT_EQ(left_with(log)["state"], "failed");
  EXPECT_EQ(left_with(log)["trouble"], "error: constraints: no texture keeps it\n");
  EXPECT_EQ(left_with("expected error: 3 %\n")["state"], "paused");  // it had not begun
  write_bytes(folder / "journal", "");
  EXPECT_EQ(left_with(log)["state"], "paused");  // what it found can be gone on with
}

TEST(SearchDesk, AFailedSearchSaysTheEndOfItsLog) {
  const Json json =
      ended_search("printf '%01000d' 7; echo no water\necho '{}' > $4/run.json\nexit 2\n");
  EXPECT_EQ(json["state"], "failed");
  EXPECT_EQ(json["trouble"], std::string(590, '0') + "7no water\n");
  EXPECT_EQ(json["confirmed"], Json::array());
}

// While its search runs the page has the share of the whole run that is done, and the time left.
TEST(SearchDesk, ShowsTheProgressOfItsSearch) {
  const TemporaryFolder place;
  const std::filesystem::path program = place.path() / "program.sh",
                              folder = place.path() / "searches/001";
  write_bytes(program,
              "#!/bin/sh\necho '{\"seconds_left\": 480, \"share\": 0.25}' > $4/.progress.json\n"
              "while [ ! -e $4/go ]; do sleep 0.02; done\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  SearchDesk desk(place.path(), program, [] {});
  desk.start({kHoles, {}}, read_study(kHoles), depth_wish(), false);
  const auto wait_while = [&](const auto& holds) {
    for (int i = 0; i < 3000 && holds(desk.json()); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return desk.json();
  };
  const Json running = wait_while([](const Json& json) { return json["progress"].is_null(); });
  EXPECT_EQ(running["progress"]["share"], 0.25);
  EXPECT_EQ(running["progress"]["seconds_left"], 480);
  write_bytes(folder / "go", "");
  const Json ended = wait_while([](const Json& json) { return json["state"] == "running"; });
  EXPECT_TRUE(ended["progress"].is_null());
}

// A search that waits until it is told to end; each start leaves its words.
TEST(SearchDesk, APausedSearchWasAskedToEndAndGoesOnFromItsJournal) {
  const TemporaryFolder place;
  const std::filesystem::path program = place.path() / "program.sh";
  write_bytes(program,
              "#!/bin/sh\ntrap 'echo heard >> $4/heard; kill $!; exit 143' TERM\n"
              ": > $4/journal\necho \"$@\" >> $4/words\nwhile :; do sleep 1 & wait $!; done\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  SearchDesk desk(place.path(), program, [] {});
  EXPECT_THROW(desk.pause(), InputError);
  EXPECT_THROW(desk.resume(), InputError);
  EXPECT_THROW(desk.stop(), InputError);
  desk.start({kHoles, {}}, read_study(kHoles), depth_wish(), false);
  const std::filesystem::path folder = place.path() / "searches/001";
  const auto wait_for_words = [&](std::size_t lines) {
    const auto seen = [&] {
      if (!std::filesystem::exists(folder / "words")) return false;
      const std::string text = read_bytes(folder / "words");
      return std::count(text.begin(), text.end(), '\n') == static_cast<std::ptrdiff_t>(lines);
    };
    for (int i = 0; i < 500 && !seen(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(seen());
  };
  wait_for_words(1);
  EXPECT_THROW(desk.stop(), InputError);  // nothing was judged: it goes on
  EXPECT_EQ(desk.json()["state"], "running");
  EXPECT_FALSE(std::filesystem::exists(folder / "heard"));
  EXPECT_THROW(desk.resume(), InputError);
  EXPECT_THROW(desk.start({kHoles, {}}, read_study(kHoles), depth_wish(), false), InputError);
  desk.pause();
  EXPECT_EQ(desk.json()["state"], "paused");
  EXPECT_EQ(read_bytes(folder / "heard"), "heard\n");
  EXPECT_THROW(desk.pause(), InputError);
  EXPECT_THROW(desk.stop(), InputError);  // nothing was judged
  desk.resume();
  EXPECT_EQ(desk.json()["state"], "running");
  wait_for_words(2);
  // Steered: the running one ends, the next has a folder of its own.
  desk.start({kHoles, {{"texture.depth", "500 nm"}}}, read_study(kHoles, {"texture.depth=500 nm"}),
             depth_wish(), true);
  EXPECT_EQ(read_bytes(folder / "heard"), "heard\nheard\n");
  const std::string words =
      "optimize " + (folder / "study.toml").string() + " --out " + folder.string();
  EXPECT_EQ(read_bytes(folder / "words"), words + "\n" + words + " --resume\n");
  EXPECT_EQ(desk.json()["number"], 2);
  EXPECT_EQ(desk.json()["folder"], "searches/002");
  EXPECT_EQ(Json::parse(read_bytes(place.path() / "searches/002/origin.json")),
            Json::parse(R"({"file":")" + kHoles + R"(","changes":[["texture.depth","500 nm"]]})"));
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
}  // namespace papilla::tests::wish_test
