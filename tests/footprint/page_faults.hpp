// Page faults of all threads of the process, minor and major.
#pragma once

#include <sys/resource.h>

namespace glint::footprint {

[[nodiscard]] inline long page_faults() noexcept {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace glint::footprint
