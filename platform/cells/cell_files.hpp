// Access to the files named by a cell: from disk, or from a recording that contains them.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"

namespace glint {

struct CellFileReader {
  Cell& cell;
  const CellFiles* recorded_files;  // null: from disk

  // Replaces ${NAME} by the environment variable; relative paths start at the cell file's folder.
  // Returns the path unchanged if a recording contains the file. Throws InputError: unknown
  // variable.
  [[nodiscard]] std::string resolved(const std::string& path, const std::string& key) const;
  // Adds a file of `glint calibrate` to cell.named_files. Throws InputError if it is absent.
  const NamedFile& named_file(const std::string& path, const std::string& key) const;
  [[nodiscard]] bool is_recorded(const std::string& key) const {
    return recorded_files != nullptr && recorded_files->named.contains(key);
  }
};

}  // namespace glint
