// Bad use or bad input (exit code 2), and a device or peer that is not there (exit code 3). The
// message names the file, the place in it, what was found and what was expected, in one line.
#pragma once

#include <stdexcept>

namespace glint {

struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct MissingDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace glint
