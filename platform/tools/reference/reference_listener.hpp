// DDS inputs of a reference run that no file supplies: robot description, joint positions, and
// initial guess of the base's pose.
//
// The publisher of a description retains it for late subscribers. A guess is a single message, for
// example from RViz: the listener waits for it from the start. The newest joint state counts when
// all other inputs are present; a state that lacks a joint of the robot is ignored.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "platform/sinks/dds/dds_inputs.hpp"

namespace glint {

struct ReferenceNeeds {
  bool description = false, joints = false, guess = false;
};

struct ReceivedInputs {
  std::vector<double> positions;  // one per input of the robot, if joints are needed
  ReceivedInitialPose guess;
};

class ReferenceListener {
 public:
  // Called while waiting, with the time so far and the missing topics.
  using OnWait = std::function<void(double seconds, const std::string& topics)>;

  // Throws as Participant does. `limit` covers all waiting together.
  ReferenceListener(const DdsSettings& settings, const ReferenceNeeds& needs, Duration limit,
                    OnWait on_wait);

  // Each waits for its needed inputs. Throws InputError after the limit: names every missing topic,
  // with its usual publisher or the option that replaces it.
  [[nodiscard]] std::string description();
  [[nodiscard]] ReceivedInputs wait_for_inputs(const std::vector<std::string>& inputs);

 private:
  template <class Done>
  void wait_until(Done done);
  void note_joints(const std::vector<std::string>& inputs);
  [[nodiscard]] std::vector<std::string> missing() const;
  [[noreturn]] void throw_timeout() const;

  DdsSettings settings_;
  ReferenceNeeds needs_;
  Duration limit_;
  OnWait on_wait_;
  std::chrono::steady_clock::time_point start_;
  DdsInputs inputs_;
  bool all_joints_ = false;  // received a state with every joint
  std::vector<double> positions_;
  std::string missing_joint_;  // joint missing in the newest ignored state
};

}  // namespace glint
