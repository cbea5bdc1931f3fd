// A folder that somebody else made: nothing in it runs, leads the program out of it, or holds it
// up.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "tests/cli/program.h"

namespace papilla::tests::strangers_test {
namespace {

namespace fs = std::filesystem;

const std::string kHoles = PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml";

class Strangers : public ::testing::Test {
 protected:
  Strangers() {
    place_.write("mine.txt", "mine");
    ::chmod((place_.path() / "mine.txt").c_str(), 0600);
    fs::create_directory(place_.path() / "folder");
  }
  // In the folder, to what is the user's.
  void link(const std::string& name, const std::string& to = "../mine.txt") const {
    fs::create_symlink(to, place_.path() / "folder" / name);
  }
  void expect_untouched() const {
    EXPECT_EQ(file_text(place_.path() / "mine.txt"), "mine");
    EXPECT_EQ(fs::status(place_.path() / "mine.txt").permissions(), static_cast<fs::perms>(0600));
  }
  bool is_file(const std::string& name) const {
    return fs::symlink_status(place_.path() / "folder" / name).type() == fs::file_type::regular;
  }

  Workplace place_;
};

// Every library that the program loads, planted where it is called: with a shared folder in the way
// to look for them it would not even start.
TEST_F(Strangers, LibrariesInTheWorkingFolderAreNotLoaded) {
  const Outcome loaded = place_.shell("ldd '" PAPILLA_PROGRAM "' | awk '{ print $1 }'");
  std::istringstream names(loaded.out);
  int planted = 0;
  for (std::string name; names >> name;) {
    if (name.find('/') != name.npos || !name.starts_with("lib")) continue;
    place_.write("folder/" + name, "no library");
    ++planted;
  }
  EXPECT_GT(planted, 10);
  const Outcome ran = place_.shell("cd folder && '" PAPILLA_PROGRAM "' --version --licences");
  EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(Strangers, LinksInAnExportsFolderAreReplaced) {
  for (const char* name : {"heightmap.exr", "heightmap.part.exr", "heightmap.gsf", "heightmap.npy",
                           "export.json", "export.json.part", "mask.tif", "layout.gds"})
    link(name);
  const Outcome done = place_.run("export " + kHoles +
                                  " --pixels 64 --polarity white-deep --format "
                                  "exr,gsf,npy,mask,gds --out folder");
  EXPECT_EQ(done.status, 0) << done.err;
  expect_untouched();
  for (const char* name : {"heightmap.exr", "heightmap.gsf", "heightmap.npy", "export.json"})
    EXPECT_TRUE(is_file(name)) << name;
}

TEST_F(Strangers, LinksInARunsFolderAreReplacedOrRefused) {
  const std::string run = "optimize " PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml --out ";
  for (const char* name : {"journal", ".lock"}) {
    fs::remove(place_.path() / "folder" / name);
    link(name);
    const Outcome refused = place_.run(run + "folder");
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("is a link, which is not followed here"), std::string::npos)
        << refused.err;
    fs::remove(place_.path() / "folder" / name);
  }
  link("response.json");
  link("resolved.toml");
  const Outcome evaluated = place_.run(
      "evaluate " + kHoles + " --set accuracy.level=draft --set accuracy.grid=32 --out folder");
  EXPECT_EQ(evaluated.status, 0) << evaluated.err;
  EXPECT_TRUE(is_file("response.json"));
  expect_untouched();
}

// A file that the user names himself is where its links lead.
TEST_F(Strangers, LinksThatTheUserNamesAreFollowed) {
  place_.write("design.toml", "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n");
  link("mine.toml", "../design.toml");
  const Outcome read = place_.run("explain folder/mine.toml");
  EXPECT_EQ(read.status, 0) << read.err;
}

// At once, with words; the test's own limit of time ends what waits.
TEST_F(Strangers, PipesAndDevicesAreRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((place_.path() / "pipe").c_str(), 0600), 0);
  for (const char* ending : {"toml", "npy", "gsf", "exr", "tif", "png", "x3p", "csv"})
    fs::create_symlink("pipe", place_.path() / (std::string("pipe.") + ending));
  ::mkfifo((place_.path() / "folder/journal").c_str(), 0600);
  for (const std::string& arguments :
       {std::string("evaluate pipe"), std::string("evaluate pipe.toml"),
        std::string("evaluate /dev/zero"), std::string("explain /dev/stdin"),
        std::string("optimize /dev/zero --out out"), std::string("rank pipe.toml pipe"),
        std::string("surface pipe.npy"), std::string("surface pipe.gsf --size 1um"),
        std::string("surface pipe.exr"), std::string("surface pipe.tif --size 1um"),
        std::string("surface pipe.png"), std::string("surface pipe.x3p"),
        std::string("calibrate pipe.toml"), std::string("verify pipe"), std::string("report pipe"),
        "export " + kHoles + " --dose-curve pipe.csv --format dose --out out",
        "export " + kHoles + " --dose-curve /dev/zero --format dose --out out",
        std::string("optimize " PAPILLA_SOURCE_DIR
                    "/designs/m3_glass/conformal.toml --resume --out folder")}) {
    const Outcome done = place_.shell("timeout 20 '" PAPILLA_PROGRAM "' " + arguments);
    EXPECT_EQ(done.status, 2) << arguments << "\n" << done.err;
    EXPECT_NE(done.err.find("error: "), std::string::npos) << arguments << "\n" << done.err;
  }
}

TEST_F(Strangers, EscapesInTheirFilesAreShownNotSent) {
  const std::string file =
      place_.write("folder/a.toml",
                   "schema_version = 1\n\"key\\u001b[2J\\u001b]0;x\\u0007\" = 1\n"
                   "[texture]\ntype = \"hole\\u009b31m\"\n");
  const Outcome done = place_.run("evaluate " + file);
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("key\\x1b[2J\\x1b]0;x\\x07"), std::string::npos) << done.err;
  for (const char* raw : {"\x1b", "\x07", "\xc2\x9b"})
    EXPECT_EQ(done.err.find(raw), std::string::npos) << done.err;
  const Outcome named = place_.run("evaluate 'no\x1b[31m.toml'");
  EXPECT_NE(named.err.find("no\\x1b[31m.toml"), std::string::npos) << named.err;
}

TEST_F(Strangers, NamesThatAreNoUtf8AreRefusedBeforeTheWork) {
  const Outcome bash = place_.shell("bash -c \"'" PAPILLA_PROGRAM "' export " + kHoles +
                                    " --pixels 64 --out \\$'r\\\\xe9s'\"");
  EXPECT_EQ(bash.status, 2);
  EXPECT_NE(bash.err.find("r\\xe9s\" is no UTF-8"), std::string::npos) << bash.err;
  EXPECT_FALSE(fs::exists(place_.path() / "r\xe9s"));
}

// What a limit on files ends is told and leaves nothing.
TEST_F(Strangers, AFileThatMayNotGrowLeavesNothing) {
  const Outcome done = place_.shell("ulimit -f 8; '" PAPILLA_PROGRAM "' export " + kHoles +
                                    " --pixels 256 --format npy --out folder");
  EXPECT_TRUE(done.status == 1 || done.status == 2) << done.status << done.err;
  EXPECT_NE(done.err.find("File too large"), std::string::npos) << done.err;
  EXPECT_TRUE(fs::is_empty(place_.path() / "folder"));
}

TEST_F(Strangers, UnknownKeysWithoutEndAreToldOnce) {
  std::string text = "schema_version = 1\n";
  for (int i = 0; i < 20000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  const Outcome done = place_.run("evaluate " + place_.write("folder/many.toml", text));
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("the last of 19950 more unknown keys"), std::string::npos);
  EXPECT_LT(done.err.size(), 40000u);
}

TEST_F(Strangers, ATitleWithoutEndIsRefused) {
  const Outcome done = place_.run(
      "evaluate " + place_.write("folder/long.toml", "schema_version = 1\ntitle = \"" +
                                                         std::string(10000000, 'x') + "\"\n"));
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("title: longer than 1000 letters"), std::string::npos);
  EXPECT_LT(done.err.size(), 1000u);
}

}  // namespace
}  // namespace papilla::tests::strangers_test
