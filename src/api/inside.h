// What the public values hold, and how problems cross the border.
#pragma once

#include <utility>

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
  std::string file, text;  // where it was read from: a file, else a text
  Values values;           // replaced
  rooms::Study study;

  const rooms::Design& design() const { return study.design; }
};

struct Response::Inside {
  rooms::Response response;
  std::vector<Point> points;
};

Heights heights_of(const Heightmap& map);
Heightmap heightmap_of(const Heights& heights);  // throws rooms::InputError

[[noreturn]] inline void rethrow(const rooms::InputError& error) {
  std::vector<Problem> problems;
  for (const rooms::Problem& p : error.problems())
    problems.push_back({p.file, p.line, p.column, p.key, p.message});
  throw InputError(std::move(problems));
}

// Calls work() and hands its exceptions on as public ones.
template <class Work>
auto across(Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const rooms::InputError& error) {
    rethrow(error);
  } catch (const WorkStopped&) {
    throw Stopped();
  }
}

}  // namespace papilla::api
