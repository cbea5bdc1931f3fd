// Folders by their handles: what a stranger put into one leads nowhere, and is not waited for.
#include "base/folder.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/sole_writer.h"
#include "tests/temporary.h"

namespace papilla::tests::folder_test {
namespace {

namespace fs = std::filesystem;
using base::FolderLock;

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

constexpr const char* kLink =
    "is a link, which is not followed here; put what it leads to in its place";

class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    fs::create_directories(outside_.path() / "deep");
    std::ofstream(outside_.path() / "mine.txt") << "mine";
    std::ofstream(outside_.path() / "deep/mine.txt") << "mine";
  }
  std::string path(const std::string& name) const { return place_.path() / name; }
  // Nothing of the user's has changed.
  void expect_untouched() const {
    EXPECT_EQ(read_bytes(outside_.path() / "mine.txt"), "mine");
    EXPECT_EQ(read_bytes(outside_.path() / "deep/mine.txt"), "mine");
    EXPECT_EQ(std::distance(fs::recursive_directory_iterator(outside_.path()), {}), 3);
  }

  TemporaryFolder place_, outside_;
  Folder folder_{place_.path()};
};

TEST_F(FolderTest, ReadsAndWritesBelowItself) {
  folder_.write("a.txt", "one");
  EXPECT_EQ(folder_.read("a.txt"), "one");
  EXPECT_EQ(folder_.file("a.txt"), path("a.txt"));
  folder_.made_below("b/c").write("d.txt", "two");
  EXPECT_EQ(folder_.read("b/c/d.txt"), "two");
  EXPECT_EQ(folder_.below("b").read_from("c/d.txt", 1), "wo");
  EXPECT_EQ(folder_.read_from("b/c/d.txt", 9), "");
  EXPECT_TRUE(folder_.has("b/c/d.txt"));
  EXPECT_FALSE(folder_.has("b/c"));
  EXPECT_TRUE(folder_.has_folder("b/c"));
  EXPECT_FALSE(folder_.has_folder("b/x/y"));
  EXPECT_EQ(folder_.files(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(folder_.folders(), std::vector<std::string>{"b"});
  EXPECT_EQ(refusal([&] { folder_.read("none"); }),
            "cannot read " + path("none") + ": no such file");
  folder_.remove("b");
  folder_.remove("b");
  EXPECT_FALSE(fs::exists(path("b")));
  EXPECT_EQ(refusal([&] { Folder(path("none")); }), path("none") + ": No such file or directory");
  EXPECT_EQ(refusal([&] { Folder(path("a.txt")); }), path("a.txt") + ": not a folder");
}

TEST_F(FolderTest, RefusesNamesThatLeadOut) {
  for (const char* name : {"", "/etc/passwd", "..", "../x", "a/../b", ".", "a/.", "a//../b"}) {
    EXPECT_THROW(folder_.has(name), InputError) << name;
    EXPECT_THROW(folder_.read(name), InputError) << name;
    EXPECT_THROW(folder_.write(name, "x"), InputError) << name;
    EXPECT_THROW(folder_.made_below(name), InputError) << name;
    EXPECT_THROW(folder_.remove(name), InputError) << name;
  }
  expect_untouched();
}

TEST_F(FolderTest, FollowsNoLinkOfAFile) {
  fs::create_symlink(outside_.path() / "mine.txt", path("link"));
  fs::create_symlink(outside_.path() / "not there", path("dangling"));
  for (const char* name : {"link", "dangling"}) {
    EXPECT_FALSE(folder_.has(name));
    EXPECT_EQ(refusal([&] { folder_.read(name); }), "cannot read " + path(name) + ": " + kLink);
    EXPECT_EQ(refusal([&] { folder_.file(name); }), "cannot read " + path(name) + ": " + kLink);
    EXPECT_EQ(refusal([&] { folder_.open_to_write(name); }),
              "cannot write " + path(name) + ": " + kLink);
    folder_.write(name, "of the folder");
    EXPECT_EQ(folder_.read(name), "of the folder");
    fs::remove(path(name));
    fs::create_symlink(outside_.path() / "mine.txt", path(name));
    folder_.write_secret(name, "secret");
    EXPECT_EQ(folder_.read(name), "secret");
    EXPECT_EQ(fs::status(path(name)).permissions(), static_cast<fs::perms>(0600));
    fs::remove(path(name));
    fs::create_symlink(outside_.path() / "mine.txt", path(name));
    folder_.remove(name);
    EXPECT_FALSE(fs::is_symlink(path(name)));
  }
  expect_untouched();
}

TEST_F(FolderTest, FollowsNoLinkOfAFolder) {
  fs::create_directory_symlink(outside_.path(), path("link"));
  EXPECT_FALSE(folder_.has("link/mine.txt"));
  EXPECT_FALSE(folder_.has("link/deep/mine.txt"));
  EXPECT_FALSE(folder_.has_folder("link"));
  EXPECT_TRUE(folder_.folders().empty());
  const std::string why = path("link") + ": " + kLink;
  EXPECT_EQ(refusal([&] { folder_.below("link"); }), why);
  EXPECT_EQ(refusal([&] { folder_.made_below("link/new"); }), why);
  EXPECT_EQ(refusal([&] { folder_.read("link/mine.txt"); }), why);
  EXPECT_EQ(refusal([&] { folder_.write("link/mine.txt", "x"); }), why);
  EXPECT_EQ(refusal([&] { folder_.open_to_write("link/new.txt"); }), why);
  folder_.remove("link/mine.txt");
  folder_.remove("link");  // itself alone
  EXPECT_FALSE(fs::is_symlink(path("link")));
  // A folder that holds one goes without what that leads to.
  fs::create_directory(path("old"));
  fs::create_directory_symlink(outside_.path(), path("old/link"));
  folder_.remove("old");
  EXPECT_FALSE(fs::exists(path("old")));
  expect_untouched();
}

// A link to the folder itself is the user's own way there; what it becomes meanwhile is no matter.
TEST_F(FolderTest, StaysWhereItWasOpened) {
  const std::string way = path("way");
  fs::create_directory(path("here"));
  fs::create_directory_symlink("here", way);
  const Folder folder(way);
  fs::remove(way);
  fs::create_directory_symlink(outside_.path(), way);
  folder.write("mine.txt", "of the folder");
  EXPECT_EQ(read_bytes(path("here/mine.txt")), "of the folder");
  expect_untouched();
}

// At once: a pipe that nobody writes into, a socket, a folder, a device that never ends.
TEST_F(FolderTest, ReadsRegularFilesAlone) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_directory(path("folder"));
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  ASSERT_LT(path("socket").size(), sizeof at.sun_path);
  path("socket").copy(at.sun_path, sizeof at.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
  for (const char* name : {"pipe", "folder", "socket"}) {
    EXPECT_FALSE(folder_.has(name));
    EXPECT_THROW(folder_.read(name), InputError) << name;
    EXPECT_THROW(folder_.file(name), InputError) << name;
    EXPECT_THROW(folder_.read_from(name, 0), InputError) << name;
    EXPECT_THROW(folder_.open_to_write(name), InputError) << name;
    EXPECT_EQ(refusal([&] { read_bytes(path(name)); }),
              "cannot read " + path(name) + ": not a file");
    EXPECT_EQ(refusal([&] { base::RegularFile(path(name)); }),
              "cannot read " + path(name) + ": not a file");
  }
  ::close(socket);
  for (const char* device : {"/dev/zero", "/dev/null"}) {
    EXPECT_EQ(refusal([&] { read_bytes(device); }),
              std::string("cannot read ") + device + ": not a file");
    EXPECT_EQ(refusal([&] { base::RegularFile{device}; }),
              std::string("cannot read ") + device + ": not a file");
  }
}

TEST_F(FolderTest, AFileThatIsHeldIsReadByNameWhateverItsPathMeansByThen) {
  folder_.write("map", "heights");
  const base::RegularFile held(path("map"));
  EXPECT_EQ(held.bytes(), 7u);
  folder_.remove("map");
  ASSERT_EQ(::mkfifo(path("map").c_str(), 0600), 0);
  for (int k = 0; k < 2; ++k) EXPECT_EQ(read_bytes(held.name()), "heights");
  std::string first;
  held.stream() >> first;
  EXPECT_EQ(first, "heights");
}

TEST_F(FolderTest, IsLockedByOneProcess) {
  const FolderLock lock(folder_, ".lock", "another one is here");
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string why = refusal([&] { FolderLock(folder_, ".lock", "another one is here"); });
    ::_exit(why == place_.path().string() + ": another one is here in this folder" ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  fs::create_symlink(outside_.path() / "mine.txt", path("link"));
  EXPECT_THROW(FolderLock(folder_, "link", "x"), InputError);
  expect_untouched();
}

TEST_F(FolderTest, HasOneWriterAtATime) {
  const std::string said = place_.path().string() + ": another one is writing in this folder";
  {
    const base::SoleWriter one(folder_, "another one is writing");
    EXPECT_EQ(refusal([&] { base::SoleWriter(folder_, "another one is writing"); }), said);
    EXPECT_EQ(refusal([&] { base::SoleWriter(Folder(outside_.path()), "x"); }), "");
  }
  EXPECT_EQ(refusal([&] { base::SoleWriter(folder_, "another one is writing"); }), "");
  EXPECT_TRUE(fs::is_empty(place_.path()));
}

}  // namespace
}  // namespace papilla::tests::folder_test
