// Cost and error of the field rules on the published samples: prints results/accuracy/field.csv.
// Run by hand: ninja -C build/release field_bench && build/release/bench/field_bench [PIXELS FINEST
// [SAMPLE...]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "measure/field_accuracy.h"
#include "report/accuracy.h"

int main(int argc, char** argv) {
  using namespace papilla::tests;
  FieldAccuracyOptions options;
  if (argc > 2) {
    options.pixels = std::atoi(argv[1]);
    options.refinements.clear();
    for (int f = 1; f <= std::atoi(argv[2]); f *= 2) options.refinements.push_back(f);
  }
  std::vector<std::string> samples(argv + std::min(argc, 3), argv + argc);
  if (samples.empty()) samples = {"flat", "a3h350", "a3h600", "a3h900", "a4h350", "a4h600"};
  bool head = true;
  for (const std::string& sample : samples) {
    const std::string csv = field_accuracy_csv(field_accuracy(
        sample, read_design(find_design("m3_samples/" + sample + ".toml")), options));
    fmt::print("{}", head ? csv : csv.substr(csv.find('\n') + 1));
    std::fflush(stdout);
    head = false;
  }
}
