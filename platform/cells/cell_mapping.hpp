// The parts of a cell file that say what runs beneath tracking: mapping, slice by slice.
#pragma once

#include <functional>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// Either may be null: then there is no such group; what is mapped has slices as built in. `path`
// resolves a path that a key names.
using ResolvedPath = std::function<std::string(const std::string& path, const std::string& key)>;
void read_background(const toml::table* background, const toml::table* mapping,
                     const ResolvedPath& path, Cell& cell);
// When the robot was read, too: one that is followed stands in the world.
void check_followed_robot(const toml::table* mapping, const Cell& cell);

}  // namespace glint
