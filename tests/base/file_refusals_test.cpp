// What may be written over and what not, through links as well, and what a refusal says.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <iterator>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "base/installation.h"
#include "tests/temporary.h"

namespace papilla::tests::file_refusals_test {
namespace {

namespace fs = std::filesystem;

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Files, AreWrittenUnderTheirNameAndBehindNoLink) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "file.txt", link = folder.path() / "link";
  EXPECT_EQ(base::end_of_links(file), file);  // none there yet
  write_bytes(file, "one");
  EXPECT_EQ(base::end_of_links(file), file);
  fs::create_symlink("file.txt", link);
  EXPECT_EQ(base::end_of_links(link), fs::canonical(file));
  write_bytes(base::end_of_links(link), "two");  // a link that the user named
  EXPECT_EQ(read_bytes(file), "two");
  EXPECT_TRUE(fs::is_symlink(link));
  write_bytes(link, "three");  // any other
  EXPECT_FALSE(fs::is_symlink(link));
  EXPECT_EQ(read_bytes(link), "three");
  EXPECT_EQ(read_bytes(file), "two");
  fs::create_symlink("nowhere", folder.path() / "dangling");
  write_bytes(folder.path() / "dangling", "four");
  EXPECT_FALSE(fs::exists(folder.path() / "nowhere"));
  write_bytes(file, "");
  EXPECT_EQ(read_bytes(file), "");
  EXPECT_EQ(fs::file_size(file), 0u);
}

TEST(Files, WhatARenameWouldDestroyIsRefused) {
  const TemporaryFolder folder;
  const std::string here = folder.path(), inside = here + "/sub", pipe = here + "/pipe";
  fs::create_directory(inside);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal([&] { write_bytes(inside, "x"); }),
            "cannot write " + inside + ": it is a folder; give the path of a file");
  EXPECT_EQ(refusal([&] { write_bytes(pipe, "x"); }),
            "cannot write " + pipe + ": it is no regular file; give the path of a file");
  fs::create_directory_symlink("sub", here + "/link");
  EXPECT_EQ(refusal([&] { write_bytes(base::end_of_links(here + "/link"), "x"); }),
            "cannot write " + inside + ": it is a folder; give the path of a file");
  const std::string nowhere = here + "/none/file";
  EXPECT_EQ(refusal([&] { write_bytes(nowhere, "x"); }),
            "cannot write " + nowhere + ": No such file or directory (open)");
  EXPECT_EQ(refusal([&] { read_bytes(pipe); }), "cannot read " + pipe + ": not a file");
}

TEST(Files, ThatAreTakenAwayMeanwhileAreNotTakenForWritten) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "file.txt";
  {
    base::FileWriter out(file);
    out.append("abc");
    out.append("");
    out.append(std::string("def"));
    for (const auto& entry : fs::directory_iterator(folder.path())) fs::remove(entry.path());
    EXPECT_EQ(refusal([&] { out.commit(); }),
              "cannot write " + file + ": No such file or directory (rename)");
  }
  EXPECT_FALSE(fs::exists(file));
  {
    base::FileWriter out(file);  // a folder of its name appears
    out.append("abc");
    fs::create_directory(file);
    EXPECT_EQ(refusal([&] { out.commit(); }), "cannot write " + file + ": Is a directory (rename)");
  }
  EXPECT_TRUE(fs::is_directory(file));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

// The bytes in the right order, however they are handed over.
TEST(Files, PiecesOfAnySizeAreOneText) {
  const std::string file = temporary("pieces.bin");
  std::string all;
  base::FileWriter out(file);
  for (int k = 0; k < 3000; ++k) {
    const std::string piece(static_cast<std::size_t>(k % 7) * 100, static_cast<char>(k));
    out.append(piece.data(), piece.size());
    all += piece;
  }
  EXPECT_FALSE(fs::exists(file));
  out.commit();
  EXPECT_TRUE(read_bytes(file) == all);
}

TEST(Checks, SayWhereTheyAreAndWhatTheyAskedFor) {
  const auto said = [](const char* message) -> std::string {
    try {
      base::check_failed("a == b", "src/some.cpp", 42, message);
    } catch (const InternalError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(said("they differ"), "src/some.cpp:42: check failed: a == b (they differ)");
  EXPECT_EQ(said(""), "src/some.cpp:42: check failed: a == b");
  EXPECT_NO_THROW(PAPILLA_CHECK(1 + 1 == 2, "sums"));
  EXPECT_THROW(PAPILLA_CHECK(1 + 1 == 3, "sums"), InternalError);
}

// In the build tree those of the source, by a link; a module that is nowhere keeps its name for the
// system.
TEST(Installation, KnowsItsDesignsAndLeavesUnknownModulesToTheSystem) {
  const std::vector<std::string> designs = base::own_designs();
  ASSERT_FALSE(designs.empty());
  EXPECT_EQ(designs.back(), fs::canonical(fs::path(PAPILLA_SOURCE_DIR) / "designs").string());
  for (const std::string& folder : designs) EXPECT_TRUE(fs::is_directory(folder)) << folder;
  EXPECT_EQ(base::find_module("libpapilla_of_nowhere.so"), "libpapilla_of_nowhere.so");
}

TEST(Files, AreWrittenWhereAChainOfLinksEndsThereOrNot) {
  const TemporaryFolder folder;
  const fs::path within = folder.path() / "within";
  fs::create_directory(within);
  fs::create_symlink("within/second", folder.path() / "first");
  fs::create_symlink("file.txt", within / "second");  // from its own folder
  write_bytes(base::end_of_links(folder.path() / "first"), "one");
  EXPECT_EQ(read_bytes(within / "file.txt"), "one");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "first"));
  EXPECT_TRUE(fs::is_symlink(within / "second"));
  fs::create_symlink("round", folder.path() / "round");
  EXPECT_NE(refusal([&] { base::end_of_links(folder.path() / "round"); }).find("lead nowhere"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::file_refusals_test
