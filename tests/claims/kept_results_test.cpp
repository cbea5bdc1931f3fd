// Judgements on disk: what is read back, what is not believed, and a reproduction that goes on.
#include "claims/kept_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/watch.h"
#include "claims/reproduce.h"
#include "report/claims.h"
#include "tests/temporary.h"

namespace papilla::tests::kept_results_test {
namespace {

// That is there, with nothing in it yet.
std::string fresh_folder(const std::string& name) {
  const std::string folder = temporary(name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

ClaimResult result_of(const std::string& id) {
  ClaimResult out;
  for (const Claim& claim : claims::claims()) {
    if (claim.id == id) out.claim = &claim;
  }
  return out;
}

void expect_same(const Judgement& a, const Judgement& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_TRUE(a.value == b.value || (std::isnan(a.value) && std::isnan(b.value)));
  EXPECT_EQ(a.se, b.se);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.single, b.single);
}

TEST(KeptResults, ReadBackWhatWasKeptToTheLastBit) {
  const std::string folder = fresh_folder("kept_results");
  ClaimResult given = result_of("M1");
  given.papilla = {Verdict::Differs, 1 / 3.0, 1e-300, "+41 ± 6 %\tof it", "why\nnot", 0.1};
  given.m3 = {Verdict::NotTestable, std::nan(""), 0, "", "", {}};
  given.seconds = 12.5;
  KeptResults(folder, "a problem").keep(given);
  const KeptResults again(folder, "a problem");
  ClaimResult read = result_of("M1"), other = result_of("M2");
  ASSERT_TRUE(again.find(read));
  expect_same(read.papilla, given.papilla);
  expect_same(read.m3, given.m3);
  EXPECT_EQ(read.seconds, given.seconds);
  EXPECT_FALSE(again.find(other));
  EXPECT_FALSE(KeptResults(folder, "another problem").find(read));
  KeptResults done(folder, "a problem");
  done.remove();
  EXPECT_FALSE(KeptResults(folder, "a problem").find(read));
}

// Judgements of other samples are not gone on with.
TEST(KeptResults, AreOfTheSamplesThatTheyWereJudgedBy) {
  const std::string folder = fresh_folder("kept_samples");
  std::filesystem::create_directories(folder + "/m3_samples");
  ReproduceOptions options;
  const std::string shipped = judged_problem(options);
  EXPECT_EQ(judged_problem(options), shipped);
  const char* before = std::getenv("PAPILLA_DESIGNS");
  const std::string named = before ? before : "";
  ::setenv("PAPILLA_DESIGNS", folder.c_str(), 1);
  EXPECT_EQ(judged_problem(options), shipped);  // nothing in it stands in the place of a sample
  const auto with = [&](const std::string& text) {
    std::ofstream(folder + "/m3_samples/flat.toml")
        << "schema_version = 1\nbase = \"m3_samples/common.toml\"\n[texture]\ntype = \"flat\"\n"
        << text;
    return judged_problem(options);
  };
  const std::string own = with("[surface]\ncontact_angle = \"60 deg\"\n");
  EXPECT_NE(own, shipped);
  EXPECT_NE(with("[surface]\ncontact_angle = \"61 deg\"\n"), own);
  if (before)
    ::setenv("PAPILLA_DESIGNS", named.c_str(), 1);
  else
    ::unsetenv("PAPILLA_DESIGNS");
  // Nor those of another map of the same name.
  options.finger.skin.map = folder + "/skin.gsf";
  std::ofstream(options.finger.skin.map) << "a";
  const std::string mapped = judged_problem(options);
  std::ofstream(options.finger.skin.map) << "another";
  EXPECT_NE(judged_problem(options), mapped);
}

// Whoever can write the folder can write sound records of anything.
TEST(KeptResults, BelieveNoRecordThatIsNoJudgement) {
  const std::string sound =
      "agrees\x1f"
      "0x1p+0\x1f"
      "0x0p+0\x1fnone\x1fm\x1fr";
  const std::string seconds =
      "\x1f"
      "0x1p+0";
  int number = 0;
  const auto found = [&](const std::string& payload) {
    const std::string folder = fresh_folder("kept_strange_" + std::to_string(number++));
    const std::string key = optim::text_hash("p");
    optim::Journal(base::Folder(folder), "unfinished-" + key + ".journal", key, true)
        .append({"M1", payload});
    ClaimResult read = result_of("M1");
    return KeptResults(folder, "p").find(read);
  };
  EXPECT_TRUE(found(sound + "\x1f" + sound + seconds));
  for (const std::string& strange :
       {std::string(), sound, sound + "\x1f" + sound, sound + "\x1f" + sound + seconds + "\x1f",
        "likes" + sound.substr(6) + "\x1f" + sound + seconds,
        sound + "\x1f" + sound + "\x1f" + "1 second",
        "agrees\x1f"
        "1.0\x1f"
        "0x0p+0\x1fnone\x1fm\x1fr\x1f" +
            sound + seconds,
        "agrees\x1f"
        "0x1p+0\x1f"
        "0x0p+0\x1fmany\x1fm\x1fr\x1f" +
            sound + seconds})
    EXPECT_FALSE(found(strange)) << strange;
}

TEST(Reproduce, AnInterruptedOneGoesOnWhereItStopped) {
  ReproduceOptions options;
  options.ids = {"P1", "P2", "J1", "P21"};
  const std::string whole = claims_csv(reproduce(options));

  options.folder = fresh_folder("reproduce_goes_on");
  int begun = 0;
  options.begun = [&](const Claim&, double left) {
    EXPECT_GE(left, 0);
    if (++begun == 3) throw WorkStopped();
  };
  EXPECT_THROW(reproduce(options), WorkStopped);
  EXPECT_FALSE(std::filesystem::is_empty(options.folder));

  std::vector<std::string> judged;
  options.begun = [&](const Claim& claim, double) { judged.push_back(claim.id); };
  EXPECT_EQ(claims_csv(reproduce(options)), whole);
  EXPECT_EQ(judged.size(), 2u);
  EXPECT_TRUE(std::filesystem::is_empty(options.folder));
}

}  // namespace
}  // namespace papilla::tests::kept_results_test
