#include "search/differing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace papilla::search {
namespace {

// The values of a resolved file by their path, as it is written there.
std::vector<std::pair<std::string, std::string>> resolved_values(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> out;
  std::istringstream lines(text);
  std::string table;
  std::map<std::string, int> count;  // of an array's tables
  for (std::string line; std::getline(lines, line);) {
    line.erase(std::min(line.find("  # "), line.size()));
    if (line.starts_with("[[")) {
      table = line.substr(2, line.size() - 4);
      table += fmt::format("[{}].", count[table]++);
    } else if (line.starts_with("[")) {
      table = line.substr(1, line.size() - 2) + ".";
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      out.emplace_back(table + line.substr(0, equals), line.substr(equals + 3));
    }
  }
  return out;
}

}  // namespace

std::string differing_keys(const std::string& there, const std::string& here) {
  // With which a run may be continued.
  const std::set<std::string> free{"search.evaluations", "search.jobs", "search.time",
                                   "search.rounding",    "risk.belief", "risk.limits"};
  const auto known = resolved_values(there), own = resolved_values(here);
  const std::map<std::string, std::string> before(known.begin(), known.end()),
      now(own.begin(), own.end());
  std::string out;
  int left = 3;
  const auto add = [&](const std::string& path, const std::string& a, const std::string& b) {
    if (a == b || free.count(path) > 0 || left-- <= 0) return;
    out += fmt::format("{}{} {}, {}", out.empty() ? "" : "; ", path, a, b);
  };
  const auto value = [](const std::map<std::string, std::string>& of, const std::string& path) {
    const auto found = of.find(path);
    return found == of.end() ? std::string("none") : found->second;
  };
  for (const auto& [path, text] : own) add(path, value(before, path), text);
  for (const auto& [path, text] : known) {
    if (now.count(path) == 0) add(path, text, "none");
  }
  return out;
}

}  // namespace papilla::search
