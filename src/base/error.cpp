#include "base/error.h"

#include "base/text.h"

namespace papilla::base {

std::string Problem::text() const {
  std::string out;
  if (!file.empty()) {
    out += file + ":";
    if (line > 0) out += std::to_string(line) + ":" + std::to_string(column) + ":";
    out += " ";
  }
  if (!key.empty()) out += key + ": ";
  return visible(out + message);
}

namespace {
std::string join(const std::vector<Problem>& problems) {
  std::string out;
  for (const Problem& problem : problems) {
    if (!out.empty()) out += '\n';
    out += problem.text();
  }
  return out;
}
}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(join(problems)), problems_(std::move(problems)) {}

InputError::InputError(const std::string& message)
    : InputError(std::vector<Problem>{Problem{{}, 0, 0, {}, message}}) {}

void Mistakes::add(const InputError& error) {
  problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
}

void Mistakes::tell() const {
  if (!problems_.empty()) throw InputError(problems_);
}

}  // namespace papilla::base
