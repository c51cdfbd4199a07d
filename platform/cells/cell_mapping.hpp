// Readers of [background] and [mapping] of a cell: the slices of mapping below tracking.
#pragma once

#include <functional>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// Either table may be null. Both null: no background group. Only mapping: default slices. `path`
// resolves the path of a key.
using ResolvedPath = std::function<std::string(const std::string& path, const std::string& key)>;
void read_background(const toml::table* background, const toml::table* mapping,
                     const ResolvedPath& path, Cell& cell);
// Call after the robot is read. Throws InputError unless a tracked robot has a pose in the world.
void check_tracked_robot(const toml::table* mapping, const Cell& cell);

}  // namespace glint
