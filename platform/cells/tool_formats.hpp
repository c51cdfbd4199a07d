// Parsers of the formats behind load_tool. Input: a file's contents; `path` is for messages only.
#pragma once

#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Limit on coordinates in the tool's frame; larger numbers indicate a wrong unit.
inline constexpr double k_tool_coordinate_max_mm = 2000.0;

// NDI: magic "NDI", u16 at 4 = sum of the bytes from 6 on, marker count at 28, x, y, z as float32
// in millimetres from 72, all little-endian. The format has neither radius (NDI's passive spheres:
// 5.75 mm) nor tip (set to the origin).
[[nodiscard]] Tool tool_from_rom_bytes(std::string_view bytes, const std::string& path);

// Atracsys: [geometry] count=, [fiducial0..] x= y= z= in millimetres, [pivot] x= y= z= the tip
// (default: the origin). The format has no radius (Atracsys' passive spheres: 5.75 mm too).
[[nodiscard]] Tool tool_from_ini_text(std::string_view text, const std::string& path);

inline constexpr double k_passive_sphere_radius_mm = 5.75;

// Returns the file name without folder and extension, for formats without a tool name.
[[nodiscard]] std::string stem_of(const std::string& path);

// place: "path:line" or "path". Throws InputError for a name that is empty, too long or not
// printable.
void set_name(Tool& tool, const std::string& name, const std::string& place);

// Throws InputError unless the count is 3 to 8.
void check_marker_count(long long count, const std::string& place);

// Computes the distances. Throws InputError if the markers do not determine a pose.
[[nodiscard]] Tool prepared(Tool tool, const std::string& place);

}  // namespace glint
