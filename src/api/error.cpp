#include "papilla/error.h"

#include "base/error.h"

namespace papilla::api {
namespace {

rooms::Problem inner(const Problem& p) { return {p.file, p.line, p.column, p.key, p.message}; }

std::string text_of(const std::vector<Problem>& problems) {
  std::vector<rooms::Problem> out;
  for (const Problem& problem : problems) out.push_back(inner(problem));
  return rooms::InputError(std::move(out)).what();
}

}  // namespace

std::string Problem::text() const { return inner(*this).text(); }

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(text_of(problems)), problems_(std::move(problems)) {}

}  // namespace papilla::api
