// Long work as it is seen from outside.
#include "base/watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "base/parallel.h"

namespace papilla::tests::watch_test {
namespace {

TEST(Watch, CountsThePiecesOfTheInnermost) {
  std::vector<int> outer, inner;
  EXPECT_EQ(Watch::current(), nullptr);
  {
    Watch out([&](int done) { outer.push_back(done); }, nullptr);
    EXPECT_EQ(Watch::current(), &out);
    parallel_for(
        2, [](int) {}, 1);
    {
      Watch in([&](int done) { inner.push_back(done); }, nullptr);
      EXPECT_EQ(Watch::current(), &in);
      parallel_for(
          3, [](int) {}, 1);
    }
    EXPECT_EQ(Watch::current(), &out);
    parallel_for(
        1, [](int) {}, 1);
  }
  EXPECT_EQ(Watch::current(), nullptr);
  EXPECT_EQ(outer, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(inner, (std::vector<int>{1, 2, 3}));
}

TEST(Watch, EndsItsWorkOnceThatIsWished) {
  std::atomic<bool> stop = false;
  int called = 0;
  {
    Watch watch({}, &stop);
    EXPECT_NO_THROW(Watch::look());
    const auto work = [&](int) {
      if (++called == 2) stop = true;
    };
    EXPECT_THROW(parallel_for(5, work, 1), WorkStopped);
    EXPECT_EQ(called, 2);
    EXPECT_THROW(Watch::look(), WorkStopped);
    const Watch::Piece none(nullptr);  // a piece of no watch goes on
    EXPECT_NO_THROW(Watch::look());
  }
  EXPECT_NO_THROW(Watch::look());
}

}  // namespace
}  // namespace papilla::tests::watch_test
