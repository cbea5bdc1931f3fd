// Claims of the paper on rendering stiction (S).
#include "physics/drive/stiction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "claims/papers.h"
#include "physics/drive/network.h"

namespace papilla::claims {
namespace {

Judgement onset(FingerModel&) {
  const double stuck = onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 1);
  const double sliding = onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 0);
  const bool agrees = off_by(stuck, 0.09) < 1e-12 && off_by(sliding, 0.3) < 1e-12;
  return agrees_if(agrees, sliding, 0, "the formula; its limits alpha = 0 and 1");
}

Judgement slip_states(FingerModel&) {
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  const RubbingFinger finger;
  const auto limit = [](double current) { return 0.25 * (1 + 0.5 * square(current / 8e-3)); };
  int cycles = 0, wrong = 0;
  SlipState state = SlipState::Idle;
  for (const RubbingSample& at : rub(finger, options, limit)) {
    if (at.state == state) continue;
    const SlipState expected = state == SlipState::Stuck     ? SlipState::Partial
                               : state == SlipState::Partial ? SlipState::Full
                                                             : SlipState::Stuck;
    if (at.state != expected) ++wrong;
    state = at.state;
    if (state == SlipState::Full) ++cycles;
    if ((at.current > 0) == (state == SlipState::Full)) ++wrong;
  }
  return agrees_if(wrong == 0 && cycles >= 6, cycles, 0,
                   fmt::format("{} swipes of 1 s in order, {} wrong steps", cycles, wrong),
                   "with the defects of the printed pseudo-code mended");
}

Judgement stickiness(FingerModel&) {
  std::string text;
  double worst = 0;
  for (double n : {-0.69, -0.74}) {
    std::vector<double> friction, load, stimulus;
    for (int i = 0; i < 160; ++i) {
      const double current = 2 + i % 7;
      load.push_back(0.2 + 0.8 * std::fmod(0.618 * i, 1.0));
      stimulus.push_back(square(current));
      friction.push_back((0.1 + 0.01 * square(current)) * std::pow(load.back(), -n) *
                         (1 + 0.02 * std::sin(37.0 * i)));
    }
    const double found = stickiness_exponent(friction, load, stimulus);
    worst = std::max(worst, std::abs(found - n));
    text += fmt::format("{}{:.3f}", text.empty() ? "" : ", ", found);
  }
  return {Verdict::NotTestable, worst, 0, "planted exponents found: " + text,
          "needs subjects; the fit finds planted exponents within 0.02"};
}

Claim stiction_claim(const char* id, const char* statement, const char* band,
                     std::function<Judgement(FingerModel&)> judge) {
  return {id, "stiction rendering", statement, band, false, std::move(judge)};
}

}  // namespace

std::vector<Claim> stiction_claims() {
  return {
      stiction_claim("S1", "friction at onset: tau0 A + beta (W + F_e)(1 - alpha)", "formula",
                     onset),
      stiction_claim("S2", "stuck, partial, full slip; current only before full slip",
                     "every step in order", slip_states),
      stiction_claim("S3", "friction x load^n with n = -0.69 (force), -0.74 (judgement)", "-",
                     stickiness),
  };
}

}  // namespace papilla::claims
