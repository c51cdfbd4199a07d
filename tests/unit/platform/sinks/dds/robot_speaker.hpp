// Simulated robot driver and RViz, with its own participant.
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/dds/topic_names.hpp"
#include "tests/unit/platform/sinks/dds/inputs.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {

class SimulatedRobotDriver {
 public:
  SimulatedRobotDriver(std::vector<std::string> joints, std::vector<double> positions)
      : peer_(test_settings()), names_(std::move(joints)), positions_(std::move(positions)) {
    description_ = peer_.writer(text_type(), k_robot_description_topic, Reliability::reliable,
                                Durability::transient_local, 1);
    joint_states_ = peer_.writer(joint_state_type(), k_joint_states_topic, Reliability::best_effort,
                                 Durability::volatile_data, 5);
    guess_ = peer_.writer(pose_covariance_type(), k_initial_pose_topic, Reliability::reliable,
                          Durability::volatile_data, 10);
  }
  // Whether a reader of the joint states and one of the guess are matched.
  [[nodiscard]] bool is_matched() const { return has_reader(joint_states_) && has_reader(guess_); }
  void publish_description(std::string urdf) {
    const TextMessage message{urdf.data()};
    dds_write(description_, &message);
  }
  void move_to(std::vector<double> positions) { positions_ = std::move(positions); }
  void publish_joints() {
    JointText joints(names_, positions_);
    const JointStateMessage message = joints.message();
    dds_write(joint_states_, &message);
  }
  void publish_guess(const Pose& pose, std::string frame = "hmd_tof_optical") {
    PoseCovarianceMessage message = guess_message(frame);
    const Vector3& t = pose.translation;
    const Quaternion& q = pose.rotation;
    message.pose.pose.position = {t.x(), t.y(), t.z()};
    message.pose.pose.orientation = {q.x(), q.y(), q.z(), q.w()};
    dds_write(guess_, &message);
  }
  // The participant, to create readers on.
  [[nodiscard]] Peer& peer() { return peer_; }

 private:
  Peer peer_;
  std::vector<std::string> names_;
  std::vector<double> positions_;
  dds_entity_t description_ = 0, joint_states_ = 0, guess_ = 0;
};

}  // namespace glint
