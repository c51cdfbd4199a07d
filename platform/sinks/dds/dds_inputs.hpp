// DDS inputs, read on a thread of their own: joint states, robot description, initial guess of the
// robot's pose, the pen's buttons, and tool changes.
//
// States go to triple buffers, read as Latest<>: only the newest counts. Each change of a button
// goes to a callback, and so does each tool change. A held button is
// released when its sender leaves the domain, cleanly or by its lease, or is silent for the
// settings' timeout. They come from the DDS process in serialised form. An oversized or invalid
// message is rejected and counted; so is one that the settings' access control does not admit.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "graph/latest.hpp"
#include "platform/sinks/dds/dds_process.hpp"
#include "platform/sinks/dds/received_messages.hpp"
#include "platform/sinks/record/button_event.hpp"

namespace glint {

struct ReceivedCounts {
  // Received messages.
  std::uint64_t joints = 0, descriptions = 0, guesses = 0, buttons = 0, tools = 0;
  std::uint64_t refused = 0;   // all refused messages
  InputRefusals refusals;      // of these, by access control
  std::uint64_t lost = 0;      // read too late
  std::uint64_t released = 0;  // buttons whose sender left or timed out
  [[nodiscard]] bool any() const {
    return joints + descriptions + guesses + buttons + tools + refused > 0;
  }
};

class DdsInputs {
 public:
  using OnButton = std::function<void(const ButtonEvent&)>;
  // The tool with this index in the settings is present from now on, or removed.
  using OnTool = std::function<void(int tool, bool there)>;

  // Both may be empty; the reading thread calls them at each change.
  DdsInputs(std::shared_ptr<DdsProcess> process, const DdsSettings& settings, OnButton on_button,
            OnTool on_tool = {});
  ~DdsInputs();  // stop()
  DdsInputs(const DdsInputs&) = delete;
  DdsInputs& operator=(const DdsInputs&) = delete;

  void start();
  void stop();
  // Without start(): waits at most `limit` for messages and processes all that are available.
  void read(Duration limit);

  // Each buffer allows one reader.
  [[nodiscard]] graph::TripleBuffer<ReceivedJoints>& joints() noexcept { return *joints_; }
  [[nodiscard]] graph::TripleBuffer<ReceivedInitialPose>& initial_pose() noexcept {
    return *initial_pose_;
  }
  [[nodiscard]] graph::TripleBuffer<ReceivedDescription>& description() noexcept {
    return *description_;
  }

  // Thread-safe.
  [[nodiscard]] ReceivedCounts counts() const noexcept;

 private:
  struct ButtonReader {
    int reader = 0;
    bool pressed = false;
    std::uint64_t sender = 0;  // of the last message
    Time last;                 // its arrival time
  };

  template <class Use>
  void take_all(DdsInput input, int reader, Use use);
  void take_button(Button button);
  void release(Button button, Time time);
  void take_tools(int reader, bool there);
  [[nodiscard]] Time now() const;

  std::shared_ptr<DdsProcess> process_;
  Duration unix_minus_session_;
  Duration session_minus_steady_;  // constant: steps of the Unix clock do not change arrival times
  OnButton on_button_;
  OnTool on_tool_;
  Duration button_timeout_;
  InputAccess* access_;
  std::vector<std::string> tool_names_;
  int joints_reader_ = 0, description_reader_ = 0, guess_reader_ = 0;
  int add_reader_ = 0, remove_reader_ = 0;
  std::vector<int> readers_;    // all of them
  std::uint64_t arrivals_ = 0;  // handled
  std::array<ButtonReader, k_button_count> buttons_;
  std::unique_ptr<graph::TripleBuffer<ReceivedJoints>> joints_;
  std::unique_ptr<graph::TripleBuffer<ReceivedInitialPose>> initial_pose_;
  std::unique_ptr<graph::TripleBuffer<ReceivedDescription>> description_;
  using Counter = std::atomic<std::uint64_t>;
  Counter joints_count_{0}, description_count_{0}, guess_count_{0}, button_count_{0},
      tool_count_{0}, invalid_{0}, released_{0};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace glint
