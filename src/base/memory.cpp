#include "base/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace papilla::base {

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 28);  // larger blocks are mapped and returned one by one
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

double memory_limit() {
  double limit =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    limit = std::min(limit, static_cast<double>(space.rlim_cur));
  }
  double group = 0;  // "max" without a limit: not a number
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> group && group > 0) {
    limit = std::min(limit, group);
  }
  return limit;
}

void require_memory(double bytes, const std::string& what) {
  const double limit = memory_limit();
  if (!(bytes <= limit)) {
    throw InputError(fmt::format("{} needs {:.2g} GiB of memory; {:.2g} GiB are there", what,
                                 bytes / 1073741824, limit / 1073741824));
  }
}

bool has_address_space(std::size_t bytes) {
  void* const place =
      ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED) return false;
  ::munmap(place, bytes);
  return true;
}

}  // namespace papilla::base
