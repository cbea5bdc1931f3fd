#include "config/fields.h"

namespace papilla::config {

std::string_view source_name(Source source) {
  switch (source) {
    case Source::Measured:
      return "measured";
    case Source::Paper:
      return "paper";
    case Source::Fit:
      return "fit";
    case Source::Estimate:
      return "estimate";
    case Source::Choice:
      return "choice";
  }
  return "";
}

}  // namespace papilla::config
