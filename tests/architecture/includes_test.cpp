// Who may include whom: lower layers never know higher ones, pieces of physics never each other,
// and a library of others stays inside the sources of one folder.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::includes_test {
namespace {

// The room that a file belongs to, by its namespace: "base", "contact", "optim", ...
std::string room_of(std::string path) {
  if (path.starts_with("src/")) path.erase(0, 4);
  if (path.starts_with("physics/")) path.erase(0, 8);
  const std::string folder = path.substr(0, path.find('/'));
  return folder == "fields" ? "maps" : folder;  // fields() is the word for the keys of a struct
}

// Of each room, the rooms that it sees: the directives of base/rooms.h and what follows from them.
const std::map<std::string, std::set<std::string>>& seen_rooms() {
  static const std::map<std::string, std::set<std::string>> table = [] {
    const std::string text = read_source(PAPILLA_SOURCE_DIR "/src/base/rooms.h");
    const std::regex line("namespace ([a-z]+) \\{|using namespace ([a-z]+);");
    std::map<std::string, std::set<std::string>> t;
    std::string room;
    for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
      if ((*it)[1].matched) {
        room = (*it)[1];
        t[room];
      } else {
        const std::set<std::string> below = t.at((*it)[2]);  // named before
        t[room].insert((*it)[2]);
        t[room].insert(below.begin(), below.end());
      }
    }
    t["api"] = t.at("rooms");
    t["api"].insert("papilla");  // include/papilla: what other programs see
    // Of what they see, these take less: exchanged maps no keys, metrics a response alone.
    t["maps"].erase("config");
    t["metrics"] = {"base", "numerics", "forward"};
    return t;
  }();
  return table;
}

bool may_include(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const auto rules = seen_rooms().find(from);
  return rules != seen_rooms().end() && rules->second.count(to) > 0;
}

const std::vector<std::string> kFolders{"src", "geometry", "optim"};

TEST(Includes, GoOnlyDownTheLayers) {
  int seen = 0;
  for (const std::string& file : source_files(kFolders, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const auto& [opening, name] : includes_of(text)) {
      if (opening != '"') continue;
      // The list of quantities is what the model answers and what other programs see.
      const bool everywhere = name == "base/rooms.h" || name == "papilla/quantities.h";
      EXPECT_TRUE(may_include(room_of(file), room_of(name)) || everywhere)
          << file << " includes " << name;
      ++seen;
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Includes, TheRulesRefuseWhatTheyShould) {
  EXPECT_FALSE(may_include("contact", "capillary"));
  EXPECT_FALSE(may_include("optim", "geometry"));
  EXPECT_FALSE(may_include("geometry", "scene"));
  EXPECT_FALSE(may_include("base", "config"));
  EXPECT_TRUE(may_include("contact", "geometry"));
  EXPECT_FALSE(may_include("search", "report"));
  EXPECT_FALSE(may_include("calibrate", "claims"));
  EXPECT_FALSE(may_include("metrics", "geometry"));
  EXPECT_TRUE(may_include("forward", "contact"));
  EXPECT_TRUE(may_include("report", "search"));
}

TEST(Includes, EveryFileLivesInTheNamespaceOfItsRoom) {
  int files = 0;
  for (const std::string& file : source_files(kFolders, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    if (text.find("namespace papilla") == std::string::npos) continue;
    if (file == "src/base/rooms.h" || file == "src/base/check.h") continue;
    EXPECT_NE(text.find("namespace papilla::" + room_of(file)), std::string::npos) << file;
    ++files;
  }
  EXPECT_GT(files, 200);
}

TEST(Includes, PublicHeadersIncludeTheStandardLibraryAndEachOtherOnly) {
  for (const std::string& file : source_files({"include"}, {".h"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const auto& [opening, name] : includes_of(text)) {
      EXPECT_TRUE(opening == '<'
                      ? name.find('/') == std::string::npos && name.find('.') == std::string::npos
                      : name.starts_with("papilla/"))
          << file << " includes " << name;
    }
  }
}

TEST(Includes, TheBindingsOfPythonKnowThePublicHeadersAlone) {
  int seen = 0;
  for (const std::string& file : source_files({"python/bindings"}, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const auto& [opening, name] : includes_of(text)) {
      if (opening == '"') {
        EXPECT_EQ(name.find('/'), std::string::npos) << file << " includes " << name;
      } else if (name.find('/') != std::string::npos) {
        EXPECT_TRUE(name.starts_with("papilla/") || name.starts_with("pybind11/"))
            << file << " includes " << name;
      }
      ++seen;
    }
  }
  EXPECT_GT(seen, 20);
}

TEST(Includes, LibrariesOfOthersStayInTheSourcesOfOneFolder) {
  struct Library {
    std::string name;
    std::vector<std::string> headers;  // that their names begin with
    std::set<std::string> folders;     // that include it
  };
  std::vector<Library> libraries{
      {"toml++", {"toml++/"}, {}},     {"OpenImageIO", {"OpenImageIO/"}, {}},
      {"NLopt", {"nlopt"}, {}},        {"pagmo", {"pagmo/"}, {}},
      {"Ceres", {"ceres/"}, {}},       {"FFTW", {"fftw3"}, {}},
      {"MPI", {"mpi.h"}, {}},          {"CLI11", {"CLI/"}, {}},
      {"pybind11", {"pybind11/"}, {}}, {"cpp-httplib", {"httplib"}, {}},
      {"zlib", {"zlib.h"}, {}},        {"libzip", {"zip.h"}, {}},
      {"pugixml", {"pugixml"}, {}},    {"libmd", {"md5.h", "sha2.h"}, {}},
  };
  for (const std::string& file : source_files(kFolders, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const auto& [opening, included] : includes_of(text)) {
      for (Library& library : libraries) {
        if (std::none_of(library.headers.begin(), library.headers.end(),
                         [&](const std::string& h) { return included.starts_with(h); }))
          continue;
        EXPECT_TRUE(file.ends_with(".cpp")) << library.name << " in the header " << file;
        library.folders.insert(file.substr(0, file.rfind('/')));
      }
    }
  }
  for (const Library& library : libraries)
    EXPECT_LE(library.folders.size(), 1u) << library.name << " is included from several folders";
}

}  // namespace
}  // namespace papilla::tests::includes_test
