// What a program or a library asks of the system that loads it, as readelf tells it.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::tests {

inline bool is_elf(const std::filesystem::path& file) {
  std::array<char, 4> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  return std::string(head.data(), head.size()) ==
         "\x7f"
         "ELF";
}

inline std::string readelf(const std::filesystem::path& file) {
  std::string out;
  FILE* pipe = ::popen(("readelf -hldW '" + file.string() + "' 2>&1").c_str(), "r");
  if (!pipe) return out;
  std::array<char, 4096> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
    out.append(block.data(), n);
  ::pclose(pipe);
  return out;
}

// Folders that libraries are looked for in, beside the system's. An empty one is the folder of
// whoever calls the program, where a stranger's library may lie.
inline std::vector<std::string> library_folders(const std::string& told) {
  std::vector<std::string> out;
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("(RUNPATH)") == line.npos && line.find("(RPATH)") == line.npos) continue;
    const std::size_t from = line.find('[') + 1;
    const std::string list = line.substr(from, line.rfind(']') - from);
    for (std::size_t begin = 0;;) {
      const std::size_t end = list.find(':', begin);
      out.push_back(list.substr(begin, end - begin));
      if (end == list.npos) break;
      begin = end + 1;
    }
  }
  return out;
}

// What is missing of: libraries from the system and from places relative to itself alone, tables
// that are read only once it is loaded, a stack that does not run, an address nobody knows.
inline std::string missing_protection(const std::filesystem::path& file) {
  const std::string told = readelf(file);
  std::string out;
  for (const std::string& folder : library_folders(told)) {
    if (!folder.starts_with("$ORIGIN")) out += "looks for libraries in \"" + folder + "\"; ";
  }
  const auto has = [&](const char* text) { return told.find(text) != told.npos; };
  if (!has("GNU_RELRO")) out += "no RELRO; ";
  if (!has("BIND_NOW") && !has("Flags: NOW")) out += "bound as it is called; ";
  if (!has("DYN (")) out += "loaded at a known address; ";
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("GNU_STACK") != line.npos && line.find("RWE") != line.npos)
      out += "its stack runs; ";
  }
  return out;
}

}  // namespace papilla::tests
