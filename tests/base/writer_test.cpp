// Files that are written and read whole: what lies on the disk is what was asked for, or an error.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

// More than two blocks of those that are read back at once.
std::string long_text() {
  std::string out;
  while (out.size() < (std::size_t{5} << 19)) out += std::to_string(out.size()) + ",";
  return out;
}

std::string commit_after(const std::function<void(const std::string& part)>& damage) {
  const std::string path = temporary("written.txt");
  write_bytes(path, "before");
  try {
    base::FileWriter out(path);
    const std::string text = long_text();
    out.append(text.substr(0, 1000));
    out.append(text.substr(1000));
    damage(path + ".part");
    out.commit();
  } catch (const InputError& error) {
    EXPECT_EQ(read_bytes(path), "before");  // the old file stays, nothing else is left
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
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
    EXPECT_TRUE(std::filesystem::exists(path + ".part"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
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
}  // namespace papilla::tests
