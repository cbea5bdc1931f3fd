// Long work as it is seen from outside.
#include "base/watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
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

// Of several threads too, where OpenMP would end the process.
TEST(Watch, GivesTheExceptionOfItsProgressBackAndEndsItsWork) {
  for (const int threads : {1, 2}) {
    std::atomic<int> worked = 0;
    int told = 0;
    Watch watch(
        [&](int done) {
          told = done;
          if (done == 2) throw std::runtime_error("mine");
        },
        nullptr);
    const auto said = [&] {
      try {
        parallel_for(
            1000, [&](int) { ++worked; }, threads);
      } catch (const std::runtime_error& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    EXPECT_EQ(said(), "mine") << threads;
    EXPECT_EQ(told, 2);
    EXPECT_LE(worked, 2 + threads - 1) << "the running pieces end, and no other begins";
    EXPECT_EQ(said(), "mine") << "a loop after it does not begin";
  }
}

// As a handler of Ctrl-C may do: what it throws is what comes out.
TEST(Watch, GivesTheExceptionOfAProgressThatAlsoStopsIt) {
  std::atomic<bool> stop = false;
  Watch watch(
      [&](int) {
        stop = true;
        throw std::runtime_error("mine");
      },
      &stop);
  std::string said;
  try {
    parallel_for(
        100, [&](int) { Watch::look(); }, 2);
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  EXPECT_EQ(said, "mine");
}

TEST(Watch, EndsWorkThatIsNotDoneInTime) {
  const auto endless = [] {
    parallel_for(
        2,
        [](int) {
          for (;;) Watch::look();
        },
        2);
  };
  EXPECT_FALSE(done_within(0.01, endless));
  const auto counted_apart = [&] {
    const Watch quiet({}, Watch::stop_of_piece());
    endless();
  };
  EXPECT_FALSE(done_within(0.01, counted_apart));
  int done = 0;
  EXPECT_TRUE(done_within(600, [&] {
    parallel_for(
        3, [&](int) { ++done; }, 1);
  }));
  EXPECT_EQ(done, 3);
  EXPECT_THROW(done_within(600, [] { throw std::runtime_error("mine"); }), std::runtime_error);
  EXPECT_EQ(Watch::current(), nullptr);
}

}  // namespace
}  // namespace papilla::tests::watch_test
