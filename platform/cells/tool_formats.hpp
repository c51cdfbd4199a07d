// The formats behind load_tool. Each takes a file's content; `path` stands in messages only.
#pragma once

#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// What no tool exceeds, from its frame's origin: larger numbers are a mistaken unit.
inline constexpr double k_tool_coordinate_max_mm = 2000.0;

// NDI: magic "NDI", u16 at 4 = sum of the bytes from 6 on, marker count at 28, x, y, z as float32
// in millimetres from 72, all little-endian. It states no radius: NDI's passive spheres have 5.75
// mm; nor a tip: it is the origin.
[[nodiscard]] Tool tool_from_rom_bytes(std::string_view bytes, const std::string& path);

// Atracsys: [geometry] count=, [fiducial0..] x= y= z= in millimetres, [pivot] x= y= z= the tip
// (otherwise the origin). It states no radius: Atracsys' passive spheres have 5.75 mm too.
[[nodiscard]] Tool tool_from_ini_text(std::string_view text, const std::string& path);

inline constexpr double k_passive_sphere_radius_mm = 5.75;

// The file's name without folder and ending, for formats that carry none.
[[nodiscard]] std::string stem_of(const std::string& path);

// `place` is "path:line" or "path". Throws InputError for a name that is empty, too long
// or not printable.
void set_name(Tool& tool, const std::string& name, const std::string& place);

// Throws InputError unless 3 to 8 markers were found.
void check_marker_count(long long count, const std::string& place);

// Fills the distances; throws InputError where the markers fix no pose.
[[nodiscard]] Tool prepared(Tool tool, const std::string& place);

}  // namespace glint
