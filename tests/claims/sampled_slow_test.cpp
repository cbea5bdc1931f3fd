// The claims about the M3 model on a tenth of the skins, beside the committed table of all claims.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "base/files.h"
#include "claims/reproduce.h"
#include "design/design.h"
#include "tests/claims/csv_rows.h"
#include "tests/support/thorough.h"

namespace papilla::tests::sampled_slow_test {
namespace {

// "M9: flat 15 to 35 % 0.302 ± 0.0072; ..." -> every number with its error.
std::vector<std::pair<double, double>> with_errors(const std::string& text) {
  std::vector<std::pair<double, double>> out;
  const std::regex number("([-+]?[0-9][-+.e0-9]*) ± ([0-9][-+.e0-9]*)");
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it)
    out.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  return out;
}

// Which of the readings of a reason its claim shows: the place of the nearest number.
std::size_t shown(const std::string& model, const std::string& reason) {
  const auto one = with_errors(model), of = with_errors(reason);
  if (one.empty() || of.empty()) return 0;
  std::size_t at = 0;
  for (std::size_t k = 1; k < of.size(); ++k) {
    if (std::abs(of[k].first - one[0].first) < std::abs(of[at].first - one[0].first)) at = k;
  }
  return at;
}

TEST(Reproduce, FewerSkinsSayTheSameWithinTheirScatter) {
  std::map<std::string, std::vector<std::string>> table;
  const std::string path = std::string(PAPILLA_SOURCE_DIR) + "/results/reproduction/claims.csv";
  for (const auto& row : csv_rows(read_bytes(path))) table[row.at(0)] = row;
  ReproduceOptions options;
  const std::vector<std::string> ids = m3_claim_ids();
  const auto every = static_cast<std::size_t>(cases(5, 1));
  for (std::size_t k = 0; k < ids.size(); k += every) options.ids.push_back(ids[k]);
  options.finger = read_finger(std::string(PAPILLA_DESIGNS_DIR) + "/fingers/reference.toml");
  options.sampling.skins = 4;
  const double more = std::sqrt(SkinSampling{}.skins / 4.0);  // scatter of the mean
  std::size_t compared = 0;
  for (const ClaimResult& r : reproduce(options)) {
    const std::vector<std::string>& then = table.at(r.claim->id);
    const auto compare = [&](const Judgement& now, std::size_t at) {
      // A claim of several readings shows the one that is nearest to failing: another may be with
      // fewer skins.
      const bool same = shown(now.model, now.reason) == shown(then.at(at + 3), then.at(at + 4));
      const auto few = with_errors(same ? now.model + "; " + now.reason : now.reason),
                 all =
                     with_errors(same ? then.at(at + 3) + "; " + then.at(at + 4) : then.at(at + 4));
      ASSERT_EQ(few.size(), all.size()) << r.claim->id << ": " << now.reason;
      for (std::size_t k = 0; k < few.size(); ++k) {
        const double rounding = 0.01 * std::abs(all[k].first);
        EXPECT_NEAR(few[k].first, all[k].first, 6 * more * all[k].second + rounding)
            << r.claim->id << ", number " << k << ": " << now.reason;
        ++compared;
      }
      if (!same || then.at(at + 1).empty()) return;
      const double value = std::stod(then.at(at + 1)), se = then.at(at + 2).empty()
                                                                ? 0.02 * std::abs(value)
                                                                : std::stod(then.at(at + 2));
      EXPECT_NEAR(now.value, value, 6 * more * se) << r.claim->id;
    };
    compare(r.papilla, 4);
    if (r.claim->both_presets) compare(r.m3, 10);
  }
  EXPECT_GT(compared, 200u / every);
}

}  // namespace
}  // namespace papilla::tests::sampled_slow_test
