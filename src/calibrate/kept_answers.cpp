#include "calibrate/kept_answers.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/folder.h"

namespace papilla::calibrate {
namespace {

// Hexadecimal, so that a number reads back to its last bit.
std::string written(const std::vector<Estimate>& answer) {
  std::string out;
  for (const Estimate& e : answer) out += fmt::format("{:a} {:a} ", e.value, e.se);
  return out;
}

std::vector<Estimate> read_answer(const std::string& text) {
  std::vector<Estimate> out;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    Estimate e;
    e.value = std::strtod(at, &end);
    if (end == at) return out;
    at = end;
    e.se = std::strtod(at, &end);
    out.push_back(e);
  }
}

}  // namespace

KeptAnswers::KeptAnswers(const std::string& folder, const std::string& problem) {
  const std::string key = text_hash(problem);
  path_ = folder + "/unfinished-" + key + ".journal";
  journal_ = std::make_unique<Journal>(Folder(folder), "unfinished-" + key + ".journal", key, true);
  for (const JournalRecord& record : journal_->records())
    answers_[record.key] = read_answer(record.payload);
}

std::vector<Estimate> KeptAnswers::get(const std::string& question, std::size_t size,
                                       const std::function<std::vector<Estimate>()>& make) {
  const std::string key = text_hash(question);
  if (const auto kept = answers_.find(key); kept != answers_.end() && kept->second.size() == size)
    return kept->second;
  std::vector<Estimate> answer = make();
  ++made_;
  if (!journal_) return answer;
  journal_->append({key, written(answer)});
  return answers_[key] = std::move(answer);
}

void KeptAnswers::remove() {
  if (!journal_) return;
  journal_.reset();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace papilla::calibrate
