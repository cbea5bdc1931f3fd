// A study that is small enough for a test, and a folder for its run.
#pragma once

#include <filesystem>
#include <string>

#include "base/rooms.h"
#include "design/study.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests {

// One finger at two humidities.
inline Study small_study() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.design.environment.relative_humidity = {0.35, 0.75};
  study.design.accuracy.level = AccuracyLevel::Draft;
  study.search.evaluations = 6;
  study.search.jobs = 2;
  return study;
}

// For whole runs: confirmed on as few pixels as it is searched on, and of a finger of whose numbers
// nothing is left open, so that no steps of them are taken.
inline Study quick_study() {
  Study study = small_study();
  study.design.accuracy.grid = 64;
  study.design.finger.uncertainty.clear();
  return study;
}

// That nothing is in yet.
inline std::string fresh_folder(const std::string& name) {
  const std::filesystem::path folder = temporary(name);
  std::filesystem::remove_all(folder);
  return folder.string();
}

}  // namespace papilla::tests
