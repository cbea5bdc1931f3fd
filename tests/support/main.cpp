// The main of every test program: it keeps freed memory as the program itself does, without which
// solves on large grids take twice as long.
#include <gtest/gtest.h>

#include "base/memory.h"

int main(int argc, char** argv) {
  papilla::base::keep_freed_memory();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
