// Two runs beside each other, from folders written by hand: every number is known.
#include "report/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::comparison_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStudy = R"toml(schema_version = 1
base = "m3_samples/a3h350.toml"
[drive]
amplitude = "AMPLITUDE"
[design_space]
"texture.depth" = ["100 nm", "500 nm"]
[objective]
maximise = ["mean(modulation)"]
minimise = ["mean(friction)"]
)toml";

Json finalist(const std::string& folder, double depth, double modulation, double friction) {
  const Json judged{{"ok", true},
                    {"reason", ""},
                    {"values", {modulation, friction}},
                    {"errors", {0.03, 1e-3}},
                    {"violations", Json::array()}};
  return {{"folder", folder}, {"values", {depth}}, {"searched", judged}, {"confirmed", judged}};
}

// A run whose front has a modulation of 0.4 and one of 0.2, moved by `more`.
std::string run(const TemporaryFolder& place, const std::string& name, const std::string& amplitude,
                double more) {
  const auto folder = place.path() / name;
  std::filesystem::create_directory(folder);
  std::string study = kStudy;
  study.replace(study.find("AMPLITUDE"), 9, amplitude);
  write_bytes(folder / "resolved.toml", study);
  const Json out{{"interrupted", false},
                 {"evaluations", 20},
                 {"finalists",
                  {finalist("front/01", 300e-9, 0.4 + more, 0.060),
                   finalist("front/02", 200e-9, 0.2 + more, 0.040), finalist("", 1e-7, 0.1, 0.09)}},
                 {"design", "front/01"},
                 {"recommendation", "Build <design> 01."}};
  write_bytes(folder / "run.json", out.dump());
  return folder;
}

TEST(Comparison, StatesDifferencesWithTheErrorsOfBothRuns) {
  const TemporaryFolder place;
  const std::string text =
      comparison_markdown(run(place, "one", "200 V", 0), run(place, "two", "150 V", 0.1));
  // sqrt(2) times 0.03; told apart: 0.1 > 0.085.
  EXPECT_NE(
      text.find("| mean(modulation) | 0.400 ± 0.030 | 0.500 ± 0.030 | +0.100 ± 0.042, better |"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("not told apart"), std::string::npos) << text;  // equal frictions
  EXPECT_NE(text.find("| texture.depth | 300 nm | 300 nm |"), std::string::npos) << text;
  EXPECT_NE(text.find("| drive.amplitude | \"200 V\" | \"150 V\" |"), std::string::npos) << text;
  EXPECT_EQ(text.find("texture.period"), std::string::npos) << "the same in both";
}

TEST(Comparison, NamesEveryRunThatRecommendsNoneOfItsFront) {
  const TemporaryFolder place;
  const std::string one = run(place, "one", "200 V", 0), two = run(place, "two", "200 V", 0);
  const auto flat = [](const std::string& folder) {
    Json told = Json::parse(read_bytes(folder + "/run.json"));
    told["design"] = nullptr;
    write_bytes(folder + "/run.json", told.dump());
  };
  flat(two);
  EXPECT_NE(comparison_markdown(one, two).find("\ntwo recommends no design of its front."),
            std::string::npos);
  flat(one);
  EXPECT_NE(comparison_markdown(one, two).find("Neither one nor two recommends a design of its "
                                               "front."),
            std::string::npos);
}

TEST(Comparison, TellsHowMuchOfBothFrontsEachReaches) {
  const TemporaryFolder place;
  // The second is better by 0.1 everywhere, so it reaches all; of the first, with the reference at
  // (-0.17, 0.062), (0.23 x 0.002 + 0.03 x 0.020) of (0.33 x 0.002 + 0.13 x 0.020).
  const std::string text =
      comparison_markdown(run(place, "one", "200 V", 0), run(place, "two", "200 V", 0.1));
  const double share = (0.23 * 0.002 + 0.03 * 0.020) / (0.33 * 0.002 + 0.13 * 0.020);
  EXPECT_NE(
      text.find("one reaches " + std::to_string(std::lround(100 * share)) + " % and two 100 %"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("both runs have the same settings"), std::string::npos);
}

TEST(Comparison, IsAPageWithoutScriptsWhoseWordsAreInert) {
  const TemporaryFolder place;
  const std::string page =
      comparison_page(run(place, "one", "200 V", 0), run(place, "two", "150 V", 0.1));
  EXPECT_NE(page.find("Build &lt;design> 01."), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  // Frictions of 40 and 60 mN, with the unit and the scale of the tables.
  EXPECT_NE(page.find(">mean(friction) [mN]</text>"), std::string::npos);
  EXPECT_NE(page.find(">60</text>"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(Comparison, RefusesWhatIsNoFinishedRunOrWantsSomethingElse) {
  const TemporaryFolder place;
  const std::string good = run(place, "one", "200 V", 0), other = run(place, "two", "200 V", 0);
  EXPECT_NE(refusal_of([&] { comparison_markdown(good, place.path()); }).find("papilla optimize"),
            std::string::npos);
  const auto change = [&](const std::string& key, const Json& value) {
    Json told = Json::parse(read_bytes(other + "/run.json"));
    if (value.is_null())
      told.erase(key);
    else
      told[key] = value;
    write_bytes(other + "/run.json", told.dump());
    return refusal_of([&] { comparison_markdown(good, other); });
  };
  EXPECT_NE(change("interrupted", true).find("interrupted"), std::string::npos);
  change("interrupted", false);
  EXPECT_NE(change("finalists", Json::array({Json{{"values", Json::array()}}})).find("run.json"),
            std::string::npos);
  EXPECT_NE(change("finalists", nullptr).find("run the study again"), std::string::npos);
  std::string study = kStudy;
  study.replace(study.find("AMPLITUDE"), 9, "200 V");
  study.replace(study.find("mean(modulation)"), 16, "worst(modulation)");
  study.erase(study.find("minimise"));
  write_bytes(other + "/resolved.toml", study);
  EXPECT_NE(change("finalists", Json::array()).find("no objective in common"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::comparison_test
