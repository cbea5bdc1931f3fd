#include "calibrate/kept_answers.h"

#include <fmt/format.h>

#include <cstdlib>

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

std::vector<Estimate> KeptAnswers::get(const std::string& question, std::size_t size,
                                       const std::function<std::vector<Estimate>()>& make) {
  const std::string key = text_hash(question);
  if (const std::string* kept = unfinished_.find(key)) {
    std::vector<Estimate> answer = read_answer(*kept);
    if (answer.size() == size) return answer;
  }
  std::vector<Estimate> answer = make();
  unfinished_.keep(key, written(answer));
  return answer;
}

}  // namespace papilla::calibrate
