// What the public values hold, and how problems cross the border.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "api/drawn_map.h"
#include "base/error.h"
#include "base/watch.h"
#include "design/study.h"
#include "forward/response.h"
#include "papilla/design.h"
#include "papilla/error.h"
#include "papilla/evaluate.h"

namespace papilla::api {

using namespace rooms;

struct Design::Inside {
  std::string file, text;                 // where it was read from: a file, else a text
  Values values;                          // replaced
  std::shared_ptr<const DrawnMap> drawn;  // that a value names; null: none
  rooms::Study study;

  const rooms::Design& design() const { return study.design; }
};

struct Response::Inside {
  rooms::Response response;
  std::vector<Point> points;
};

std::vector<std::string> overrides(const Design::Values& values);  // as files are read with
// The design at the level of the options, checked as evaluate() does. Throws rooms::InputError.
rooms::Design at_options(const Design& design, const EvaluateOptions& options);

// Its response as evaluate() makes it; fidelity: of another response, in the place of a target or
// level. Throws rooms::InputError, WorkStopped.
Response evaluated(const rooms::Design& design, const EvaluateOptions& options,
                   const std::optional<Fidelity>& fidelity = {});

Look look_of(const Optics& optics);
Heights heights_of(const Heightmap& map);
Heightmap heightmap_of(const Heights& heights);  // throws rooms::InputError

// A mistake of the caller's in an argument.
inline rooms::InputError wrong(const std::string& argument, const std::string& message) {
  return rooms::InputError({rooms::Problem{"", 0, 0, argument, message}});
}

// Of every function that takes a number of threads. Throws rooms::InputError.
void require_threads(int threads);

// Options of the command are arguments here: "--any-conditions", any_conditions.
std::string in_arguments(std::string message);

[[noreturn]] inline void rethrow(const rooms::InputError& error) {
  std::vector<Problem> problems;
  for (const rooms::Problem& p : error.problems())
    problems.push_back({p.file, p.line, p.column, p.key, in_arguments(p.message)});
  throw InputError(std::move(problems));
}

// Calls work() and hands its exceptions on as public ones.
template <class Work>
auto across(Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const rooms::InputError& error) {
    rethrow(error);
  } catch (const std::filesystem::filesystem_error& error) {  // a name that is too long
    throw InputError({{error.path1().string(), 0, 0, "", error.code().message()}});
  } catch (const WorkStopped&) {
    throw Stopped();
  }
}

}  // namespace papilla::api
