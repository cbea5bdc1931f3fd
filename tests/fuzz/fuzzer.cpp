// Entry point of libFuzzer for one target; compiled once for each (cmake -DPAPILLA_FUZZERS=ON).
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#ifdef PAPILLA_FUZZ_STUDY
#include "tests/fuzz/study_targets.h"
#else
#include "tests/fuzz/targets.h"
#endif
#include "tests/temporary.h"

namespace {

const papilla::tests::FuzzTarget& target() {
  static const papilla::tests::FuzzTarget chosen = [] {
    const std::string folder = papilla::tests::temporary("");
#ifdef PAPILLA_FUZZ_STUDY
    std::vector<papilla::tests::FuzzTarget> targets = papilla::tests::study_targets(folder);
#else
    std::vector<papilla::tests::FuzzTarget> targets = papilla::tests::file_targets(folder);
#endif
    for (papilla::tests::FuzzTarget& t : targets) {
      if (t.name == PAPILLA_FUZZ_TARGET) return t;
    }
    std::abort();
  }();
  return chosen;
}

}  // namespace

// The sound inputs of the target go into the folder PAPILLA_FUZZ_SEEDS, which is the corpus.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (const char* folder = std::getenv("PAPILLA_FUZZ_SEEDS")) {
    int number = 0;
    for (const std::string& seed : target().seeds)
      papilla::tests::write_bytes(std::string(folder) + "/seed" + std::to_string(number++), seed);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    target().read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const papilla::tests::InputError&) {  // anything else ends the run
  }
  return 0;
}
