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

// Field lists of common_interfaces and geometry2, the same from
// Galactic to Jazzy; of visualization_msgs from Humble on. The types of
// glint_msgs are Glint's own package (platform/sinks/dds/glint_msgs): fields ending in _ns are
// monotonic times, headers hold the same time since 1970.
constexpr std::array k_definitions{
#include "glint_msgs_definitions.inc"  // Definition{name, text}, ... made from glint_msgs/msg/*.msg
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
    Definition{"sensor_msgs/RegionOfInterest",
               "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n"
               "bool do_rectify\n"},
    Definition{"sensor_msgs/CameraInfo",
               "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
               "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
               "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    Definition{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/String", "string data\n"},
    Definition{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    Definition{"sensor_msgs/CompressedImage",
               "std_msgs/Header header\nstring format\nuint8[] data\n"},
    Definition{"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    Definition{"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    Definition{"visualization_msgs/Marker",
               "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
               "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
               "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
               "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
               "string texture_resource\nsensor_msgs/CompressedImage texture\n"
               "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
               "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
               "bool mesh_use_embedded_materials\n"},
    Definition{"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
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
