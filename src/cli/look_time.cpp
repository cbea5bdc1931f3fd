#include "cli/look_time.h"

#include <fmt/format.h>

#include <string>

#include "forward/appearance.h"
#include "search/levels.h"

namespace papilla::cli {

double timed_look(const Context& context, const StudyProblem& problem) {
  if (const std::string theory = look_theory(problem); theory == text(OpticsRegime::Rigorous))
    context.note(fmt::format(
        "timing the look of this design by the theory \"{}\", which may take half a minute",
        theory));
  return look_price(problem);
}

}  // namespace papilla::cli
