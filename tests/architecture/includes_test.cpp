// Who may include whom: lower layers never know higher ones, pieces of physics never each other,
// and a library of others stays inside the sources of one folder.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/architecture/source_tree.h"

namespace papilla {
namespace {

// The folder that a file belongs to: "base", "physics/contact", "optim", ...
std::string module_of(std::string path) {
  if (path.starts_with("src/")) path.erase(0, 4);
  const std::size_t slash = path.find('/');
  if (path.starts_with("physics/")) return path.substr(0, path.find('/', 8));
  return path.substr(0, slash);
}

const std::map<std::string, std::set<std::string>>& allowed() {
  static const std::map<std::string, std::set<std::string>> table = [] {
    std::map<std::string, std::set<std::string>> t;
    t["base"] = {};
    t["config"] = {"base"};
    t["optim"] = {"base"};
    t["geometry"] = {"base", "config"};
    t["scene"] = {"base", "config"};
    t["fields"] = {"base", "geometry"};
    t["physics"] = {"base", "geometry", "scene", "fields"};
    t["forward"] = {"base", "config", "geometry", "scene", "fields", "physics"};
    t["metrics"] = {"base", "forward"};
    const auto add = [&](std::initializer_list<const char*> names, std::set<std::string> below) {
      for (const char* name : names) t[name] = below;
    };
    std::set<std::string> below{"base",  "config",  "geometry", "scene",  "fields",
                                "optim", "physics", "forward",  "metrics"};
    add({"design"}, below);
    below.insert("design");
    add({"estimate"}, below);
    below.insert("estimate");
    add({"published"}, below);
    below.insert("published");
    // Side by side: none knows another.
    const std::initializer_list<const char*> rooms{"search",  "rank",      "calibrate", "claims",
                                                   "measure", "fabricate", "cases"};
    add(rooms, below);
    below.insert(rooms.begin(), rooms.end());
    add({"report"}, below);
    below.insert("report");
    add({"cli"}, below);
    below.insert("papilla");  // include/papilla: what other programs see
    add({"api"}, below);
    return t;
  }();
  return table;
}

bool may_include(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const std::string layer = from.starts_with("physics/") ? "physics" : from;
  const auto rules = allowed().find(layer);
  if (rules == allowed().end()) return false;
  return rules->second.count(to.starts_with("physics/") ? "physics" : to) > 0;
}

const std::vector<std::string> kFolders{"src", "geometry", "optim"};

TEST(Includes, GoOnlyDownTheLayers) {
  const std::regex include("#include \"([^\"]+)\"");
  int seen = 0;
  for (const std::string& file : source_files(kFolders, {".h", ".cpp"})) {
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
      const std::string name = (*it)[1];
      EXPECT_TRUE(may_include(module_of(file), module_of(name))) << file << " includes " << name;
      ++seen;
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Includes, TheRulesRefuseWhatTheyShould) {
  EXPECT_FALSE(may_include("physics/contact", "physics/capillary"));
  EXPECT_FALSE(may_include("optim", "geometry"));
  EXPECT_FALSE(may_include("geometry", "scene"));
  EXPECT_FALSE(may_include("base", "config"));
  EXPECT_TRUE(may_include("physics/contact", "geometry"));
  EXPECT_TRUE(may_include("forward", "physics/contact"));
}

TEST(Includes, LibrariesOfOthersStayInTheSourcesOfOneFolder) {
  const std::vector<std::pair<std::string, std::string>> libraries{
      {"toml++", "toml\\+\\+/"}, {"OpenImageIO", "OpenImageIO/"},
      {"NLopt", "nlopt"},        {"pagmo", "pagmo/"},
      {"Ceres", "ceres/"},       {"FFTW", "fftw3"},
      {"MPI", "mpi\\.h"},        {"CLI11", "CLI/"},
  };
  for (const auto& [name, pattern] : libraries) {
    const std::regex include("#include [<\"]" + pattern);
    std::set<std::string> folders;
    for (const std::string& file : source_files(kFolders, {".h", ".cpp"})) {
      const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
      if (!std::regex_search(text, include)) continue;
      EXPECT_TRUE(file.ends_with(".cpp")) << name << " in the header " << file;
      folders.insert(file.substr(0, file.rfind('/')));
    }
    EXPECT_LE(folders.size(), 1u) << name << " is included from several folders";
  }
}

}  // namespace
}  // namespace papilla
