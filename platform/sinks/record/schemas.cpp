#include "platform/sinks/record/schemas.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace glint {
namespace {

struct Definition {
  std::string_view name;  // as fields name it
  std::string_view text;
};

// Field lists of common_interfaces and geometry2, the same from Galactic to Jazzy. The types of
// glint_msgs are Glint's own: fields ending in _ns are monotonic times, headers hold the same time
// since 1970.
constexpr std::array k_definitions{
    Definition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    Definition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    Definition{"geometry_msgs/Pose",
               "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    Definition{"geometry_msgs/PoseWithCovariance",
               "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/PoseWithCovarianceStamped",
               "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    Definition{"geometry_msgs/Transform",
               "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    Definition{"geometry_msgs/TransformStamped",
               "std_msgs/Header header\nstring child_frame_id\n"
               "geometry_msgs/Transform transform\n"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"sensor_msgs/Image",
               "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
               "uint8 is_bigendian\nuint32 step\nuint8[] data\n"},
    Definition{"glint_msgs/PixelRectangle",
               "uint16 x\nuint16 y\nuint16 width\nuint16 height\n"
               "uint8[] reflectivity  # rows, little endian, reflectivity_bits each\n"
               "uint8[] depth         # rows, little endian, 16 bits each; empty without depth\n"},
    Definition{"glint_msgs/FramePatch",
               "std_msgs/Header header  # middle of the exposure\n"
               "int64 mid_exposure_ns\nint64 arrival_ns\nuint32 sequence\n"
               "uint16 width\nuint16 height\n"
               "uint8 reflectivity_bits  # 8, 16, or 0 for none\nbool has_depth\n"
               "bool pixels_in_images    # the two Image messages before this one are its pixels\n"
               "glint_msgs/PixelRectangle[] rectangles  # everywhere else: not recorded\n"
               "int64 stamp_sigma_ns  # of mid_exposure_ns; older recordings have none\n"},
    Definition{"glint_msgs/HeadPose",
               "std_msgs/Header header\nint64 time_ns\nbool valid\n"
               "geometry_msgs/Pose pose  # of the camera in the world\n"},
    Definition{"glint_msgs/Marker",
               "geometry_msgs/Vector3 ray  # unit, camera frame\n"
               "float64 surface_range_m\nfloat64 centroid_x_px\nfloat64 centroid_y_px\n"
               "uint32 area_px\nuint16 blob\nuint8 flags\n"},
    Definition{"glint_msgs/MarkerSigma",
               "float32 x_px\nfloat32 y_px\nfloat32 range_m  # of each 0: not known\n"},
    Definition{"glint_msgs/MarkerTurn",
               "geometry_msgs/Vector3 along_x  # of the ray, by a pixel\n"
               "geometry_msgs/Vector3 along_y  # of each zero: not known\n"},
    Definition{"glint_msgs/MarkerDepth",
               "float32 bias_taken_m  # off surface_range_m: the camera's depth bias\n"
               "uint16 peak           # the brightest pixel, raw; 0: no image gave it\n"},
    Definition{"glint_msgs/Markers",
               "std_msgs/Header header  # middle of the exposure\n"
               "int64 mid_exposure_ns\nint64 arrival_ns\nuint32 sequence\nuint8 reason\n"
               "glint_msgs/Marker[] markers\n"
               "glint_msgs/MarkerSigma[] sigmas  # of the same; older recordings have none\n"
               "glint_msgs/MarkerTurn[] turns    # of the same; older recordings have none\n"
               "glint_msgs/MarkerDepth[] depths  # of the same; older recordings have none\n"
               "uint8 incomplete  # why markers may be missing; older recordings have none\n"
               "int64 stamp_sigma_ns  # of mid_exposure_ns; older recordings have none\n"},
    Definition{"glint_msgs/Choice",
               "std_msgs/Header header\nint64 nominal_ns\nuint64 activation\nuint8 group\n"
               "uint8 overrun  # 0: none; else 1 noticed ahead, 2 missed; plus 4 times the policy\n"
               "int64 unix_offset_ns\n"
               "uint64[] versions  # read of each Latest<> at this release\n"
               "uint8 overrun_after_node  # the last node that ran\n"},
    Definition{"glint_msgs/Output",
               "uint8 STATE_NONE=0\nuint8 STATE_PREDICTED=1\nuint8 STATE_MEASURED=2\n"
               "uint8 STATE_LOST=3\n"
               "std_msgs/Header header  # nominal release of the tick\n"
               "int64 tick_ns\nint64 measurement_ns\nuint32 tick_number\nuint32 frame_sequence\n"
               "uint8 tool\nuint8 state\nuint8 reason\nuint8 marker_mask\n"
               "float64 age_s\nfloat64 sigma_position_m\nfloat64 sigma_orientation_rad\n"
               "uint8[] record  # the bytes that output_sha256 is taken over\n"
               "float64 age_sigma_s  # older recordings have none\n"},
    Definition{"glint_msgs/Dropped",
               "std_msgs/Header header\nint64 mid_exposure_ns\nint64 arrival_ns\n"
               "uint32 sequence\nuint8 reason\n"},
    Definition{"glint_msgs/RobotFrame",
               "uint8 NONE=0\nuint8 GIVEN=1\nuint8 ACCEPTED=2\nuint8 REFUSED=3\n"
               "std_msgs/Header header\nuint64 version  # as a tick's choice names it\n"
               "int64 time_ns\nuint8 state\nbool in_reference\nfloat64 rms_m\n"
               "geometry_msgs/Pose pose  # of the robot in the world, or in the reference body\n"},
    Definition{"glint_msgs/PenButtons",
               "uint8 DRAW=1\nuint8 DELETE_LAST=2\nuint8 UNDO=4\n"
               "std_msgs/Header header\nuint64 version  # as a tick's choice names it\n"
               "int64 time_ns\nuint8 held  # a sum of these\n"},
    Definition{"glint_msgs/Button",
               "uint8 DRAW=0\nuint8 DELETE_LAST=1\nuint8 UNDO=2\nuint8 FINISH=3\n"
               "std_msgs/Header header\nint64 time_ns\nuint8 button\nbool pressed\n"},
};

const Definition& definition(std::string_view name) {
  const auto* found = std::find_if(k_definitions.begin(), k_definitions.end(),
                                   [&](const Definition& d) { return d.name == name; });
  if (found == k_definitions.end()) throw std::logic_error("no message type " + std::string(name));
  return *found;
}

// Adds the types in `text` to `names`, each once, followed by the types of their fields.
void collect_types(std::string_view text, std::vector<std::string_view>& names) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string_view type = line.substr(0, line.find_first_of(" ["));
    if (type.find('/') == std::string_view::npos) continue;
    if (std::find(names.begin(), names.end(), type) != names.end()) continue;
    names.push_back(type);
    collect_types(definition(type).text, names);
  }
}

}  // namespace

std::string schema_text(std::string_view name) {
  std::string short_name(name);
  if (const auto at = short_name.find("/msg/"); at != std::string::npos) short_name.erase(at, 4);
  const std::string_view own = definition(short_name).text;
  std::vector<std::string_view> types;
  collect_types(own, types);
  std::string text(own);
  for (const std::string_view type : types) {
    text += std::string(80, '=') + "\nMSG: " + std::string(type) + "\n";
    text += definition(type).text;
  }
  return text;
}

}  // namespace glint
