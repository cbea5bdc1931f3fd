// Receipts of a small run with a belief: sound folders hold, and of fifty with one number changed
// each is told.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "optim/journal.h"
#include "report/receipts.h"
#include "report/run_verdict.h"
#include "report/sums.h"
#include "search/protocol.h"
#include "tests/cli/program.h"

namespace papilla::tests::receipts_slow_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Without a title: it is called by the name of its folder, which is none of the results.
constexpr const char* kStudy = R"toml(schema_version = 1
base = "m3_glass/conformal.toml"
title = ""
[environment]
relative_humidity = ["35 %"]
[accuracy]
level = "draft"
grid = 32
[design_space]
"texture.depth" = ["100 nm", "600 nm"]
"surface.contact_angle" = ["40 deg", "80 deg"]
[objective]
maximise = "mean(modulation)"
minimise = "haze"
[scatter]
"texture.depth" = { sigma = "20 nm" }
[population]
fingers = ["finger.toml"]
[search]
evaluations = 3
drafts = 4
)toml";

class ReceiptsOfARun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = new Workplace;
    place_->write("finger.toml",
                  "schema_version = 1\nbase = \"fingers/reference.toml\"\nbelief = "
                  "\"few_members.toml\"\n");
    place_->write("few_members.toml", file_text(PAPILLA_TEST_DATA "/study/few_members.toml"));
    place_->write("study.toml", kStudy);
    made_ = new Outcome(place_->run("-q optimize study.toml --out run --seed 7 --evaluations 6"));
    if (made_->status == 0) recomputed_ = new RecomputedRun(folder("run"), {});
  }
  static void TearDownTestSuite() {
    delete recomputed_;
    delete made_;
    delete place_;
  }
  void SetUp() override { ASSERT_EQ(made_->status, 0) << made_->err; }

  static std::string folder(const std::string& name) { return (place_->path() / name).string(); }
  // A copy of the run, to be changed.
  static std::string copied(const std::string& name) {
    fs::remove_all(folder(name));
    fs::copy(folder("run"), folder(name), fs::copy_options::recursive);
    return folder(name);
  }
  static Receipts receipts() {
    return read_receipts(file_text(place_->path() / "run" / kReceiptsName), kReceiptsName);
  }

  static Workplace* place_;
  static Outcome* made_;
  static RecomputedRun* recomputed_;
};
Workplace* ReceiptsOfARun::place_ = nullptr;
Outcome* ReceiptsOfARun::made_ = nullptr;
RecomputedRun* ReceiptsOfARun::recomputed_ = nullptr;

// Another last digit of the first number of a text.
std::string falsified(std::string text) {
  const std::size_t first = text.find_first_of("0123456789");
  if (first == std::string::npos) return text;
  std::size_t last = first;
  while (last + 1 < text.size() && (std::isdigit(text[last + 1]) || text[last + 1] == '.')) ++last;
  if (text[last] == '.') --last;
  text[last] = text[last] == '7' ? '2' : '7';
  return text;
}

// The first place of a text from a place on, changed there alone.
bool change(std::string& in, const std::string& from, const std::string& text) {
  const std::size_t begin = from.empty() ? 0 : in.find(from), at = in.find(text, begin);
  if (begin == std::string::npos || at == std::string::npos) return false;
  in.replace(at, text.size(), falsified(text));
  return true;
}

TEST_F(ReceiptsOfARun, HoldWhereNothingWasChanged) {
  for (const std::string& name : {folder("run"), copied("moved")}) {
    const RunVerdict verdict = recomputed_->judge(name);
    EXPECT_TRUE(verdict.holds()) << run_verdict_text(verdict);
    EXPECT_GT(verdict.receipts.size(), 50u);
    EXPECT_EQ(verdict.answered, verdict.asked);
    EXPECT_GT(verdict.asked, 15);
  }
}

// In no time at all: one question of each worker is what says how long the others take.
TEST_F(ReceiptsOfARun, AreAskedOnceAWorkerWhereThereIsNoTime) {
  RunChecking how;
  how.seconds = 1e-9;
  how.jobs = 1;
  const RunVerdict verdict = RecomputedRun(folder("run"), how).judge(folder("run"));
  EXPECT_EQ(verdict.answered, 1);
  EXPECT_FALSE(verdict.holds());
  EXPECT_GT(verdict.count(ReceiptState::NotRecomputed), 0u);
  EXPECT_EQ(verdict.count(ReceiptState::Violated), 0u);
}

TEST_F(ReceiptsOfARun, SayWhyANumberHasNoBar) {
  int bars = 0, bare = 0;
  for (const Receipt& r : receipts().list) {
    for (const StatedError* e : {&r.number.numerical, &r.number.model}) {
      EXPECT_NE(e->size.has_value(), !e->absent.empty()) << r.number.words;
      (e->size ? bars : bare) += 1;
    }
    EXPECT_EQ(r.inputs.size(), 64u);
    EXPECT_FALSE(r.places.empty());
  }
  EXPECT_GT(bars, 10);
  EXPECT_GT(bare, 10);
}

TEST_F(ReceiptsOfARun, HaveTheNumbersOfTheTables) {
  const Json metrics = Json::parse(file_text(place_->path() / "run/best/metrics.json"));
  const Json& own = metrics.at("objectives").at("mean(modulation)");
  const Json& flat = metrics.at("flat").at("objectives").at("mean(modulation)");
  const Json run = Json::parse(file_text(place_->path() / "run/run.json"));
  const auto size = [](const Json& number) {
    return number.is_null() ? std::optional<double>() : number.get<double>();
  };
  // The study's own surface has no model part: a run steps the finger for its best design and for
  // the flat surface of that.
  const bool own_surface = run.at("advice") == "leave flat";
  int found = 0;
  for (const Receipt& r : receipts().list) {
    for (const auto& [words, table] :
         {std::pair("mean(modulation) of what is recommended", own),
          std::pair("mean(modulation) of the same surface without texture", flat)}) {
      if (r.number.words != words) continue;
      EXPECT_EQ(r.number.value, table.at("value").get<double>());
      EXPECT_EQ(r.number.numerical.size, table.at("se").get<double>());
      EXPECT_EQ(r.number.model.size, size(table.at("model")));
      EXPECT_TRUE(r.number.model.size || (own_surface && table == own)) << r.number.words;
      ++found;
    }
  }
  EXPECT_GE(found, run.at("textured").get<bool>() ? 2 : 1);  // flat: one and the same surface
}

TEST_F(ReceiptsOfARun, NameTheNumberThatWasChangedInEachOfFiftyFolders) {
  const Receipts sound = receipts();
  const std::vector<std::string> files{"report.html", "run.json", "summary.md", kReceiptsName};
  std::size_t changed = 0, next = 0;
  for (; changed < 40 && next < 400; ++next) {
    const Receipt& r = sound.list[(next * 7) % sound.list.size()];
    const std::string& file = files[next % files.size()];
    if (r.text.find_first_of("123456789") == std::string::npos) continue;
    if (r.text.size() < 3) continue;  // a clock has such digits too
    const std::string name = copied("changed");
    std::string text = file_text(fs::path(name) / file);
    const std::string from = file == "report.html"   ? "id=\"data\">"
                             : file == kReceiptsName ? "\"" + r.id + "\""
                                                     : "";
    if (!change(text, from, r.text)) continue;
    place_->write("changed/" + file, text);
    if (changed % 2 == 0) write_sums(Folder(name));  // by somebody who knows of the sums
    ++changed;
    const RunVerdict verdict = recomputed_->judge(name);
    EXPECT_FALSE(verdict.holds()) << r.id << " in " << file;
    // The same number may stand in a table that has no receipts: then its place is told.
    bool told = false;
    for (const ReceiptVerdict& v : verdict.receipts) {
      if (v.state != ReceiptState::Violated) continue;
      for (const std::string& says : v.says) told = told || says.starts_with(file);
    }
    for (const std::string& other : verdict.others) told = told || other.starts_with(file);
    EXPECT_TRUE(told) << r.id << " \"" << r.text << "\" in " << file << "\n"
                      << run_verdict_text(verdict);
  }
  EXPECT_EQ(changed, 40u);
  // Tables, designs and the journal.
  struct Place {
    const char *file, *from;
  };
  for (const Place& p :
       {Place{"pareto.csv", "front/01,"}, Place{"history.csv", "\n1,"},
        Place{"sensitivity.json", "\"change\""}, Place{"best/metrics.json", "\"worst_modulation\""},
        Place{"best/metrics.json", "\"F_on\""}, Place{"best/build.toml", "depth = "},
        Place{"best/design.toml", "load = "}, Place{"front/01/metrics.json", "\"value\""},
        Place{"front/01/design.toml", "contact_angle = "}, Place{"plan.txt", "seed "}}) {
    const std::string name = copied("changed");
    std::string text = file_text(fs::path(name) / p.file);
    const std::size_t at = text.find_first_of("123456789", text.find(p.from) + 1 + strlen(p.from));
    ASSERT_NE(at, std::string::npos) << p.file;
    text[at] = text[at] == '3' ? '4' : '3';
    place_->write(std::string("changed/") + p.file, text);
    write_sums(Folder(name));
    const RunVerdict verdict = recomputed_->judge(name);
    EXPECT_FALSE(verdict.holds()) << p.file;
    EXPECT_TRUE(std::any_of(verdict.others.begin(), verdict.others.end(),
                            [&](const std::string& o) { return o.starts_with(p.file); }))
        << p.file << "\n"
        << run_verdict_text(verdict);
  }
}

TEST_F(ReceiptsOfARun, AreRefusedOfAChangedStudyOrHalfAJournal) {
  copied("study");
  std::string text = file_text(place_->path() / "study/resolved.toml");
  text[text.find_first_of("123456789", text.find("load_share = "))] = '0';
  place_->write("study/resolved.toml", text);
  const Outcome other = place_->run("verify study");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("journal"), std::string::npos) << other.err;
  copied("half");
  const std::string journal = file_text(place_->path() / "run/journal");
  place_->write("half/journal", journal.substr(0, journal.size() / 2));
  EXPECT_NE(place_->run("verify half").err.find("does not come to the end of a run"),
            std::string::npos);
  for (const char* name : {"journal", "run.json"}) {
    fs::remove(fs::path(copied("gone")) / name);
    const Outcome gone = place_->run("verify gone");
    EXPECT_EQ(gone.status, 2) << gone.out;
    EXPECT_NE(gone.err.find(std::string("no ") + name), std::string::npos) << gone.err;
  }
}

TEST_F(ReceiptsOfARun, AreViolatedWhereTheirPlaceIsGone) {
  copied("cut");
  place_->write("cut/run.json", file_text(place_->path() / "run/run.json").substr(0, 500));
  const RunVerdict verdict = recomputed_->judge(folder("cut"));
  std::size_t of_run = 0;
  for (const ReceiptVerdict& r : verdict.receipts) {
    if (!std::any_of(r.receipt.places.begin(), r.receipt.places.end(),
                     [](const std::string& place) { return place.starts_with("run.json#"); }))
      continue;
    ++of_run;
    EXPECT_EQ(r.state, ReceiptState::Violated) << r.receipt.id << " " << r.receipt.number.words;
  }
  EXPECT_GT(of_run, 10u);
}

// Files that agree with a journal whose answer was changed: only the model tells.
TEST_F(ReceiptsOfARun, TellAnAnswerOfTheJournalThatTheModelDoesNotGive) {
  copied("liar");
  std::string changed;
  bool done = false;
  std::istringstream lines(file_text(place_->path() / "run/journal"));
  for (std::string line; std::getline(lines, line);) {
    JournalRecord record;
    if (!done && parse_journal_line(line, record)) {
      const auto request = decode_request(record.key);
      auto answer = decode_answer(record.payload);
      if (request && request->stage == Stage::Confirm && answer && answer->status.ok()) {
        answer->objectives[0].value *= 1.01;
        record.payload = encode(*answer);
        line = journal_line(record);
        line.erase(line.find_last_not_of('\n') + 1);
        done = true;
      }
    }
    changed += line + "\n";
  }
  ASSERT_TRUE(done);
  place_->write("liar/journal", changed);
  // Confirmations are made again first, and the changed one is the first: a second is enough.
  const RunVerdict verdict = verify_run(folder("liar"), {{}, 1, 1, {}, nullptr});
  EXPECT_TRUE(std::any_of(verdict.others.begin(), verdict.others.end(), [](const std::string& o) {
    return o.starts_with("journal: another answer than the model's (confirm");
  })) << run_verdict_text(verdict);
}

TEST_F(ReceiptsOfARun, AreVerifiedByTheCommandOneAtATimeAndAll) {
  const Outcome all = place_->run("-q verify run --json");
  EXPECT_EQ(all.status, 0) << all.err;
  const Json told = Json::parse(all.out);
  EXPECT_TRUE(told["run"]["holds"].get<bool>());
  EXPECT_EQ(told["run"]["answered"], told["run"]["asked"]);
  const Outcome one = place_->run("-q verify run --receipt r05");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.out.find("r05"), std::string::npos);
  EXPECT_EQ(one.out.find("r06"), std::string::npos);
  EXPECT_EQ(place_->run("verify run --receipt r99x").status, 2);
  EXPECT_EQ(place_->run("verify run --time '0 min'").status, 2);
  // Too little time: said, and not passed.
  const RunVerdict late = verify_run(folder("run"), {{}, 1e-9, 1, {}, nullptr});
  EXPECT_GT(late.count(ReceiptState::NotRecomputed), 0u);
  EXPECT_FALSE(late.holds());
  // Without receipts: an older run, or one that they were taken from.
  fs::remove(fs::path(copied("older")) / kReceiptsName);
  EXPECT_EQ(place_->run("verify older").status, 2);
  const std::string run = file_text(place_->path() / "older/run.json");
  Json older = Json::parse(run);
  older.erase("receipts");
  place_->write("older/run.json", older.dump(1) + "\n");
  const Outcome old = place_->run("verify older --geometry");
  EXPECT_EQ(old.status, 0) << old.err;
}

}  // namespace
}  // namespace papilla::tests::receipts_slow_test
