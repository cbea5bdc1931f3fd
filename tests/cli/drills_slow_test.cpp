// scripts/torture disturbs commands: one that fails by itself would refuse whatever disturbs it.
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace papilla::tests::drills_slow_test {
namespace {

TEST(Drills, DisturbCommandsThatSucceedUndisturbed) {
  const Workplace place;
  const Outcome made =
      place.shell("PYTHONPATH='" PAPILLA_SOURCE_DIR
                  "/scripts' /usr/bin/python3 -B -c \"import pathlib; from "
                  "drills import work; work.Bench(pathlib.Path('" PAPILLA_PROGRAM
                  "'), pathlib.Path('" PAPILLA_SOURCE_DIR "'), pathlib.Path('.').resolve())\"");
  EXPECT_EQ(made.status, 0) << made.err;
}

}  // namespace
}  // namespace papilla::tests::drills_slow_test
