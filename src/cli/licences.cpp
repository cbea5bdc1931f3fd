#include "cli/licences.h"

#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "base/module.h"
#include "geometry/io/files.h"

namespace papilla::cli {
namespace {

struct Library {
  std::string name, licence, use;
  std::vector<std::string> files{};  // how their names begin; none: compiled in
  bool gpl = false;                  // binds who passes the binary on
};

const std::vector<Library>& known() {
  static const std::vector<Library> libraries{
      {"Eigen", "MPL-2.0", "linear algebra"},
      {"toml++", "MIT", "design files"},
      {"CLI11", "BSD-3-Clause", "command line"},
      {"JSON for Modern C++", "MIT", "results"},
      {"Chart.js, three.js", "MIT", "pages"},
      {"{fmt}", "MIT", "text", {"libfmt"}},
      {"zlib", "Zlib", "compression", {"libz.so"}},
      {"libzip", "BSD-3-Clause", "X3P files", {"libzip"}},
      {"bzip2", "bzip2-1.0.6", "of libzip", {"libbz2"}},
      {"pugixml", "MIT", "X3P files", {"libpugixml"}},
      {"libmd", "BSD-3-Clause, public domain", "sums of files", {"libmd.so"}},
      {"NLopt", "MIT, parts LGPL-2.1-or-later", "searches", {"libnlopt"}},
      {"cpp-httplib", "MIT", "studio", {"libcpp-httplib"}},
      {"OpenSSL", "Apache-2.0", "of cpp-httplib, libzip", {"libssl", "libcrypto"}},
      {"Brotli", "MIT", "of cpp-httplib", {"libbrotli"}},
      {"Open MPI", "BSD-3-Clause", "clusters", {"libmpi", "libopen-"}},
      {"libevent, hwloc", "BSD-3-Clause", "of Open MPI", {"libevent", "libhwloc"}},
      {"libudev", "LGPL-2.1-or-later", "of Open MPI", {"libudev"}},
      {"OpenEXR, Imath",
       "BSD-3-Clause",
       "images",
       {"libOpenEXR", "libImath", "libIex", "libIlmThread"}},
      {"GCC's runtime",
       "GPL-3.0-or-later WITH GCC-exception-3.1: binds no program",
       "C++, threads",
       {"libstdc++", "libgcc_s", "libgomp", "libgfortran", "libquadmath"}},
      {"GNU C library",
       "LGPL-2.1-or-later",
       "system",
       {"libc.so", "libm.so", "libpthread", "libdl.so", "librt.so", "libmvec", "ld-linux"}},
      {"FFTW", "GPL-2.0-or-later", "Fourier transforms", {"libfftw3"}, true},
      {"pagmo", "GPL-3.0-or-later or LGPL-3.0-or-later", "searches", {"libpagmo"}},
      {"oneTBB, Boost", "Apache-2.0, BSL-1.0", "of pagmo", {"libtbb", "libboost"}},
      {"Ceres",
       "BSD-3-Clause",
       "fits",
       {"libceres", "libglog"}},  // linked statically: its log tells
      {"gflags, LAPACK, ATLAS, METIS",
       "BSD-3-Clause, Apache-2.0",
       "of Ceres",
       {"libgflags", "libunwind", "liblzma", "liblapack", "libblas", "libf77blas", "libatlas",
        "libmetis"}},
      {"SuiteSparse",
       "LGPL-2.1-or-later, BSD-3-Clause",
       "of Ceres",
       {"libamd", "libcamd", "libcolamd", "libccolamd", "libcxsparse", "libsuitesparse"}},
      {"SuiteSparse: CHOLMOD", "GPL-2.0-or-later", "of Ceres", {"libcholmod", "libspqr"}, true},
      {"OpenImageIO", "BSD-3-Clause", "images", {"libOpenImageIO"}},
      {"x264, x265, Xvid, Poppler, JBIG-KIT",
       "GPL-2.0-or-later",
       "of OpenImageIO, unused",
       {"libx264", "libx265", "libxvidcore", "libpoppler", "libjbig"},
       true},
  };
  return libraries;
}

std::set<std::string> loaded_files() {
  geometry::require_images();
  for (const char* name : kModules) module_loads(name);
  std::set<std::string> out;
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* names) {
        const std::string file = std::filesystem::path(object->dlpi_name).filename();
        const bool own = file.empty() || file.starts_with("libpapilla") ||
                         file.starts_with("papilla") || file.starts_with("linux-vdso");
        if (!own) static_cast<std::set<std::string>*>(names)->insert(file);
        return 0;
      },
      &out);
  return out;
}

// Takes the library's files out of `loaded`; false: there were none.
bool take(const Library& library, std::set<std::string>& loaded) {
  const auto of_library = [&](const std::string& file) {
    return std::any_of(library.files.begin(), library.files.end(),
                       [&](const std::string& start) { return file.starts_with(start); });
  };
  return std::erase_if(loaded, of_library) > 0 || library.files.empty();
}

}  // namespace

std::string licences() {
  std::set<std::string> others = loaded_files();
  bool gpl = false;
  std::string out = "papilla " PAPILLA_VERSION "\n\n| library | licence | for |\n|---|---|---|\n";
  out += "| Papilla's own sources | Apache-2.0 | |\n";
  for (const Library& library : known()) {
    if (!take(library, others)) continue;
    gpl = gpl || library.gpl;
    out += fmt::format("| {} | {} | {} |\n", library.name, library.licence, library.use);
  }
  if (!others.empty()) {
    out += fmt::format("\n{} more that these bring have terms of their own, {} to {}.\n",
                       others.size(), *others.begin(), *others.rbegin());
  }
  out += gpl ? "\nWho passes this build on does so under the GPL 3, with the sources."
             : "\nNo library of this build is under the GPL.";
  return out;
}

}  // namespace papilla::cli
