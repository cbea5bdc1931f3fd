#include "report/sums.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/digest.h"
#include "base/text.h"
#include "report/page.h"

namespace papilla::report {
namespace {

void add_names(const Folder& folder, const std::string& before, std::vector<std::string>& names) {
  for (const std::string& name : folder.files()) {
    if (name.front() != '.') names.push_back(before + name);
  }
  for (const std::string& name : folder.folders()) {
    if (name.front() != '.') add_names(folder.below(name), before + name + "/", names);
  }
}

}  // namespace

std::vector<std::string> lasting_files(const Folder& folder) {
  // Clock times; the log of a search that the studio started.
  constexpr std::array<std::string_view, 3> kLeftOut{kPageName, "timing.json", "log.txt"};
  std::vector<std::string> out;
  add_names(folder, "", out);
  std::erase_if(out, [&](const std::string& name) {
    return std::find(kLeftOut.begin(), kLeftOut.end(), name) != kLeftOut.end();
  });
  std::sort(out.begin(), out.end());
  return out;
}

void write_sums(const Folder& folder) {
  std::string out;
  for (const std::string& name : lasting_files(folder)) {
    // A run that goes on appends to its journal, which has sums of its own.
    if (name == kSumsName || name.starts_with("journal")) continue;
    out += sha256(folder.read(name)) + "  " + name + "\n";
  }
  folder.write(kSumsName, out);
}

std::vector<std::string> changed_files(const Folder& folder) {
  constexpr std::size_t kMost = std::size_t{1} << 24, kDigits = 64, kBetween = 2;
  std::vector<std::string> out;
  if (!folder.has(kSumsName)) return out;
  for (const std::string& line : split(folder.read(kSumsName, kMost), '\n')) {
    if (line.size() <= kDigits + kBetween) continue;
    const std::string name = line.substr(kDigits + kBetween);
    if (!folder.has(name) || sha256(folder.read(name)) != line.substr(0, kDigits))
      out.push_back(name);
  }
  return out;
}

}  // namespace papilla::report
