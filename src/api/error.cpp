#include "papilla/error.h"

#include <cctype>

#include "api/inside.h"
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

std::string in_arguments(std::string message) {
  const auto letter = [](char c) { return std::islower(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = 0; (at = message.find("--", at)) != std::string::npos;) {
    const bool option = (at == 0 || message[at - 1] == ' ' || message[at - 1] == '(') &&
                        at + 2 < message.size() && letter(message[at + 2]);
    if (!option) {
      at += 2;
      continue;
    }
    message.erase(at, 2);
    for (; at < message.size() && (letter(message[at]) || message[at] == '-'); ++at) {
      if (message[at] == '-') message[at] = '_';
    }
  }
  return message;
}

std::string Problem::text() const { return inner(*this).text(); }

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(text_of(problems)), problems_(std::move(problems)) {}

}  // namespace papilla::api
