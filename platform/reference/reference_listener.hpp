// What a reference needs and no file gives, heard over DDS: the robot's description, its joint
// positions, and a guess of where it stands.
//
// A description is kept by its publisher for whoever comes later. A guess is a single message from
// somebody at RViz: it is waited for from the beginning. Of joint states that which is the newest
// when all else is there counts; one that lacks a joint of the robot's is another robot's part.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "platform/dds/dds_inputs.hpp"

namespace glint {

struct ReferenceNeeds {
  bool description = false, joints = false, guess = false;
};

struct HeardPlace {
  std::vector<double> positions;  // where joints were needed: one for each of the robot's inputs
  HeardGuess guess;
};

class ReferenceListener {
 public:
  // While it waits: for how long so far, and for which topics.
  using OnWait = std::function<void(double seconds, const std::string& topics)>;

  // Throws as Participant does. The limit is of all waiting together.
  ReferenceListener(const DdsSettings& settings, const ReferenceNeeds& needs, Duration limit,
                    OnWait on_wait);

  // Each waits for what is needed of it. Throw InputError when time is over: every topic that was
  // not heard, and who publishes it or which option stands for it.
  [[nodiscard]] std::string description();
  [[nodiscard]] HeardPlace place(const std::vector<std::string>& inputs);

 private:
  template <class Done>
  void wait_until(Done done);
  void note_joints(const std::vector<std::string>& inputs);
  [[nodiscard]] std::vector<std::string> missing() const;
  [[noreturn]] void refuse() const;

  DdsSettings settings_;
  ReferenceNeeds needs_;
  Duration limit_;
  OnWait on_wait_;
  std::chrono::steady_clock::time_point start_;
  DdsInputs inputs_;
  bool all_joints_ = false;  // a state with each of them was heard
  std::vector<double> positions_;
  std::string lacking_;  // what the newest state that did not count lacks
};

}  // namespace glint
