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
#include "platform/sinks/dds/ros_node.hpp"
#include "platform/sinks/dds/topic_types.hpp"
#include "platform/sinks/record/sha256.hpp"
#include "tests/unit/beside_test.hpp"

namespace glint {
namespace {

// type_description_interfaces/msg/FieldType: number of a plain type; an unbounded sequence adds
// 144, a fixed array 48.
const std::map<std::string, int> plain_types = {
    {"int8", 2},    {"uint8", 3}, {"int32", 6}, {"uint32", 7},  {"uint64", 9},
    {"double", 11}, {"bool", 15}, {"byte", 16}, {"string", 17}, {"bounded string", 21}};
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
      {"rmw_dds_common/Gid", "uint8[16] data"},
      {"rmw_dds_common/NodeEntitiesInfo",
       "string<=256 node_namespace\nstring<=256 node_name\n"
       "rmw_dds_common/Gid[] reader_gid_seq\nrmw_dds_common/Gid[] writer_gid_seq"},
      {"rmw_dds_common/ParticipantEntitiesInfo",
       "rmw_dds_common/Gid gid\nrmw_dds_common/NodeEntitiesInfo[] node_entities_info_seq"},
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
    std::string element = field_type.substr(0, bracket);
    std::string characters_max = "0";
    if (const std::size_t limit = element.find("<="); limit != std::string::npos) {
      characters_max = element.substr(limit + 2);
      element = "bounded string";
    }
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
              ", \"string_capacity\": " + characters_max + ", \"nested_type_name\": \"" +
              nested_name + "\"}}";
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
  EXPECT_EQ(ros_graph_type(RosGraph::iron).type_hash,
            rihs01("rmw_dds_common/ParticipantEntitiesInfo"));
}

// As `ros2 topic info --verbose` of Iron and Jazzy prints them, in public logs and bags, and as
// zenoh-plugin-ros2dds has the last one. No public value of octomap_msgs/Octomap was found.
TEST(TypeHashes, AreThoseThatRos2Publishes) {
  const std::map<std::string, std::string> published = {
      {"geometry_msgs::msg::dds_::PoseStamped_",
       "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
      {"geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
       "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"},
      {"tf2_msgs::msg::dds_::TFMessage_",
       "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {"diagnostic_msgs::msg::dds_::DiagnosticArray_",
       "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
      {"sensor_msgs::msg::dds_::PointCloud2_",
       "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
      {"sensor_msgs::msg::dds_::Image_",
       "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {"sensor_msgs::msg::dds_::CameraInfo_",
       "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
      {"sensor_msgs::msg::dds_::JointState_",
       "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
      {"nav_msgs::msg::dds_::Path_",
       "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"},
      {"std_msgs::msg::dds_::String_",
       "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
      {"std_msgs::msg::dds_::Bool_",
       "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
      {"rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
       "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"}};
  std::size_t compared = 0;
  for (const TopicType& type :
       {pose_stamped_type(), pose_covariance_type(), tf_type(), diagnostics_type(), cloud_type(),
        image_type(), camera_info_type(), joint_state_type(), path_type(), text_type(), bool_type(),
        ros_graph_type(RosGraph::iron)}) {
    const auto found = published.find(type.descriptor->m_typename);
    ASSERT_NE(found, published.end()) << type.descriptor->m_typename;
    EXPECT_EQ(type.type_hash, found->second) << found->first;
    ++compared;
  }
  EXPECT_EQ(compared, published.size());
}

}  // namespace
}  // namespace glint
