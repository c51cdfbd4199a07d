// What the cell reader says of a text that it refuses.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"
#include "platform/input_error.hpp"

namespace glint::test {

// "accepted" where it does not refuse it.
inline std::string complaint_about(const std::string& text) {
  try {
    (void)cell_from_text(text, "cell.toml");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace glint::test
