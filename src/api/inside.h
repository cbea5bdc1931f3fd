// What the public values hold, and how problems cross the border.
#pragma once

#include <utility>

#include "base/error.h"
#include "base/watch.h"
#include "design/design.h"
#include "forward/response.h"
#include "papilla/design.h"
#include "papilla/error.h"
#include "papilla/evaluate.h"

namespace papilla::api {

struct Design::Inside {
  std::string file, text;  // where it was read from: a file, else a text
  Values values;           // replaced
  Study study;

  const papilla::Design& design() const { return study.design; }
};

struct Response::Inside {
  papilla::Response response;
  std::vector<Point> points;
};

Heights heights_of(const Heightmap& map);
Heightmap heightmap_of(const Heights& heights);  // throws papilla::InputError

[[noreturn]] inline void rethrow(const papilla::InputError& error) {
  std::vector<Problem> problems;
  for (const papilla::Problem& p : error.problems())
    problems.push_back({p.file, p.line, p.column, p.key, p.message});
  throw InputError(std::move(problems));
}

// Calls work() and hands its exceptions on as public ones.
template <class Work>
auto across(Work&& work) {
  try {
    return work();
  } catch (const papilla::InputError& error) {
    rethrow(error);
  } catch (const WorkStopped&) {
    throw Stopped();
  }
}

}  // namespace papilla::api
