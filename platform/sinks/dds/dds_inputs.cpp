#include "platform/sinks/dds/dds_inputs.hpp"

#include <algorithm>
#include <chrono>

#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {
namespace {

// Best effort as robot_state_publisher's subscription: matches every driver's publisher.
constexpr Quality k_joints{Reliability::best_effort, Durability::volatile_data, 5};
// Transient local as RViz's subscription: receives it also from a publisher that started earlier.
constexpr Quality k_description{Reliability::reliable, Durability::transient_local, 1};
constexpr Quality k_guess{Reliability::reliable, Durability::volatile_data, 10};
constexpr Quality k_button{Reliability::reliable, Durability::volatile_data, 64};
constexpr Quality k_tool{Reliability::reliable, Durability::volatile_data, 64};

// Maximum serialised sizes of messages, strings and padding included.
constexpr std::size_t k_joints_bytes = std::size_t{64} << 10;
constexpr std::size_t k_description_bytes = k_received_description_max + 64;
constexpr std::size_t k_guess_bytes = std::size_t{4} << 10;
constexpr std::size_t k_button_bytes = 64;
constexpr std::size_t k_tool_bytes = 128;  // a name has 31 at most

constexpr Duration k_poll_period = milliseconds(20);
constexpr int k_messages_per_read_max = 256;  // per call and topic: no topic starves the others

// Only the reading thread writes the counters.
std::uint64_t count_up(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) {
  const std::uint64_t now = counter.load(std::memory_order_relaxed) + by;
  counter.store(now, std::memory_order_relaxed);
  return now;
}

Time steady_now() {
  const auto passed = std::chrono::steady_clock::now().time_since_epoch();
  return Time{std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count()};
}

}  // namespace

DdsInputs::DdsInputs(std::shared_ptr<DdsProcess> process, const DdsSettings& settings,
                     OnButton on_button, OnTool on_tool)
    : process_(std::move(process)),
      unix_minus_session_(settings.unix_minus_session),
      session_minus_steady_(Time{dds_time()} - unix_minus_session_ - steady_now()),
      on_button_(std::move(on_button)),
      on_tool_(std::move(on_tool)),
      button_timeout_(settings.button_timeout),
      access_(settings.access),
      tool_names_(settings.tool_names),
      joints_(std::make_unique<graph::TripleBuffer<ReceivedJoints>>()),
      initial_pose_(std::make_unique<graph::TripleBuffer<ReceivedInitialPose>>()),
      description_(std::make_unique<graph::TripleBuffer<ReceivedDescription>>()) {
  const auto add = [this](const TopicType& type, const std::string& topic, const Quality& quality,
                          std::size_t bytes_max) {
    return readers_.emplace_back(process_->reader(type, topic, quality, bytes_max));
  };
  const auto topics = [&](DdsInput input) {
    return topics_of(input, settings.topic_prefix, settings.name);
  };
  joints_reader_ =
      add(joint_state_type(), topics(DdsInput::joint_states)[0], k_joints, k_joints_bytes);
  description_reader_ =
      add(text_type(), topics(DdsInput::robot_description)[0], k_description, k_description_bytes);
  guess_reader_ =
      add(pose_covariance_type(), topics(DdsInput::initial_pose)[0], k_guess, k_guess_bytes);
  const std::vector<std::string> of_tools = topics(DdsInput::tools);
  add_reader_ = add(text_type(), of_tools[0], k_tool, k_tool_bytes);
  remove_reader_ = add(text_type(), of_tools[1], k_tool, k_tool_bytes);
  const std::vector<std::string> of_buttons = topics(DdsInput::buttons);
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    buttons_[i].reader = add(bool_type(), of_buttons[i], k_button, k_button_bytes);
  }
}

DdsInputs::~DdsInputs() {
  stop();
  for (const int reader : readers_) process_->remove(reader);
}

void DdsInputs::start() {
  if (thread_.joinable()) return;
  stopping_ = false;
  thread_ = std::thread([this] {
    while (!stopping_) read(k_poll_period);
  });
}

void DdsInputs::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

// Takes the available messages of a reader; `use(message)` returns whether it is valid.
template <class Use>
void DdsInputs::take_all(DdsInput input, int reader, Use use) {
  ReceivedMessage message;
  for (int i = 0; i < k_messages_per_read_max && process_->take(reader, message); ++i) {
    const bool is_message = message.kind == RecordKind::message;
    if (is_message && access_ != nullptr && !access_->admits(input, now())) continue;
    if (!use(message)) count_up(invalid_);
  }
}

void DdsInputs::read(Duration limit) {
  arrivals_ = process_->wait(arrivals_, limit);
  const auto is_message = [](const ReceivedMessage& one) {
    return one.kind == RecordKind::message;
  };
  take_all(DdsInput::joint_states, joints_reader_, [&](const ReceivedMessage& one) {
    if (!is_message(one)) return true;
    if (!read_message(one.bytes, unix_minus_session_, now(), joints_->write_slot())) return false;
    joints_->publish(count_up(joints_count_), now().nanoseconds);
    return true;
  });
  take_all(DdsInput::robot_description, description_reader_, [&](const ReceivedMessage& one) {
    if (!is_message(one)) return true;
    if (!read_message(one.bytes, description_->write_slot())) return false;
    description_->publish(count_up(description_count_), now().nanoseconds);
    return true;
  });
  take_all(DdsInput::initial_pose, guess_reader_, [&](const ReceivedMessage& one) {
    if (!is_message(one)) return true;
    if (!read_message(one.bytes, unix_minus_session_, now(), initial_pose_->write_slot())) {
      return false;
    }
    initial_pose_->publish(count_up(guess_count_), now().nanoseconds);
    return true;
  });
  for (int i = 0; i < k_button_count; ++i) take_button(static_cast<Button>(i));
  take_tools(remove_reader_, false);
  take_tools(add_reader_, true);
}

// A driver may repeat the button's state at a fixed rate: only changes are events. A sender that
// hangs or is disconnected repeats nothing.
void DdsInputs::take_button(Button button) {
  ButtonReader& button_reader = buttons_[static_cast<std::size_t>(button)];
  take_all(DdsInput::buttons, button_reader.reader, [&](const ReceivedMessage& one) {
    const Time time = now();
    if (one.kind == RecordKind::sender_left) {
      if (one.sender == 0 || one.sender == button_reader.sender) release(button, time);
      return true;
    }
    bool pressed = false;
    if (!read_message(one.bytes, pressed)) return false;
    count_up(button_count_);
    button_reader.sender = one.sender;
    button_reader.last = time;
    if (pressed == button_reader.pressed) return true;
    button_reader.pressed = pressed;
    if (on_button_) on_button_({time, button, pressed});
    return true;
  });
  const Time time = now();
  if (time - button_reader.last > button_timeout_) release(button, time);
}

void DdsInputs::release(Button button, Time time) {
  ButtonReader& button_reader = buttons_[static_cast<std::size_t>(button)];
  if (!button_reader.pressed) return;
  button_reader.pressed = false;
  count_up(released_);
  if (on_button_) on_button_({time, button, false});
}

// Rejects names that are not among the run's tools.
void DdsInputs::take_tools(int reader, bool there) {
  take_all(DdsInput::tools, reader, [&](const ReceivedMessage& one) {
    if (one.kind == RecordKind::sender_left) return true;
    const auto found = std::find(tool_names_.begin(), tool_names_.end(), text_of(one.bytes));
    if (found == tool_names_.end()) return false;
    count_up(tool_count_);
    if (on_tool_) on_tool_(static_cast<int>(found - tool_names_.begin()), there);
    return true;
  });
}

Time DdsInputs::now() const { return steady_now() + session_minus_steady_; }

ReceivedCounts DdsInputs::counts() const noexcept {
  ReceivedCounts counts;
  counts.joints = joints_count_.load(std::memory_order_relaxed);
  counts.descriptions = description_count_.load(std::memory_order_relaxed);
  counts.guesses = guess_count_.load(std::memory_order_relaxed);
  counts.buttons = button_count_.load(std::memory_order_relaxed);
  counts.tools = tool_count_.load(std::memory_order_relaxed);
  counts.refused = invalid_.load(std::memory_order_relaxed);
  if (access_ != nullptr) counts.refusals = access_->refusals();
  counts.refused += counts.refusals.total();
  for (const int reader : readers_) {
    const ReaderLosses losses = process_->losses(reader);
    counts.refused += losses.refused;
    counts.lost += losses.overwritten;
  }
  counts.released = released_.load(std::memory_order_relaxed);
  return counts;
}

}  // namespace glint
