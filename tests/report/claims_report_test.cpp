// Published claims and performance as tables: made-up numbers, each another.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "report/bench.h"
#include "report/claims.h"
#include "tests/report/same_json.h"

namespace papilla::tests {
namespace {

struct Judged {
  std::vector<Claim> claims{{"M1", "a, paper", "it rises", "above 2", true, {}},
                            {"P2", "b", "it \"falls\" | f", "ever", false, {}}};
  std::vector<ClaimResult> results{2};

  Judged() {
    results[0].claim = &claims[0];
    results[0].papilla = {Verdict::Agrees, 2.5, 0.125, "2.50 ± 0.13", "as read", 0.75};
    results[0].m3 = {Verdict::Differs, 1.5, 0.25, "1.50", "too low", 0.5};
    results[0].seconds = 1.5;
    results[1].claim = &claims[1];
    results[1].papilla = {
        Verdict::NotTestable, std::numeric_limits<double>::quiet_NaN(), 0, "x|y", "", std::nullopt};
    results[1].seconds = 2.25;
  }
};

TEST(ClaimsReport, ForPeopleEachClaimHasItsVerdicts) {
  const Judged j;
  EXPECT_EQ(claims_text(j.results),
            "M1    agrees             it rises\n"
            "      model: 2.50 ± 0.13\n"
            "      as read\n"
            "      all of it on 75 % of single patches\n"
            "      preset m3: differs, 1.50; too low\n"
            "P2    not testable       it \"falls\" | f\n"
            "      model: x|y\n"
            "2 claims: 1 agrees, 0 fitted, 0 differs, 0 paper inconsistent, 1 not testable; 3.75 "
            "s\n");
  EXPECT_EQ(claims_markdown(j.results, "mine"),
            "# Published claims and the model\n\nWritten by `papilla reproduce --out` for the "
            "finger \"mine\".\n\n2 claims: 1 agrees, 0 fitted, 0 differs, 0 paper inconsistent, 1 "
            "not testable.\n\n| id | paper says | agrees when | model | verdict | reason | single "
            "patches | preset m3 |\n|---|---|---|---|---|---|---|---|\n"
            "| M1 | it rises (a, paper) | above 2 | 2.50 ± 0.13 | agrees | as read | 75 % | "
            "differs: 1.50 |\n"
            "| P2 | it \"falls\" \\| f (b) | ever | x\\|y | not testable |  |  |  |\n");
}

TEST(ClaimsReport, ForProgramsEachNumberIsUnderItsName) {
  const Judged j;
  EXPECT_EQ(claims_csv(j.results),
            "id,source,statement,agrees when,verdict,value,se,model,reason,single patches,m3 "
            "verdict,m3 value,m3 se,m3 model,m3 reason,m3 single patches\n"
            "M1,\"a, paper\",it rises,above 2,agrees,2.5,0.125,2.50 ± 0.13,as read,0.75,differs,"
            "1.5,0.25,1.50,too low,0.5\n"
            "P2,b,\"it \"\"falls\"\" | f\",ever,not testable,,,x|y,,,,,,,,\n");
  expect_document(claims_json(j.results), {{"schema", 1},
                                           {"claims",
                                            {{{"id", "M1"},
                                              {"source", "a, paper"},
                                              {"paper", "it rises"},
                                              {"agrees_when", "above 2"},
                                              {"model", 2.5},
                                              {"se", 0.125},
                                              {"verdict", "agrees"},
                                              {"answer", "2.50 ± 0.13"},
                                              {"reason", "as read"},
                                              {"single_patches", 0.75},
                                              {"m3",
                                               {{"model", 1.5},
                                                {"se", 0.25},
                                                {"verdict", "differs"},
                                                {"answer", "1.50"},
                                                {"reason", "too low"},
                                                {"single_patches", 0.5}}},
                                              {"seconds", 1.5}},
                                             {{"id", "P2"},
                                              {"source", "b"},
                                              {"paper", "it \"falls\" | f"},
                                              {"agrees_when", "ever"},
                                              {"model", nullptr},
                                              {"se", 0},
                                              {"verdict", "not testable"},
                                              {"answer", "x|y"},
                                              {"reason", ""},
                                              {"single_patches", nullptr},
                                              {"seconds", 2.25}}}},
                                           {"counts",
                                            {{"agrees", 1},
                                             {"fitted", 0},
                                             {"differs", 0},
                                             {"paper inconsistent", 0},
                                             {"not testable", 1}}}});
}

TEST(BenchReport, ATargetIsMetOnItsSide) {
  const std::vector<BenchRow> rows{{"pairs, cold", "FFT pairs", 12.345678, 40, true, true},
                                   {"two threads", "", 1.5, 1.75, false, false},
                                   {"at it", "s", 2, 2, true, false}};
  EXPECT_EQ(bench_text(rows),
            "pairs, cold                                                     12.3 FFT pairs      "
            "<= 40     met\n"
            "two threads                                                      1.5                "
            ">= 1.75   not met\n"
            "at it                                                              2 s              "
            "<= 2      met\n");
  EXPECT_EQ(bench_csv(rows, "made up"),
            "# made up\nwhat,unit,measured,bound,target,exact,met\n"
            "pairs; cold,FFT pairs,12.35,at most,40,1,1\n"
            "two threads,,1.5,at least,1.75,0,0\n"
            "at it,s,2,at most,2,0,1\n");
  EXPECT_TRUE(bench_page(rows, "made up")
                  .ends_with("| what | measured | target | met |\n|---|---|---|---|\n"
                             "| pairs, cold | 12.3 FFT pairs | ≤ 40 FFT pairs | yes |\n"
                             "| two threads | 1.5 | ≥ 1.75 | no |\n"
                             "| at it | 2 s | ≤ 2 s | yes |\n"))
      << bench_page(rows, "made up");
  const auto json = nlohmann::json::parse(bench_json(rows));
  EXPECT_EQ(bench_json(rows), nlohmann::ordered_json::parse(bench_json(rows)).dump(2));
  EXPECT_EQ(json["schema"], 1);
  expect_same(json["rows"][0],
              {{"what", "pairs, cold"},
               {"unit", "FFT pairs"},
               {"measured", 12.345678},
               {"bound", "at most"},
               {"target", 40},
               {"exact", true},
               {"met", true}},
              "rows");
  EXPECT_EQ(json["rows"][1]["bound"], "at least");
  EXPECT_EQ(json["rows"][1]["met"], false);
  EXPECT_EQ(json["rows"].size(), 3u);
}

}  // namespace
}  // namespace papilla::tests
