#include "platform/tools/reference/reference_listener.hpp"

#include <cstdio>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

constexpr Duration k_poll_period = milliseconds(50);  // polling period, and period of on_wait

// Usual publisher of a topic, and the option that replaces it.
std::string source_of(const std::string& topic) {
  if (topic == k_robot_description_topic) {
    return "expected `ros2 run robot_state_publisher robot_state_publisher ARM.urdf`, or --urdf "
           "FILE";
  }
  if (topic == k_joint_states_topic) {
    return "expected the robot's driver or `ros2 run joint_state_publisher joint_state_publisher`, "
           "or --joints FILE";
  }
  return "expected RViz's \"2D Pose Estimate\" or `ros2 topic pub --once /initialpose "
         "geometry_msgs/msg/PoseWithCovarianceStamped ...`, or --initial-pose x,y,z,roll,pitch,yaw";
}

}  // namespace

ReferenceListener::ReferenceListener(const DdsSettings& settings, const ReferenceNeeds& needs,
                                     Duration limit, OnWait on_wait)
    : settings_(settings),
      needs_(needs),
      limit_(limit),
      on_wait_(std::move(on_wait)),
      start_(std::chrono::steady_clock::now()),
      inputs_(DdsProcess::of(settings), settings, {}) {}

std::string ReferenceListener::description() {
  wait_until([&] {
    (void)inputs_.description().sample();
    return inputs_.description().version() > 0;
  });
  return inputs_.description().value().urdf;
}

ReceivedInputs ReferenceListener::wait_for_inputs(const std::vector<std::string>& inputs) {
  all_joints_ = inputs.empty();
  wait_until([&] {
    if (needs_.joints && inputs_.joints().sample()) note_joints(inputs);
    return (all_joints_ || !needs_.joints) &&
           (inputs_.initial_pose().version() > 0 || !needs_.guess);
  });
  return {positions_, inputs_.initial_pose().value()};
}

// Polls once even after the limit: loading a robot takes time, and messages may be waiting.
template <class Done>
void ReferenceListener::wait_until(Done done) {
  while (true) {
    inputs_.read(k_poll_period);
    (void)inputs_.initial_pose().sample();
    if (done()) return;
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start_;
    if (waited.count() > limit_.seconds()) throw_timeout();
    std::string topics;
    for (const std::string& topic : missing()) topics += (topics.empty() ? "" : ", ") + topic;
    if (on_wait_) on_wait_(waited.count(), topics);
  }
}

void ReferenceListener::note_joints(const std::vector<std::string>& inputs) {
  std::vector<double> positions(inputs.size());
  const std::size_t found = positions_of(inputs_.joints().value(), inputs, positions);
  if (found < inputs.size()) {
    missing_joint_ = inputs[found];
    return;
  }
  all_joints_ = true;
  positions_ = std::move(positions);
}

std::vector<std::string> ReferenceListener::missing() const {
  const ReceivedCounts counts = inputs_.counts();
  std::vector<std::string> topics;
  if (needs_.description && counts.descriptions == 0)
    topics.emplace_back(k_robot_description_topic);
  const bool joints = all_joints_ || (missing_joint_.empty() && counts.joints > 0);
  if (needs_.joints && !joints) topics.emplace_back(k_joint_states_topic);
  if (needs_.guess && counts.guesses == 0) topics.emplace_back(k_initial_pose_topic);
  return topics;
}

void ReferenceListener::throw_timeout() const {
  char head[96];
  std::snprintf(head, sizeof head, "--listen: %.1f s on ", limit_.seconds());
  std::string text = head + settings_.interface + ", domain " + std::to_string(settings_.domain);
  for (const std::string& topic : missing()) {
    const bool partly = topic == k_joint_states_topic && !missing_joint_.empty();
    text += "; " + topic +
            (partly ? ": no state with one position of joint '" + missing_joint_ +
                          "'; expected one message with all of the robot's joints"
                    : ": no message; " + source_of(topic));
  }
  const std::uint64_t refused = inputs_.counts().refused;
  if (refused > 0) text += "; " + std::to_string(refused) + " invalid messages";
  throw InputError(text);
}

}  // namespace glint
