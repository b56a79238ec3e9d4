#include "core/large_arrays.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tumble {

void give_large_arrays_back() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);  // and by being set it no longer grows
#endif
}

}  // namespace tumble
