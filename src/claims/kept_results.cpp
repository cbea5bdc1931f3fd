#include "claims/kept_results.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <vector>

#include "base/text.h"

namespace papilla::claims {
namespace {

constexpr char kSeparator = '\x1f';  // of units, in no text of a judgement
constexpr std::size_t kFields = 6;   // of a judgement

// Hexadecimal numbers, which read back to their last bit.
std::string number_text(double value) { return fmt::format("{:a}", value); }

std::optional<double> read_number(const std::string& text) {
  const char* begin = text.c_str();
  char* end = nullptr;
  const double value = std::strtod(begin, &end);
  if (end == begin || *end != '\0' || number_text(value) != text) return {};
  return value;
}

std::string judgement_text(const Judgement& j) {
  return fmt::format("{1}{0}{2}{0}{3}{0}{4}{0}{5}{0}{6}", kSeparator, verdict_name(j.verdict),
                     number_text(j.value), number_text(j.se),
                     j.single ? number_text(*j.single) : "none", j.model, j.reason);
}

// From the fields `first` on.
std::optional<Judgement> read_judgement(const std::vector<std::string>& fields, std::size_t first) {
  Judgement out;
  bool known = false;
  for (const Verdict verdict : kVerdicts) {
    if (verdict_name(verdict) != fields[first]) continue;
    out.verdict = verdict;
    known = true;
  }
  const std::optional<double> value = read_number(fields[first + 1]),
                              se = read_number(fields[first + 2]);
  if (fields[first + 3] != "none") {
    out.single = read_number(fields[first + 3]);
    known = known && out.single;
  }
  if (!known || !value || !se) return {};
  out.value = *value;
  out.se = *se;
  out.model = fields[first + 4];
  out.reason = fields[first + 5];
  return out;
}

}  // namespace

bool KeptResults::find(ClaimResult& result) const {
  const std::string* kept = unfinished_.find(result.claim->id);
  if (!kept) return false;
  const std::vector<std::string> fields = split(*kept, kSeparator);
  if (fields.size() != 2 * kFields + 1) return false;
  const auto papilla = read_judgement(fields, 0), m3 = read_judgement(fields, kFields);
  const auto seconds = read_number(fields.back());
  if (!papilla || !m3 || !seconds) return false;
  result.papilla = *papilla;
  result.m3 = *m3;
  result.seconds = *seconds;
  return true;
}

void KeptResults::keep(const ClaimResult& result) {
  unfinished_.keep(result.claim->id,
                   fmt::format("{1}{0}{2}{0}{3}", kSeparator, judgement_text(result.papilla),
                               judgement_text(result.m3), number_text(result.seconds)));
}

}  // namespace papilla::claims
