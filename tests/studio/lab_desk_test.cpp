// The lab of a search on the studio's desk; scripts answer in the program's place.
#include "studio/lab_desk.h"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/files.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::lab_desk_test {
namespace {

using Json = nlohmann::ordered_json;

class LabOfASearch : public ::testing::Test {
 protected:
  LabOfASearch() { std::filesystem::create_directories(results()); }

  std::filesystem::path results() const { return place_.path() / kResults; }

  // The desk of a program that is this script; its words go into `words` beside the results.
  std::unique_ptr<LabDesk> desk(const std::string& script) {
    const std::filesystem::path program = place_.path() / "program.sh";
    write_bytes(program, "#!/bin/sh\necho \"$@\" >> " + (results() / "words").string() +
                             "\nlab=" + (results() / "lab").string() + "\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return std::make_unique<LabDesk>(place_.path(), program, [] {});
  }

  static Json when_done(const LabDesk& desk) {
    for (int i = 0; i < 1000 && desk.json(kResults)["doing"] != ""; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return desk.json(kResults);
  }

  std::string words() const {
    std::string out = read_bytes(results() / "words");
    for (std::size_t at; (at = out.find(results().string())) != std::string::npos;)
      out.replace(at, results().string().size(), "R");
    return out;
  }

  static constexpr const char* kResults = "searches/001";
  TemporaryFolder place_;
};

constexpr const char* kOpens =
    "mkdir -p $lab\n: > $lab/lab.toml\necho '{\"plans\": [{}]}' > $lab/lab.json\n"
    "echo 'id,F_off_N' > $lab/plan_01.csv\necho planning >&2\necho 'Measure E01.'\n";

TEST_F(LabOfASearch, IsOpenedOnceThenPlannedAndTold) {
  const auto lab = desk(kOpens);
  EXPECT_TRUE(lab->json(kResults)["lab"].is_null());
  lab->plan(kResults, 8);
  Json now = when_done(*lab);
  EXPECT_EQ(now["trouble"], "");
  EXPECT_EQ(now["said"], "Measure E01.\n");
  EXPECT_EQ(now["table"]["name"], "plan_01.csv");
  EXPECT_EQ(now["table"]["text"], "id,F_off_N\n");
  lab->plan(kResults, 4);
  when_done(*lab);
  lab->keep(kResults, "E01_run1.csv", "time_s\n0\n");
  lab->keep(kResults, "E01_run2.csv", "time_s\n1\n");
  lab->tell(kResults, {"E01_run1.csv", "E01_run2.csv"}, true);
  when_done(*lab);
  EXPECT_EQ(read_bytes(results() / "lab_measured/E01_run2.csv"), "time_s\n1\n");
  EXPECT_EQ(words(),
            "next R --lab R/lab --count 8\nnext R/lab --count 4\n"
            "tell R/lab R/lab_measured/E01_run1.csv R/lab_measured/E01_run2.csv --replace\n");
}

TEST_F(LabOfASearch, SaysWhatWentWrongWithItsOwnResultsAlone) {
  const auto lab = desk("echo 'error: the finger names no belief' >&2\nexit 2\n");
  lab->plan(kResults, 8);
  EXPECT_EQ(when_done(*lab)["trouble"], "error: the finger names no belief\n");
  EXPECT_EQ(lab->json("searches/002")["trouble"], "");
}

TEST_F(LabOfASearch, IsStoppedAndTakesNoSecondWorkMeanwhile) {
  const auto lab = desk(std::string(kOpens) + "while :; do sleep 0.05; done\n");
  lab->plan(kResults, 8);
  for (int i = 0; i < 1000 && lab->json(kResults)["lab"].is_null(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(lab->json(kResults)["doing"], "plan");
  EXPECT_EQ(refusal_of([&] { lab->plan(kResults, 8); }),
            "the lab is at work: wait for it, or stop it");
  lab->stop();
  const Json now = when_done(*lab);
  EXPECT_EQ(now["doing"], "");
  EXPECT_EQ(now["trouble"], "");
}

TEST_F(LabOfASearch, RefusesWhatCannotBeTold) {
  const auto lab = desk(kOpens);
  EXPECT_THROW(lab->plan("", 8), InputError);
  EXPECT_THROW(lab->tell(kResults, {"a.csv"}, false), InputError);  // no lab yet
  for (const char* name : {"../a.csv", "a/b.csv", ".csv", "a.txt", ""})
    EXPECT_THROW(lab->keep(kResults, name, "x"), InputError) << name;
  lab->plan(kResults, 8);
  when_done(*lab);
  EXPECT_THROW(lab->tell(kResults, {}, false), InputError);
  EXPECT_THROW(lab->tell(kResults, {"never_kept.csv"}, false), InputError);
  EXPECT_THROW(lab->tell(kResults, {"../../program.sh"}, false), InputError);
}

}  // namespace
}  // namespace papilla::tests::lab_desk_test
