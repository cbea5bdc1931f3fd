#include "base/installation.h"

#include <dlfcn.h>

namespace papilla::base {
namespace {

namespace fs = std::filesystem;

// Folder of the shared library, or of the program that the static one is part of.
fs::path library_folder() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&library_folder), &info) == 0 || !info.dli_fname) {
    return {};
  }
  // The main program may be known by the word it was called by.
  const fs::path named = fs::canonical(info.dli_fname, error);
  const fs::path file = error ? fs::read_symlink("/proc/self/exe", error) : named;
  return file.parent_path();
}

// The way from the folder of the library, or of a program beside it, to the root of the
// installed tree: one step up per folder of the name.
fs::path root_of(const fs::path& folder) {
  fs::path up = folder;
  const fs::path libdir = PAPILLA_LIBDIR;
  for (auto part = libdir.begin(); part != libdir.end(); ++part) up /= "..";
  const fs::path root = up.lexically_normal();
  return (root / libdir).lexically_normal() == folder ? root : folder.parent_path();
}

}  // namespace

fs::path find_module(const std::string& name) {
  const fs::path folder = library_folder();
  std::error_code error;
  // Beside the library as it is built, above the programs of the tests where it is static, under it
  // as it is installed.
  for (const fs::path& place :
       {folder, folder / "..", folder / "papilla", root_of(folder) / PAPILLA_LIBDIR / "papilla"}) {
    if (fs::exists(place / name, error)) return (place / name).lexically_normal();
  }
  return name;  // wherever the system looks
}

std::vector<std::string> own_designs() {
  std::vector<std::string> found;
  const fs::path folder = library_folder();
  if (folder.empty()) return found;
  // Of the installed tree, or of the build tree: a link to those of the source, beside the library
  // and above the programs of the tests where that is static.
  for (const fs::path& root : {root_of(folder), folder}) {
    std::error_code error;
    const fs::path designs = fs::canonical(root / PAPILLA_DATADIR / "papilla/designs", error);
    if (!error && fs::is_directory(designs, error)) found.push_back(designs.string());
  }
  return found;
}

}  // namespace papilla::base
