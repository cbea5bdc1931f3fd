#include "tests/support/refusal.h"

namespace papilla::tests {

std::vector<Problem> problems_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

std::string keyed_refusal_of(const std::function<void()>& work) {
  std::string out;
  for (const Problem& p : problems_of(work)) out += p.key + ": " + p.message + "\n";
  return out;
}

std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace papilla::tests
