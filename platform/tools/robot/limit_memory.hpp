// Memory limit of a separate program that a library may crash: shared by such programs alone.
#pragma once

#include <sys/resource.h>

namespace glint {

// An address sanitizer reserves terabytes of address space, so the limit is not set there.
inline void limit_memory(rlim_t bytes) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#ifndef GLINT_SANITIZED
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_AS, &limit);
#else
  (void)bytes;
#endif
}

}  // namespace glint
