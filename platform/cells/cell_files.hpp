// The files that a cell names: opened from disk, or taken from the recording that carries them.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"

namespace glint {

struct CellFileReader {
  Cell& cell;
  const CellFiles* carried;  // null: from disk

  // ${NAME} becomes the environment's NAME; a relative path starts at the cell file's folder. As
  // written where a recording carries the file. Throws InputError: no such NAME.
  [[nodiscard]] std::string resolved(const std::string& path, const std::string& key) const;
  // Adds a file of `glint calibrate` to cell.named_files. Throws InputError: absent.
  const NamedFile& named_file(const std::string& path, const std::string& key) const;
  [[nodiscard]] bool carries(const std::string& key) const {
    return carried != nullptr && carried->named.contains(key);
  }
};

}  // namespace glint
