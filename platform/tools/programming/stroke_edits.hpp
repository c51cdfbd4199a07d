// Edits of a drawn path: pure functions of the path and of one line of text.
//
//   delete NAME
//   rename NAME NEW
//   replace NAME NEWER              NEWER, drawn again, takes NAME's place and name
//   offset NAME DIRECTION LENGTH    DIRECTION: x,y,z; tool, away from the tip along the tool's z;
//                                   or normal, of the plane fitted to the stroke, on the tool's
//                                   side
//   mirror NAME POINT NORMAL        about a plane: x,y,z in metres, and a direction x,y,z
//   project NAME NUMBER             onto a plane of the map, numbered from 1
//   approach NAME DIRECTION LENGTH  adds waypoints NAME.approach before and NAME.retract after it
//
// NAME * is every element. A LENGTH has its unit: 2mm, -0.5cm, 0.01m. Vectors are in the robot's
// frame. Covariances follow: an offset along the tool turns with it; a mirrored tool has its y axis
// inverted, so that its frame stays right-handed. A projected point has the plane's variance along
// its normal.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/programming/mapped_planes.hpp"
#include "platform/tools/programming/path.hpp"

namespace glint {

inline constexpr int k_stroke_edits_max = 1000;
inline constexpr std::size_t k_stroke_name_max = 64;  // characters

// Letters, digits, '_', '-' and '.', at most k_stroke_name_max.
[[nodiscard]] bool is_stroke_name(const std::string& name);

// Names elements without a name: "stroke_1", "waypoint_2", by their number in the path. Appends "_"
// to a name that an earlier element has.
[[nodiscard]] DrawnPath named(DrawnPath path);

// Applies the edits in their order. Requires unique names. Throws InputError naming the edit, for
// an unknown verb, name, number or unit, a name that exists, more than k_stroke_edits_max edits,
// an offset along the normal of a straight stroke, and a plane that `planes` does not have.
[[nodiscard]] DrawnPath edited(DrawnPath path, const std::vector<std::string>& edits,
                               const std::vector<MappedPlane>& planes = {});

}  // namespace glint
