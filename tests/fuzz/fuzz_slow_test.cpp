// Readers of files against changed inputs: whatever the bytes, they return or throw InputError, in
// time, and without a number that is none. Deterministic. PAPILLA_FUZZ_INPUTS: inputs in all
// (default 20,000); scripts/fuzz runs many.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "base/random.h"
#include "tests/fuzz/study_targets.h"
#include "tests/temporary.h"

namespace papilla::tests::fuzz_slow_test {
namespace {

constexpr unsigned kHangSeconds = 20;

std::size_t below(RandomStream& random, std::size_t n) {
  return std::min(n - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(n)));
}

// One to four changes: bits, interesting bytes, deletions, repetitions, tokens, a cut.
std::string mutated(std::string bytes, RandomStream& random) {
  static const std::vector<std::string> tokens{
      "nan",  "-1",    "1e400", "99999999999", "0",   "[",   "]",  "{",    "}",    "\"",
      "\"\"", "\n",    "=",     ".",           "'",   "-0",  "\\", "inf",  "um",   " %",
      "base", "\xff",  "(",     ")",           ",",   "\r",  "#",  "1e-9", "true", "\\u0000",
      "<f8",  "shape", "XRes",  "type",        "0x1", "0x.", "-"};
  const std::size_t changes = 1 + below(random, 4);
  for (std::size_t k = 0; k < changes; ++k) {
    if (bytes.empty()) bytes = tokens[below(random, tokens.size())];
    // Headers matter most: half of the changes fall into the first 512 bytes.
    const std::size_t range =
        below(random, 2) == 0 ? std::min<std::size_t>(bytes.size(), 512) : bytes.size();
    const std::size_t at = below(random, range);
    const std::size_t length = 1 + below(random, std::min<std::size_t>(32, bytes.size() - at));
    switch (below(random, 7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(random, 256));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.insert(at, tokens[below(random, tokens.size())]);
        break;
      case 5:
        bytes.replace(at, length, tokens[below(random, tokens.size())]);
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

double inputs() {
  const char* wanted = std::getenv("PAPILLA_FUZZ_INPUTS");
  return wanted ? std::strtod(wanted, nullptr) : 20000;
}

// What a crash or a hang says before the program ends: the target and the input to run again.
char g_running[128];
extern "C" void on_death(int signal) {
  char text[192];
  const int length =
      std::snprintf(text, sizeof text, "%s: %s\n", g_running, signal == SIGALRM ? "HANG" : "CRASH");
  [[maybe_unused]] const auto written = ::write(2, text, static_cast<std::size_t>(length));
  ::_exit(1);
}

// Runs the target on its seeds and on `count` changed ones, and prints a row of the table.
void fuzz(const FuzzTarget& target, std::size_t count) {
  for (const std::string& seed : target.seeds) ASSERT_NO_THROW(target.read(seed)) << target.name;
  std::size_t returned = 0, refused = 0, wrong = 0;
  double slowest = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < count; ++i) {
    std::snprintf(g_running, sizeof g_running, "%s input %zu", target.name.c_str(), i);
    RandomStream random(1, target.name, i);
    const std::string bytes = mutated(target.seeds[i % target.seeds.size()], random);
    const auto start = std::chrono::steady_clock::now();
    ::alarm(kHangSeconds);
    try {
      target.read(bytes);
      ++returned;
    } catch (const InputError& e) {
      ++refused;
      EXPECT_FALSE(e.problems().empty()) << g_running;
    } catch (const NotFinite& e) {
      ++wrong;
      ADD_FAILURE() << g_running << ": " << e.what;
    } catch (const std::exception& e) {
      ++wrong;
      ADD_FAILURE() << g_running << ": " << e.what();
    }
    ::alarm(0);
    slowest = std::max(
        slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("%-10s %9zu %9zu %9zu %8d %6d %6zu %10.3f %9.1f\n", target.name.c_str(), count,
              returned, refused, 0, 0, wrong, slowest, seconds);
  std::fflush(stdout);
}

TEST(Fuzz, ReadersReturnOrRefuse) {
  const TemporaryFolder place;
  for (const int signal : {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    ::signal(signal, on_death);
  // A crash or a hang ends the program: the zeros of a row that is printed are counts.
  std::printf("%-10s %9s %9s %9s %8s %6s %6s %10s %9s\n", "target", "inputs", "returned", "refused",
              "crashes", "hangs", "wrong", "slowest s", "seconds");
  double total = 0;
  std::vector<FuzzTarget> targets = file_targets(place.path());
  for (FuzzTarget& t : study_targets(place.path())) targets.push_back(std::move(t));
  for (const FuzzTarget& target : targets) {
    const double count = std::ceil(target.share * inputs());
    fuzz(target, static_cast<std::size_t>(count));
    total += count;
  }
  std::printf("%-10s %9.0f\n", "all", total);
  for (const int signal : {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    ::signal(signal, SIG_DFL);
}

}  // namespace
}  // namespace papilla::tests::fuzz_slow_test
