// What stops a write: a place that nobody can write to is a wrong input, a disk that takes no more
// is work that failed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <string>

#include "base/error.h"
#include "base/files.h"
#include "tests/temporary.h"

namespace papilla::tests::failed_writes_test {
namespace {

enum class Outcome { Written, WrongInput, Failed };

Outcome outcome_of(const std::string& path, const std::string& bytes) {
  try {
    write_bytes(path, bytes);
    return Outcome::Written;
  } catch (const FailedWrite&) {
    return Outcome::Failed;
  } catch (const InputError&) {
    return Outcome::WrongInput;
  }
}

TEST(FailedWrites, AreToldFromPlacesThatCannotBeWrittenTo) {
  const TemporaryFolder folder;
  const std::string file = std::string(folder.path()) + "/file";
  EXPECT_EQ(outcome_of(file, "small"), Outcome::Written);
  EXPECT_EQ(outcome_of(std::string(folder.path()) + "/none/file", "small"), Outcome::WrongInput);
  EXPECT_EQ(outcome_of(folder.path(), "small"), Outcome::WrongInput);
  // As a full disk: files may not grow beyond 16 bytes. The old one stays.
  const auto before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{16, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Outcome full = outcome_of(file, std::string(100, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &limit);
  ::signal(SIGXFSZ, before);
  EXPECT_EQ(full, Outcome::Failed);
  EXPECT_EQ(read_bytes(file), "small");
}

TEST(Mistakes, OfSeveralInputsAreToldTogether) {
  Mistakes none;
  none.of([] {});
  EXPECT_NO_THROW(none.tell());
  Mistakes two;
  for (const char* name : {"a", "b"}) two.of([&] { throw InputError(std::string("no ") + name); });
  two.of([] {});
  try {
    two.tell();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2u);
    EXPECT_STREQ(error.what(), "no a\nno b");
  }
}

}  // namespace
}  // namespace papilla::tests::failed_writes_test
