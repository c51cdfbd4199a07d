// What comes in: joint states, the robot's description, a guess of where it stands, the pen's
// buttons, and which tools are there, read by a thread of its own.
//
// Values of which the newest counts are handed over in triple buffers, as Latest<> reads them; a
// button's changes go one by one to whoever records them, for each of them counts, and so do tools
// that are named to be there or not, if the settings allow it. A held button is released when the
// participant that said so leaves the domain, cleanly or by its lease, or is silent for the
// settings' timeout. Every message is bounded before it is unpacked; what is too
// large or makes no sense is refused and counted.
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
#include "platform/dds/heard.hpp"
#include "platform/dds/participant.hpp"
#include "platform/record/button_event.hpp"

namespace glint {

struct HeardCounts {
  // Messages taken.
  std::uint64_t joints = 0, descriptions = 0, guesses = 0, buttons = 0, tools = 0;
  std::uint64_t refused = 0;
  std::uint64_t released = 0;  // buttons whose sender left or fell silent
  [[nodiscard]] bool any() const {
    return joints + descriptions + guesses + buttons + tools + refused > 0;
  }
};

class DdsInputs {
 public:
  using OnButton = std::function<void(const ButtonEvent&)>;
  // The settings' tool of this number is there from now on, or no more.
  using OnTool = std::function<void(int tool, bool there)>;

  // Both may be empty; they are called from the reading thread with each change. Throws as
  // Participant does.
  DdsInputs(std::shared_ptr<Participant> participant, const DdsSettings& settings,
            OnButton on_button, OnTool on_tool = {});
  ~DdsInputs();  // stop()
  DdsInputs(const DdsInputs&) = delete;
  DdsInputs& operator=(const DdsInputs&) = delete;

  void start();
  void stop();
  // Without a thread: waits for messages, at most `limit`, and takes all that are there.
  void read(Duration limit);

  // Each has one reader at most.
  [[nodiscard]] graph::TripleBuffer<HeardJoints>& joints() noexcept { return *joints_; }
  [[nodiscard]] graph::TripleBuffer<HeardGuess>& guess() noexcept { return *guess_; }
  [[nodiscard]] graph::TripleBuffer<HeardDescription>& description() noexcept {
    return *description_;
  }

  // From any thread.
  [[nodiscard]] HeardCounts counts() const noexcept;

 private:
  struct ButtonReader {
    dds_entity_t reader = 0;
    bool pressed = false;
    dds_instance_handle_t sender = 0;  // of the last message
    Time last;                         // its arrival
  };

  dds_entity_t add_reader(const TopicType& type, const std::string& topic, const Quality& quality);
  void take_joints();
  void take_descriptions();
  void take_guesses();
  void take_button(Button button);
  void release_if_gone(Button button);
  void take_tools(dds_entity_t reader, bool there);
  [[nodiscard]] Time now() const;

  std::shared_ptr<Participant> participant_;
  Duration unix_minus_board_;
  Duration board_minus_steady_;  // a step of Unix time moves no arrival
  OnButton on_button_;
  OnTool on_tool_;
  Duration button_timeout_;
  std::vector<std::string> tool_names_;
  dds_entity_t waitset_ = 0, joints_reader_ = 0, description_reader_ = 0, guess_reader_ = 0;
  dds_entity_t add_reader_ = 0, remove_reader_ = 0;
  std::array<ButtonReader, k_button_count> buttons_;
  std::unique_ptr<graph::TripleBuffer<HeardJoints>> joints_;
  std::unique_ptr<graph::TripleBuffer<HeardGuess>> guess_;
  std::unique_ptr<graph::TripleBuffer<HeardDescription>> description_;
  using Counter = std::atomic<std::uint64_t>;
  Counter joints_count_{0}, description_count_{0}, guess_count_{0}, button_count_{0},
      tool_count_{0}, refused_{0}, released_{0};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace glint
