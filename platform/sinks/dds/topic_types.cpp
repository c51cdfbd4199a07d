#include "platform/sinks/dds/topic_types.hpp"

#include "platform/sinks/dds/messages.hpp"

namespace glint {

// Hashes as published with ROS 2; a test recomputes them from the definitions.
TopicType cloud_type() {
  return {&sensor_msgs_msg_dds__PointCloud2__desc,
          "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"};
}
TopicType octomap_type() {
  return {&octomap_msgs_msg_dds__Octomap__desc,
          "9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0"};
}
TopicType path_type() {
  return {&nav_msgs_msg_dds__Path__desc,
          "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"};
}
TopicType image_type() {
  return {&sensor_msgs_msg_dds__Image__desc,
          "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"};
}
TopicType camera_info_type() {
  return {&sensor_msgs_msg_dds__CameraInfo__desc,
          "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"};
}
TopicType joint_state_type() {
  return {&sensor_msgs_msg_dds__JointState__desc,
          "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"};
}
TopicType text_type() {
  return {&std_msgs_msg_dds__String__desc,
          "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"};
}
TopicType bool_type() {
  return {&std_msgs_msg_dds__Bool__desc,
          "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"};
}

std::optional<TopicType> type_named(std::string_view name) {
  for (const TopicType& type :
       {pose_stamped_type(), pose_covariance_type(), tf_type(), diagnostics_type(), status_type(),
        image_type(), camera_info_type(), joint_state_type(), text_type(), bool_type()}) {
    if (name == type.descriptor->m_typename) return type;
  }
  return {};
}

}  // namespace glint
