#include "report/run_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "base/error.h"
#include "base/scratch_folder.h"
#include "base/text.h"
#include "design/study.h"
#include "report/folder_differences.h"
#include "report/json.h"
#include "report/results.h"
#include "report/run_json.h"
#include "report/summary.h"
#include "report/sums.h"
#include "search/reanswer.h"
#include "search/records.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string number_text(const StatedNumber& number, double value) {
  if (!std::isfinite(value)) return "no number";
  return fmt::format("{:.6g}{}", value, number.unit.empty() ? "" : " " + number.unit);
}

bool same_size(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || same_number(*a, *b));
}

// What a receipt says otherwise than the recomputed one; "": nothing.
std::string otherwise(const Receipt& there, const Receipt& here) {
  const auto says = [](const char* what, const std::string& one, const std::string& other) {
    return fmt::format("{} \"{}\", recomputed \"{}\"", what, one, other);
  };
  const auto error = [&](const char* name, const StatedError& a, const StatedError& b) {
    const auto text = [](const StatedError& e) {
      return e.size ? fmt::format("{:.6g}", *e.size) : "none: " + e.absent;
    };
    return same_size(a.size, b.size) && a.absent == b.absent ? "" : says(name, text(a), text(b));
  };
  if (there.number.words != here.number.words)
    return says("claim", there.number.words, here.number.words);
  if (!same_number(there.number.value, here.number.value))
    return says("value", number_text(there.number, there.number.value),
                number_text(here.number, here.number.value));
  if (!word_differences(there.text, here.text).empty()) return says("text", there.text, here.text);
  if (there.number.unit != here.number.unit)
    return says("unit", there.number.unit, here.number.unit);
  for (const std::string& found : {error("u_num", there.number.numerical, here.number.numerical),
                                   error("u_model", there.number.model, here.number.model)}) {
    if (!found.empty()) return found;
  }
  if (there.places != here.places || there.number.rests_on != here.number.rests_on)
    return "other places or stages than recomputed";
  return there.inputs == here.inputs ? "" : "other inputs than this study and its questions";
}

// All that it rests on was answered anew.
bool recomputed(const StatedNumber& number, const AnsweredAgain& answers) {
  return std::all_of(number.rests_on.begin(), number.rests_on.end(),
                     [&](Stage stage) { return answers.all(stage); });
}

std::vector<Stage> stages_of(const Receipts& receipts, const std::vector<std::string>& ids) {
  std::vector<Stage> out;
  for (const std::string& id : ids) {
    const auto found = std::find_if(receipts.list.begin(), receipts.list.end(),
                                    [&](const Receipt& r) { return r.id == id; });
    if (found == receipts.list.end())
      throw InputError("--receipt: no receipt \"" + id + "\" in " + kReceiptsName);
    out.insert(out.end(), found->number.rests_on.begin(), found->number.rests_on.end());
  }
  // A number that is an input rests on no answers; none named means all.
  if (!ids.empty() && out.empty()) out.push_back(Stage::Done);
  return out;
}

void copy_journal(const Folder& to, const StudyProblem& problem,
                  const std::vector<JournalRecord>& records) {
  Journal journal(to, kJournalName, journal_key(problem), true);
  for (const JournalRecord& record : records) journal.append(record);
}

}  // namespace

std::vector<std::string> missing_of_run(const std::string& folder) {
  std::vector<std::string> out;
  for (const char* name : {"run.json", "resolved.toml", "journal"}) {
    if (!fs::is_regular_file(fs::path(folder) / name)) out.emplace_back(name);
  }
  return out;
}

bool has_receipts(const std::string& folder) {
  return fs::is_regular_file(fs::path(folder) / kReceiptsName);
}

bool promises_receipts(const std::string& folder) {
  const Json run = Json::parse(Folder(folder).read("run.json"), nullptr, false);
  return run.is_object() && run.contains("receipts") && run["receipts"].is_string();
}

const char* receipt_state_name(ReceiptState state) {
  static constexpr std::array kNames{"holds", "violated", "not recomputed"};
  return kNames[static_cast<std::size_t>(state)];
}

std::size_t RunVerdict::count(ReceiptState state) const {
  return static_cast<std::size_t>(std::count_if(
      receipts.begin(), receipts.end(), [&](const ReceiptVerdict& c) { return c.state == state; }));
}

bool RunVerdict::holds() const {
  return others.empty() && count(ReceiptState::Holds) == receipts.size();
}

struct RecomputedRun::Inside {
  // Writes a folder of results and keeps the texts with what is behind their numbers.
  class KeepingWriter final : public ResultWriter {
   public:
    std::string text(const Response& response) const override { return folder_.text(response); }
    void write(const ResultFiles& f) const override {
      folder_.write(f);
      run = run_json(f);
      summary = run_summary(f);
      receipts = receipts_of(f, run, summary);
    }

    mutable Json run;
    mutable std::string summary;
    mutable Receipts receipts;

   private:
    FolderWriter folder_;
  };

  ScratchFolder scratch;
  KeepingWriter made;
  AnsweredAgain answers;
  std::vector<std::string> wanted;
  double seconds = 0;
};

RecomputedRun::RecomputedRun(const std::string& folder, const RunChecking& how)
    : inside_(std::make_unique<Inside>()) {
  const auto from = std::chrono::steady_clock::now();
  const Folder source(folder);
  const Receipts receipts = read_receipts(source.read(kReceiptsName), source.path(kReceiptsName));
  if (receipts.version != PAPILLA_VERSION)
    throw InputError(
        fmt::format("{}: of papilla {}, and this is {}: verify it with that one, or "
                    "write it anew (`papilla optimize {} --out NEW`)",
                    source.path(kReceiptsName), receipts.version, PAPILLA_VERSION,
                    source.path("resolved.toml")));
  Study study = read_study(source.file("resolved.toml"));
  // The folder of results has any name, and the study was called as its own file or folder.
  if (!receipts.name.empty()) study.name = receipts.name;
  const StudyProblem problem(study);
  AskingAgain again{
      stages_of(receipts, how.receipts), how.seconds, how.jobs, {}, how.progress, how.stop};
  again.text = [this](const Response& response) { return inside_->made.text(response); };
  inside_->answers = answer_again(problem, source, again);
  inside_->wanted = how.receipts;
  const Folder scratch(inside_->scratch.path());
  copy_journal(scratch, problem, inside_->answers.records);
  OptimiseOptions options;
  options.folder = inside_->scratch.path();
  options.resume = true;
  options.pick = receipts.pick;
  options.finish = receipts.finish;
  options.writer = &inside_->made;
  optimise(study, options);
  inside_->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

RecomputedRun::~RecomputedRun() = default;

RunVerdict RecomputedRun::judge(const std::string& folder) const {
  const Inside::KeepingWriter& made = inside_->made;
  const AnsweredAgain& answers = inside_->answers;
  const Folder source(folder);
  RunVerdict out;
  out.seconds = inside_->seconds;
  for (std::size_t k = 0; k < kStages; ++k)
    out.asked += answers.asked[k], out.answered += answers.answered[k];
  const Receipts there = read_receipts(source.read(kReceiptsName), source.path(kReceiptsName));
  FolderDifferences found =
      folder_differences(source, Folder(inside_->scratch.path()), made.run, made.summary);
  for (std::size_t i = 0; i < made.receipts.list.size(); ++i) {
    ReceiptVerdict judged{made.receipts.list[i], ReceiptState::Holds, {}};
    const bool has = i < there.list.size() && there.list[i].id == judged.receipt.id;
    const std::string other =
        has ? otherwise(there.list[i], judged.receipt) : std::string("no such number");
    if (!other.empty()) judged.says.push_back(fmt::format("{} says {}", kReceiptsName, other));
    for (const ReceiptDifference& d : found.receipts) {
      if (d.words == judged.receipt.number.words && d.text == judged.receipt.text)
        judged.says.push_back(d.says);
    }
    if (!judged.says.empty())
      judged.state = ReceiptState::Violated;
    else if (!recomputed(judged.receipt.number, answers))
      judged.state = ReceiptState::NotRecomputed;
    const bool asked_for =
        inside_->wanted.empty() || std::find(inside_->wanted.begin(), inside_->wanted.end(),
                                             judged.receipt.id) != inside_->wanted.end();
    if (asked_for) out.receipts.push_back(std::move(judged));
  }
  if (!inside_->wanted.empty()) return out;
  out.others = std::move(found.others);
  if (sha256(source.read("resolved.toml")) != there.study)
    out.others.push_back(fmt::format("resolved.toml: is not the one that {} is of", kReceiptsName));
  if (there.list.size() > made.receipts.list.size())
    out.others.push_back(fmt::format("{} has {} receipts, recomputed {}", kReceiptsName,
                                     there.list.size(), made.receipts.list.size()));
  for (const std::string& question : answers.otherwise)
    out.others.push_back("journal: another answer than the model's (" + question + ")");
  return out;
}

RunVerdict verify_run(const std::string& folder, const RunChecking& how) {
  return RecomputedRun(folder, how).judge(folder);
}

std::string run_verdict_text(const RunVerdict& verdict) {
  std::string out;
  for (const ReceiptVerdict& c : verdict.receipts) {
    const Receipt& r = c.receipt;
    out += fmt::format("{:<14} {}  {}: {}\n", receipt_state_name(c.state), r.id, r.number.words,
                       r.text.empty() ? number_text(r.number, r.number.value) : r.text);
    for (const std::string& says : c.says) out += fmt::format("{:<14} {}\n", "", says);
  }
  for (const std::string& other : verdict.others)
    out += fmt::format("{:<14} {}\n", "violated", other);
  out += fmt::format(
      "{}: {} hold, {} violated, {} not recomputed; {} besides; {} of {} answers of "
      "the model made again in {}\n",
      counted(static_cast<long long>(verdict.receipts.size()), "number"),
      verdict.count(ReceiptState::Holds), verdict.count(ReceiptState::Violated),
      verdict.count(ReceiptState::NotRecomputed),
      counted(static_cast<long long>(verdict.others.size()), "difference"), verdict.answered,
      verdict.asked, duration(verdict.seconds));
  return out;
}

Json run_verdict_json(const std::string& folder, const RunVerdict& verdict) {
  Json rows = Json::array();
  for (const ReceiptVerdict& c : verdict.receipts)
    rows.push_back({{"id", c.receipt.id},
                    {"claim", c.receipt.number.words},
                    {"state", receipt_state_name(c.state)},
                    {"text", c.receipt.text},
                    {"value", json_number(c.receipt.number.value)},
                    {"unit", c.receipt.number.unit},
                    {"says", c.says}});
  return {{"folder", folder},         {"holds", verdict.holds()},     {"receipts", std::move(rows)},
          {"others", verdict.others}, {"answered", verdict.answered}, {"asked", verdict.asked}};
}

}  // namespace papilla::report
