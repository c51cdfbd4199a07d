// Conversion of Glint's types to ROS 2 messages. Strings are borrowed and must outlive the message.
#pragma once

#include <array>

#include "diagnostic_msgs.h"
#include "geometry_msgs.h"
#include "glint_msgs.h"
#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/dds/participant.hpp"
#include "tf2_msgs.h"

namespace glint {

using TimeMessage = builtin_interfaces_msg_dds__Time_;
using HeaderMessage = std_msgs_msg_dds__Header_;
using PoseMessage = geometry_msgs_msg_dds__Pose_;
using PoseStampedMessage = geometry_msgs_msg_dds__PoseStamped_;
using PoseCovarianceMessage = geometry_msgs_msg_dds__PoseWithCovarianceStamped_;
using TransformMessage = geometry_msgs_msg_dds__TransformStamped_;
using TfMessage = tf2_msgs_msg_dds__TFMessage_;
using DiagnosticsMessage = diagnostic_msgs_msg_dds__DiagnosticArray_;
using StatusMessage = glint_msgs_msg_dds__TrackStatus_;

// Message strings are char*, although writing only reads them.
[[nodiscard]] inline char* borrowed(const char* text) { return const_cast<char*>(text); }

[[nodiscard]] TopicType pose_stamped_type();
[[nodiscard]] TopicType pose_covariance_type();
[[nodiscard]] TopicType tf_type();
[[nodiscard]] TopicType diagnostics_type();
[[nodiscard]] TopicType status_type();

// Unix time, clamped to 1970..2038.
[[nodiscard]] TimeMessage time_message(Time unix_time);
[[nodiscard]] Time time_of(const TimeMessage& stamp);

[[nodiscard]] HeaderMessage header_message(Time unix_time, const char* frame);
[[nodiscard]] PoseMessage pose_message(const Pose& pose);
// Covariance in row-major order: x, y, z, rotation about fixed axes x, y, z (REP-103).
[[nodiscard]] PoseCovarianceMessage pose_covariance_message(const HeaderMessage& header,
                                                            const Pose& pose,
                                                            const Matrix6& covariance);
[[nodiscard]] TransformMessage transform_message(const HeaderMessage& header, const char* child,
                                                 const Pose& T_frame_child);

}  // namespace glint
