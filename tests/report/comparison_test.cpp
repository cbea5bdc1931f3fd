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
  EXPECT_NE(text.find("none: the same number"), std::string::npos) << text;  // equal frictions
  EXPECT_NE(text.find("| texture.depth | 300 nm | 300 nm |"), std::string::npos) << text;
  EXPECT_NE(text.find("| drive.amplitude | \"200 V\" | \"150 V\" |"), std::string::npos) << text;
  EXPECT_EQ(text.find("texture.period"), std::string::npos) << "the same in both";
}

// Of one seed, accuracy and finger the skins are common: ± of the difference is a bound, and one
// number beside itself is no difference. Of another seed both are independent.
TEST(Comparison, SaysWhetherBothRunsHadTheSameSkins) {
  const TemporaryFolder place;
  const std::string one = run(place, "one", "200 V", 0), two = run(place, "two", "200 V", 0);
  const std::string same = comparison_markdown(one, two);
  EXPECT_NE(same.find("is an upper bound"), std::string::npos) << same;
  EXPECT_EQ(same.find("are independent"), std::string::npos) << same;
  EXPECT_NE(same.find("| 0.400 ± 0.030 | 0.400 ± 0.030 | none: the same number |"),
            std::string::npos)
      << same;
  write_bytes(two + "/resolved.toml", read_bytes(two + "/resolved.toml") + "[search]\nseed = 7\n");
  const std::string other = comparison_markdown(one, two);
  EXPECT_NE(other.find("The runs are independent: their standard errors add in squares."),
            std::string::npos)
      << other;
  EXPECT_NE(other.find("| 0.000 ± 0.042, not told apart"), std::string::npos) << other;
}

// A scenario of weight 0 is no task. A run whose time is limited may have given up skins.
TEST(Comparison, SaysWhereTheNumbersOfSkinsMayDiffer) {
  const TemporaryFolder place;
  const std::string one = run(place, "one", "200 V", 0), two = run(place, "two", "200 V", 0);
  const std::string study = read_bytes(two + "/resolved.toml");
  const auto with = [&](const std::string& more) {
    write_bytes(two + "/resolved.toml", study + more);
    return comparison_markdown(one, two);
  };
  const auto weighted = [](const std::string& weight) {
    return "[[scenarios]]\nname = \"new\"\n[[scenarios]]\nname = \"worn\"\nweight = " + weight +
           "\nset = { \"surface.contact_angle\" = \"80 deg\" }\n";
  };
  const char *all = "judged on the same skins", *some = "judged on partly the same skins";
  for (const auto& [more, words] : {std::pair{weighted("0.0"), all},
                                    {weighted("1.0"), some},
                                    {std::string("[search]\ntime = \"30 min\"\n"), some}}) {
    const std::string said = with(more);
    EXPECT_NE(said.find(words), std::string::npos) << more << said;
    EXPECT_EQ(said.find("none: the same number") != std::string::npos, words == all) << more;
  }
}

// What cannot be compared has a sentence, or no heading.
TEST(Comparison, HasNoSectionWithoutText) {
  const TemporaryFolder place;
  const std::string one = run(place, "one", "200 V", 0), two = run(place, "two", "200 V", 0);
  Json told = Json::parse(read_bytes(two + "/run.json"));
  for (Json& f : told["finalists"]) f["folder"] = "";
  write_bytes(two + "/run.json", told.dump());
  EXPECT_NE(comparison_markdown(one, two).find("## Their fronts\n\ntwo has no front.\n"),
            std::string::npos);
  std::string study = read_bytes(two + "/resolved.toml");
  study.erase(study.find("minimise"));
  write_bytes(two + "/resolved.toml", study);
  told["finalists"] = Json::array();
  write_bytes(two + "/run.json", told.dump());
  EXPECT_EQ(comparison_markdown(one, two).find("Their fronts"), std::string::npos);
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
