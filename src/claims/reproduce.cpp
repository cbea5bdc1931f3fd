#include "claims/reproduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/text.h"
#include "config/writer.h"
#include "design/design.h"

namespace papilla::claims {
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

double usual_seconds(const Claim& claim) {
  // `papilla reproduce --json`, both presets on two threads, times 3.7: both processors of a
  // machine that is twice as fast.
  static const std::map<std::string, double> kSeconds{
      {"M1", 40}, {"M4", 4},   {"M5", 4},   {"M6", 64},  {"M7", 16},  {"M13", 12},
      {"M15", 4}, {"M19", 38}, {"M20", 44}, {"M22", 20}, {"M25", 14}, {"M27", 1}};
  const auto found = kSeconds.find(claim.id);
  return found == kSeconds.end() ? 0 : found->second;
}

std::string judged_problem(const ReproduceOptions& options) {
  const SkinSampling& skins = options.sampling;
  return fmt::format(PAPILLA_VERSION " {} {} {} {} {}\n", skins.level, skins.skins,
                     skins.first_skin, skins.grid, options.one_preset) +
         to_toml(options.finger) + maps_state(options.finger) + "\n" + designs_state("m3_samples") +
         designs_state("coatings");
}

std::vector<ClaimResult> reproduce(const ReproduceOptions& options) {
  check_ids(options.ids);
  std::vector<const Claim*> asked;
  for (const Claim& claim : claims()) {
    if (options.ids.empty() ||
        std::find(options.ids.begin(), options.ids.end(), claim.id) != options.ids.end())
      asked.push_back(&claim);
  }
  KeptResults kept;
  if (!options.folder.empty()) kept = KeptResults(options.folder, judged_problem(options));
  std::vector<ClaimResult> results;
  double left = 0;
  for (const Claim* claim : asked) {
    ClaimResult& result = results.emplace_back();
    result.claim = claim;
    if (!kept.find(result)) left += usual_seconds(*claim);
  }
  const std::set<std::string> fitted = words(options.finger.fitted_to);
  FingerModel papilla(options.finger, Preset::Papilla, options.threads, options.sampling);
  FingerModel m3(options.finger, Preset::M3, options.threads, options.sampling);
  for (ClaimResult& result : results) {
    const Claim& claim = *result.claim;
    if (!kept.find(result)) {
      if (options.begun) options.begun(claim, left);
      left -= usual_seconds(claim);
      const auto begin = std::chrono::steady_clock::now();
      result.papilla = claim.judge(papilla);
      if (claim.both_presets && !options.one_preset) result.m3 = claim.judge(m3);
      result.seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      for (Judgement* j : {&result.papilla, &result.m3}) {
        if (j->verdict == Verdict::Agrees && fitted.count(claim.id)) j->verdict = Verdict::Fitted;
      }
      kept.keep(result);
    }
    if (options.done) options.done(result);
  }
  kept.remove();
  return results;
}

}  // namespace papilla::claims
