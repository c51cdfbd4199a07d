// Number of repetitions of a test over many random cases. A sanitized or emulated build runs fewer
// (GLINT_FEW_REPETITIONS, set by tests/CMakeLists.txt): it checks memory and bits, the release
// build the figures.
#pragma once

#include <cstdlib>

namespace glint::test {

inline int repetitions(int all, int few) {
  return std::getenv("GLINT_FEW_REPETITIONS") == nullptr ? all : few;
}

}  // namespace glint::test
