// Locks the process's memory against paging.
#pragma once

#include <string>

namespace glint {

struct MemoryLock {
  bool locked = false;
  std::string refused;  // reason if not locked
};

// Locks all present and future pages if the process may lock without a limit. Under a limit it does
// nothing: once the limit is reached, every later allocation would fail.
[[nodiscard]] MemoryLock lock_memory();

}  // namespace glint
