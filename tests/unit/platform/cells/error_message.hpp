// Error message of the cell reader for a text that it refuses.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"
#include "platform/input_error.hpp"

namespace glint::test {

// Returns the error message, or "accepted" if the reader accepts the text.
inline std::string error_message_for(const std::string& text) {
  try {
    (void)cell_from_text(text, "cell.toml");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace glint::test
