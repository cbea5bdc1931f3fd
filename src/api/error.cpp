#include "papilla/error.h"

#include "base/error.h"

namespace papilla::api {
namespace {

papilla::Problem inner(const Problem& p) { return {p.file, p.line, p.column, p.key, p.message}; }

std::string joined(const std::vector<Problem>& problems) {
  std::string out;
  for (const Problem& problem : problems) out += (out.empty() ? "" : "\n") + problem.text();
  return out;
}

}  // namespace

std::string Problem::text() const { return inner(*this).text(); }

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

}  // namespace papilla::api
