// Keeps the process's memory from being paged out.
#pragma once

#include <string>

namespace glint {

struct MemoryLock {
  bool locked = false;
  std::string refused;  // the reason where it is not
};

// Locks all pages, present and future, where the process may lock without a limit. Under a limit it
// leaves things as they are: once that is reached, every later allocation would fail.
[[nodiscard]] MemoryLock lock_memory();

}  // namespace glint
