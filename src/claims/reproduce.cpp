#include "claims/reproduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/text.h"

namespace papilla {
namespace {

std::set<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::set<std::string> out;
  for (std::string word; stream >> word;) out.insert(word);
  return out;
}

// Throws InputError for an id that no claim has.
void check_ids(const std::vector<std::string>& ids) {
  std::vector<std::string> known;
  for (const Claim& claim : claims()) known.push_back(claim.id);
  for (const std::string& id : ids) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    const std::string near = nearest_name(id, known);
    throw InputError(fmt::format("no claim `{}`{}; known: {}", id,
                                 near.empty() ? "" : ", did you mean `" + near + "`?",
                                 join_names(known)));
  }
}

}  // namespace

std::vector<ClaimResult> reproduce(const ReproduceOptions& options) {
  check_ids(options.ids);
  const std::set<std::string> fitted = words(options.finger.fitted_to);
  FingerModel papilla(options.finger, Preset::Papilla, options.threads, options.sampling);
  FingerModel m3(options.finger, Preset::M3, options.threads, options.sampling);
  std::vector<ClaimResult> results;
  for (const Claim& claim : claims()) {
    if (!options.ids.empty() &&
        std::find(options.ids.begin(), options.ids.end(), claim.id) == options.ids.end()) {
      continue;
    }
    const auto begin = std::chrono::steady_clock::now();
    ClaimResult result{&claim, claim.judge(papilla), {}, 0};
    if (claim.both_presets && !options.one_preset) result.m3 = claim.judge(m3);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (Judgement* j : {&result.papilla, &result.m3}) {
      if (j->verdict == Verdict::Agrees && fitted.count(claim.id)) j->verdict = Verdict::Fitted;
    }
    results.push_back(result);
    if (options.done) options.done(results.back());
  }
  return results;
}

}  // namespace papilla
