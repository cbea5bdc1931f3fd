// Who is let in, and which files a page may name.
#include "studio/safety.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "tests/temporary.h"

namespace papilla::tests::safety_test {
namespace {

namespace fs = std::filesystem;

Sender page(const std::string& path) {
  return {path, "127.0.0.1:8123", "http://127.0.0.1:8123", "same-origin", true};
}

TEST(Door, LetsItsOwnPageIn) {
  const Door door("abc", 8123);
  EXPECT_EQ(door.judge(page("/abc/set")), Entry::Admitted);
  EXPECT_EQ(door.below_token("/abc/set"), "/set");
  EXPECT_EQ(door.address(), "http://127.0.0.1:8123/abc/");
  Sender typed{"/abc/", "localhost:8123", "", "none", false};  // an address that a person entered
  EXPECT_EQ(door.judge(typed), Entry::Admitted);
}

TEST(Door, RefusesAnotherTokenOrNone) {
  const Door door("abc", 8123);
  for (const char* path : {"/", "/abd/", "/ab/", "/abcd/", "/set", "//abc/", ""})
    EXPECT_EQ(door.judge(page(path)), Entry::WrongToken) << path;
}

// DNS rebinding: a name of somebody else that leads to this computer.
TEST(Door, RefusesAnotherHost) {
  const Door door("abc", 8123);
  for (const char* host : {"evil.example:8123", "127.0.0.1", "127.0.0.1:80", "", "[::1]:8123"}) {
    Sender sender = page("/abc/");
    sender.host = host;
    EXPECT_EQ(door.judge(sender), Entry::WrongHost) << host;
  }
}

TEST(Door, RefusesThePageOfAnotherSite) {
  const Door door("abc", 8123);
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8123",
                             "http://127.0.0.1:81", "http://localhost:8123"}) {
    Sender sender = page("/abc/set");
    sender.origin = origin;
    EXPECT_EQ(door.judge(sender), Entry::WrongOrigin) << origin;
  }
  Sender sender = page("/abc/set");
  sender.origin = "";
  sender.fetch_site = "cross-site";
  EXPECT_EQ(door.judge(sender), Entry::WrongOrigin);
  sender.changes = false;  // an image or a frame of another site
  EXPECT_EQ(door.judge(sender), Entry::WrongOrigin);
  sender.fetch_site = "none";
  sender.changes = true;
  EXPECT_EQ(door.judge(sender), Entry::WrongOrigin);
}

TEST(Token, IsLongAndNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    seen.insert(token);
  }
  EXPECT_EQ(seen.size(), 100u);
}

TEST(Inside, TakesNamesInTheFolder) {
  const TemporaryFolder place;
  EXPECT_EQ(inside(place.path(), "a/b.toml"), fs::weakly_canonical(place.path() / "a/b.toml"));
  EXPECT_EQ(inside(place.path(), "µ 1.toml").filename(), "µ 1.toml");
}

TEST(Inside, RefusesWhatLeadsOut) {
  const TemporaryFolder place;
  fs::create_directories(place.path() / "in");
  fs::create_symlink("/", place.path() / "in/link");
  fs::create_symlink("/etc/passwd", place.path() / "in/passwd.toml");
  fs::create_directories(place.path() / "inside");  // a neighbour whose name begins alike
  for (const char* name :
       {"", "/etc/passwd", "../x", "a/../../x", "a/..", ".", "./a", ".hidden", "a/.b",
        "link/etc/passwd", "passwd.toml", "a\nb", "C:\\x", "a\\..\\b", "../inside/x"})
    EXPECT_THROW(inside(place.path() / "in", name), InputError) << name;
}

}  // namespace
}  // namespace papilla::tests::safety_test
