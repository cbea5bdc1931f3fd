#include "base/memory.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace papilla {

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 28);  // larger blocks are mapped and returned one by one
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

}  // namespace papilla
