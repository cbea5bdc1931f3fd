// Files that are written and read whole: what lies on the disk is what was asked for, or an error.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "tests/temporary.h"

namespace papilla::tests::writer_test {
namespace {

// More than two blocks of those that are read back at once.
std::string long_text() {
  std::string out;
  while (out.size() < (std::size_t{5} << 19)) out += std::to_string(out.size()) + ",";
  return out;
}

// The one part in the folder of a file; empty: there is none.
std::string part_beside(const std::string& path) {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(path).parent_path())) {
    const std::string name = entry.path().filename();
    if (name.starts_with(".") && name.find(".part") != name.npos) return entry.path();
  }
  return "";
}

std::string commit_after(const std::function<void(const std::string& part)>& damage) {
  const std::string path = temporary("written.txt");
  write_bytes(path, "before");
  try {
    base::FileWriter out(path);
    const std::string text = long_text();
    out.append(text.substr(0, 1000));
    out.append(text.substr(1000));
    damage(part_beside(path));
    out.commit();
  } catch (const InputError& error) {
    EXPECT_EQ(read_bytes(path), "before");  // the old file stays, nothing else is left
    EXPECT_EQ(part_beside(path), "");
    return error.what();
  }
  EXPECT_EQ(read_bytes(path), long_text());
  return "";
}

TEST(FileWriters, NoticeWhatTheDiskHoldsOtherwise) {
  EXPECT_EQ(commit_after([](const std::string&) {}), "");
  const auto expect_noticed = [](const std::function<void(const std::string&)>& damage) {
    const std::string why = commit_after(damage);
    EXPECT_NE(why.find("reads back with other bytes"), std::string::npos) << why;
  };
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{999}, std::size_t{1} << 20, long_text().size() - 1}) {
    expect_noticed([&](const std::string& part) {
      std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(static_cast<std::streamoff>(at));
      file.put('x');
    });
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{1} << 20, long_text().size() - 1})
    expect_noticed([&](const std::string& part) { std::filesystem::resize_file(part, size); });
}

TEST(FileWriters, LeaveNothingBehindWithoutACommit) {
  const std::string path = temporary("unfinished.txt");
  {
    base::FileWriter out(path);
    out.append("half");
    EXPECT_NE(part_beside(path), "");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(part_beside(path), "");
}

mode_t mode_of(const std::string& path) {
  struct stat there {};
  EXPECT_EQ(::lstat(path.c_str(), &there), 0) << path;
  return there.st_mode & 07777;
}

TEST(FileWriters, KeepTheModeOfWhatTheyReplace) {
  const std::string path = temporary("private.txt");
  const mode_t mask = ::umask(0022);
  write_bytes(path, "first");
  EXPECT_EQ(mode_of(path), 0644u);
  for (const mode_t mode : {0600u, 0640u, 0666u, 0755u, 0400u}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    {
      base::FileWriter out(path);
      EXPECT_EQ(mode_of(part_beside(path)), 0600u);  // its owner's until it is whole
      out.append("second");
      out.commit();
    }
    EXPECT_EQ(mode_of(path), mode);
  }
  ::umask(mask);
}

// Names that nobody guesses: two who write the same file at once do not meet.
TEST(FileWriters, OfOneFileDoNotDisturbEachOther) {
  const std::string path = temporary("both.txt");
  base::FileWriter one(path), two(path);
  one.append("one");
  two.append("two");
  two.commit();
  EXPECT_EQ(read_bytes(path), "two");
  one.commit();
  EXPECT_EQ(read_bytes(path), "one");
}

// A process that was killed leaves its part; the next one that writes the file takes it away, and
// no part that somebody still writes into, nor one of another file.
TEST(FileWriters, ClearWhatAKilledProcessLeft) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "killed.txt";
  const pid_t child = ::fork();
  if (child == 0) {
    base::FileWriter out(path);
    out.append("half");
    ::kill(::getpid(), SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const std::string left = part_beside(path);
  ASSERT_NE(left, "");
  const std::string mine = folder.path() / ".killed.0123456789abcdeX.part.txt";
  std::ofstream(mine) << "not a part of ours";
  write_bytes(folder.path() / "other.txt", "other");
  EXPECT_TRUE(std::filesystem::exists(left));
  base::FileWriter living(path);
  EXPECT_FALSE(std::filesystem::exists(left));
  write_bytes(path, "whole");
  living.commit();
  EXPECT_EQ(read_bytes(path), "");
  EXPECT_TRUE(std::filesystem::exists(mine));
}

// A file that may not grow ends the program by a signal; where that is not taken it is told, and
// nothing is left.
TEST(FileWriters, LeaveNothingWhereAFileMayNotGrow) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "large.txt";
  const auto before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{1000, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_bytes(path, long_text());
  } catch (const InputError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &limit);
  ::signal(SIGXFSZ, before);
  EXPECT_EQ(message, "cannot write " + path + ": File too large (write)");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ReadBytes, TakesAsManyAsItsLimitAndNoMore) {
  const std::string path = temporary("seven.txt");
  write_bytes(path, "1234567");
  EXPECT_EQ(read_bytes(path, 7), "1234567");
  const auto refusal = [](const std::string& file, std::size_t limit) -> std::string {
    try {
      read_bytes(file, limit);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(path, 6), "cannot read " + path + ": 7 bytes are more than the limit of 6");
  EXPECT_EQ(refusal(path + ".no", 6), "cannot read " + path + ".no: no such file");
  const std::string folder = std::filesystem::path(path).parent_path().string();
  EXPECT_EQ(refusal(folder, 6), "cannot read " + folder + ": not a file");
}

}  // namespace
}  // namespace papilla::tests::writer_test
