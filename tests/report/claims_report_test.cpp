// Published claims and performance as tables: made-up numbers, each another.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "report/bench.h"
#include "report/claims.h"
#include "tests/support/golden.h"

namespace papilla::tests::claims_report_test {
namespace {

struct Judged {
  std::vector<Claim> claims{{"M1", "a, paper", "it rises", "above 2", true, {}, Basis::Finger},
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

TEST(ClaimsReport, GivesEachClaimItsVerdictsAndEachNumberItsName) {
  const Judged j;
  EXPECT_TRUE(is_golden(claims_text(j.results), "report/golden/claims.txt"));
  EXPECT_TRUE(is_golden(claims_markdown(j.results, "mine"), "report/golden/claims.md"));
  EXPECT_TRUE(is_golden(claims_csv(j.results), "report/golden/claims.csv"));
  EXPECT_TRUE(is_golden(claims_json(j.results), "report/golden/claims.json"));
}

TEST(BenchReport, MeetsATargetOnItsSide) {
  const std::vector<BenchRow> rows{{"pairs, cold", "FFT pairs", 12.345678, 40, true, true},
                                   {"two threads", "", 1.5, 1.75, false, false},
                                   {"at it", "s", 2, 2, true, false}};
  EXPECT_TRUE(is_golden(bench_text(rows), "report/golden/bench.txt"));
  EXPECT_TRUE(is_golden(bench_csv(rows, "made up"), "report/golden/bench.csv"));
  EXPECT_TRUE(is_golden(bench_page(rows, "made up"), "report/golden/bench.md"));
  EXPECT_TRUE(is_golden(bench_json(rows), "report/golden/bench.json"));
}

}  // namespace
}  // namespace papilla::tests::claims_report_test
