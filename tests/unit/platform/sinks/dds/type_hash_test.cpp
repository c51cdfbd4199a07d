// Recomputes the endpoints' type hashes from the message definitions. RIHS01 is the SHA-256 of the
// descriptions of a type and of all types that it refers to, as JSON with a space after each comma
// and colon (ROS 2 type_description_interfaces; rosidl_generator_type_description).
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_types.hpp"
#include "platform/sinks/record/sha256.hpp"
#include "tests/unit/beside_test.hpp"

namespace glint {
namespace {

// type_description_interfaces/msg/FieldType: number of a plain type; an unbounded sequence adds
// 144, a fixed array 48.
const std::map<std::string, int> plain_types = {{"int8", 2},   {"uint8", 3},  {"int32", 6},
                                                {"uint32", 7}, {"uint64", 9}, {"double", 11},
                                                {"bool", 15},  {"byte", 16},  {"string", 17}};
constexpr int k_nested = 1, k_array = 48, k_sequence = 144;

using Definitions = std::map<std::string, std::string>;  // type name to definition

Definitions ros_definitions() {
  Definitions types = {
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
      {"geometry_msgs/Point", "double x\ndouble y\ndouble z"},
      {"geometry_msgs/Vector3", "double x\ndouble y\ndouble z"},
      {"geometry_msgs/Quaternion", "double x\ndouble y\ndouble z\ndouble w"},
      {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\ndouble[36] covariance"},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose"},
      {"geometry_msgs/Transform",
       "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform"},
      {"std_msgs/Bool", "bool data"},
      {"std_msgs/String", "string data"},
      {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count"},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
       "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense"},
      {"sensor_msgs/Image",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
       "uint8 is_bigendian\nuint32 step\nuint8[] data"},
      {"sensor_msgs/RegionOfInterest",
       "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify"},
      {"sensor_msgs/CameraInfo",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
       "double[] d\ndouble[9] k\ndouble[9] r\ndouble[12] p\nuint32 binning_x\n"
       "uint32 binning_y\nsensor_msgs/RegionOfInterest roi"},
      {"sensor_msgs/JointState",
       "std_msgs/Header header\nstring[] name\ndouble[] position\ndouble[] velocity\n"
       "double[] effort"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses"},
      {"octomap_msgs/Octomap",
       "std_msgs/Header header\nbool binary\nstring id\ndouble resolution\nint8[] data"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
      {"diagnostic_msgs/KeyValue", "string key\nstring value"},
      {"diagnostic_msgs/DiagnosticStatus",
       "byte level\nstring name\nstring message\nstring hardware_id\n"
       "diagnostic_msgs/KeyValue[] values"},
      {"diagnostic_msgs/DiagnosticArray",
       "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status"},
  };
  std::ostringstream text;
  text << std::ifstream(path_beside_test("TrackStatus.msg")).rdbuf();
  types["glint_msgs/TrackStatus"] = text.str();
  return types;
}

std::string full_name(const std::string& type) {
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "/msg" + type.substr(slash);
}

// Description of one type. Adds the types that it refers to to `nested`.
std::string description(const Definitions& types, const std::string& type,
                        std::set<std::string>& nested) {
  std::string fields;
  std::istringstream lines(types.at(type));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string field_type, name;
    if (!(words >> field_type >> name)) continue;
    const std::size_t bracket = field_type.find('[');
    const std::string element = field_type.substr(0, bracket);
    const std::string size = bracket == std::string::npos ? "" : field_type.substr(bracket + 1);
    const auto plain = plain_types.find(element);
    int id = plain == plain_types.end() ? k_nested : plain->second;
    if (!size.empty()) id += size == "]" ? k_sequence : k_array;
    const std::string capacity =
        size.empty() || size == "]" ? "0" : size.substr(0, size.size() - 1);
    const std::string nested_name = plain == plain_types.end() ? full_name(element) : "";
    if (!nested_name.empty() && nested.insert(element).second) {
      (void)description(types, element, nested);
    }
    fields += (fields.empty() ? "" : ", ") + ("{\"name\": \"" + name) +
              "\", \"type\": {\"type_id\": " + std::to_string(id) + ", \"capacity\": " + capacity +
              ", \"string_capacity\": 0, \"nested_type_name\": \"" + nested_name + "\"}}";
  }
  return "{\"type_name\": \"" + full_name(type) + "\", \"fields\": [" + fields + "]}";
}

std::string rihs01(const std::string& type) {
  const Definitions types = ros_definitions();
  std::set<std::string> nested, ignored;
  std::string text = "{\"type_description\": " + description(types, type, nested) +
                     ", \"referenced_type_descriptions\": [";
  for (const std::string& one : nested) {
    text += (one == *nested.begin() ? "" : ", ") + description(types, one, ignored);
  }
  text += "]}";
  Sha256 hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return hash.hex();
}

TEST(TypeHashes, AreThoseOfTheMessageDefinitions) {
  EXPECT_EQ(pose_stamped_type().type_hash, rihs01("geometry_msgs/PoseStamped"));
  EXPECT_EQ(pose_covariance_type().type_hash, rihs01("geometry_msgs/PoseWithCovarianceStamped"));
  EXPECT_EQ(tf_type().type_hash, rihs01("tf2_msgs/TFMessage"));
  EXPECT_EQ(diagnostics_type().type_hash, rihs01("diagnostic_msgs/DiagnosticArray"));
  EXPECT_EQ(cloud_type().type_hash, rihs01("sensor_msgs/PointCloud2"));
  EXPECT_EQ(octomap_type().type_hash, rihs01("octomap_msgs/Octomap"));
  EXPECT_EQ(path_type().type_hash, rihs01("nav_msgs/Path"));
  EXPECT_EQ(image_type().type_hash, rihs01("sensor_msgs/Image"));
  EXPECT_EQ(camera_info_type().type_hash, rihs01("sensor_msgs/CameraInfo"));
  EXPECT_EQ(joint_state_type().type_hash, rihs01("sensor_msgs/JointState"));
  EXPECT_EQ(text_type().type_hash, rihs01("std_msgs/String"));
  EXPECT_EQ(bool_type().type_hash, rihs01("std_msgs/Bool"));
  EXPECT_EQ(status_type().type_hash, rihs01("glint_msgs/TrackStatus"));
}

}  // namespace
}  // namespace glint
