#include "platform/sinks/dds/dds_inputs.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "platform/sinks/dds/topic_names.hpp"

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
constexpr std::size_t k_senders_max = 64;     // publishers of one button searched for the sender

constexpr const char* k_button_names[k_button_count] = {"button", "button_delete", "button_undo",
                                                        "button_finish"};

// Takes all available messages of a reader. Deserialises a message only if it has at most
// `bytes_max` bytes; `use(message, sender)` returns whether it is valid. Returns the number of
// rejected messages.
template <class Message, class Use>
std::uint64_t take_bounded(dds_entity_t reader, const TopicType& type, std::size_t bytes_max,
                           Use use) {
  std::uint64_t refused = 0;
  for (int i = 0; i < k_messages_per_read_max; ++i) {
    std::array<ddsi_serdata*, 1> packed{};
    dds_sample_info_t info;
    if (dds_takecdr(reader, packed.data(), 1, &info, DDS_ANY_STATE) != 1) break;
    if (info.valid_data) {
      Message message{};
      bool taken = false;
      if (ddsi_serdata_size(packed[0]) <= bytes_max) {
        taken = ddsi_serdata_to_sample(packed[0], &message, nullptr, nullptr) &&
                use(message, info.publication_handle);
        dds_sample_free(&message, type.descriptor, DDS_FREE_CONTENTS);
      }
      if (!taken) ++refused;
    }
    ddsi_serdata_unref(packed[0]);
  }
  return refused;
}

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

DdsInputs::DdsInputs(std::shared_ptr<Participant> participant, const DdsSettings& settings,
                     OnButton on_button, OnTool on_tool)
    : participant_(std::move(participant)),
      unix_minus_session_(settings.unix_minus_session),
      session_minus_steady_(Time{dds_time()} - unix_minus_session_ - steady_now()),
      on_button_(std::move(on_button)),
      on_tool_(std::move(on_tool)),
      button_timeout_(settings.button_timeout),
      tool_names_(settings.tool_names),
      waitset_(participant_->waitset()),
      joints_(std::make_unique<graph::TripleBuffer<ReceivedJoints>>()),
      initial_pose_(std::make_unique<graph::TripleBuffer<ReceivedInitialPose>>()),
      description_(std::make_unique<graph::TripleBuffer<ReceivedDescription>>()) {
  joints_reader_ = add_reader(joint_state_type(), k_joint_states_topic, k_joints);
  description_reader_ = add_reader(text_type(), k_robot_description_topic, k_description);
  guess_reader_ = add_reader(pose_covariance_type(), k_initial_pose_topic, k_guess);
  const std::string& prefix = settings.topic_prefix;
  if (settings.accepts_tool_changes) {
    add_reader_ = add_reader(text_type(), topic_under(prefix, k_tool_add_name), k_tool);
    remove_reader_ = add_reader(text_type(), topic_under(prefix, k_tool_remove_name), k_tool);
  }
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    buttons_[i].reader = add_reader(bool_type(), topic_under(prefix, k_button_names[i]), k_button);
  }
}

DdsInputs::~DdsInputs() {
  stop();
  for (const ButtonReader& button : buttons_) dds_delete(button.reader);
  for (const dds_entity_t entity : {remove_reader_, add_reader_, guess_reader_, description_reader_,
                                    joints_reader_, waitset_}) {
    if (entity != 0) dds_delete(entity);
  }
}

dds_entity_t DdsInputs::add_reader(const TopicType& type, const std::string& topic,
                                   const Quality& quality) {
  const dds_entity_t reader = participant_->reader(type, topic, quality);
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset_, reader, 0);
  return reader;
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

void DdsInputs::read(Duration limit) {
  dds_waitset_wait(waitset_, nullptr, 0, limit.nanoseconds);
  take_joints();
  take_descriptions();
  take_initial_poses();
  for (int i = 0; i < k_button_count; ++i) {
    take_button(static_cast<Button>(i));
    release_if_gone(static_cast<Button>(i));
  }
  if (remove_reader_ == 0) return;
  take_tools(remove_reader_, false);
  take_tools(add_reader_, true);
}

void DdsInputs::take_joints() {
  const auto use = [this](const JointStateMessage& message, dds_instance_handle_t) {
    if (!read_message(message, unix_minus_session_, now(), joints_->write_slot())) return false;
    joints_->publish(count_up(joints_count_), now().nanoseconds);
    return true;
  };
  count_up(refused_, take_bounded<JointStateMessage>(joints_reader_, joint_state_type(),
                                                     k_joints_bytes, use));
}

void DdsInputs::take_descriptions() {
  const auto use = [this](const TextMessage& message, dds_instance_handle_t) {
    if (!read_message(message, description_->write_slot())) return false;
    description_->publish(count_up(description_count_), now().nanoseconds);
    return true;
  };
  count_up(refused_,
           take_bounded<TextMessage>(description_reader_, text_type(), k_description_bytes, use));
}

void DdsInputs::take_initial_poses() {
  const auto use = [this](const PoseCovarianceMessage& message, dds_instance_handle_t) {
    if (!read_message(message, unix_minus_session_, now(), initial_pose_->write_slot()))
      return false;
    initial_pose_->publish(count_up(guess_count_), now().nanoseconds);
    return true;
  };
  count_up(refused_, take_bounded<PoseCovarianceMessage>(guess_reader_, pose_covariance_type(),
                                                         k_guess_bytes, use));
}

// A driver may repeat the button's state at a fixed rate: only changes are events.
void DdsInputs::take_button(Button button) {
  ButtonReader& button_reader = buttons_[static_cast<std::size_t>(button)];
  const auto use = [&](const BoolMessage& message, dds_instance_handle_t sender) {
    count_up(button_count_);
    button_reader.sender = sender;
    button_reader.last = now();
    if (message.data == button_reader.pressed) return true;
    button_reader.pressed = message.data;
    if (on_button_) on_button_({button_reader.last, button, button_reader.pressed});
    return true;
  };
  count_up(refused_,
           take_bounded<BoolMessage>(button_reader.reader, bool_type(), k_button_bytes, use));
}

// The sender left the domain (if killed: at the end of its lease), hangs, or is disconnected.
void DdsInputs::release_if_gone(Button button) {
  ButtonReader& button_reader = buttons_[static_cast<std::size_t>(button)];
  if (!button_reader.pressed) return;
  std::array<dds_instance_handle_t, k_senders_max> senders{};
  const int count =
      dds_get_matched_publications(button_reader.reader, senders.data(), senders.size());
  const auto end = senders.begin() + std::clamp(count, 0, static_cast<int>(senders.size()));
  const bool left = count <= static_cast<int>(senders.size()) &&
                    std::find(senders.begin(), end, button_reader.sender) == end;
  const Time time = now();
  if (!left && time - button_reader.last <= button_timeout_) return;
  button_reader.pressed = false;
  count_up(released_);
  if (on_button_) on_button_({time, button, false});
}

// Rejects names that are not among the run's tools.
void DdsInputs::take_tools(dds_entity_t reader, bool there) {
  const auto use = [&](const TextMessage& message, dds_instance_handle_t) {
    const auto found = std::find(tool_names_.begin(), tool_names_.end(), message.data);
    if (found == tool_names_.end()) return false;
    count_up(tool_count_);
    if (on_tool_) on_tool_(static_cast<int>(found - tool_names_.begin()), there);
    return true;
  };
  count_up(refused_, take_bounded<TextMessage>(reader, text_type(), k_tool_bytes, use));
}

Time DdsInputs::now() const { return steady_now() + session_minus_steady_; }

ReceivedCounts DdsInputs::counts() const noexcept {
  ReceivedCounts counts;
  counts.joints = joints_count_.load(std::memory_order_relaxed);
  counts.descriptions = description_count_.load(std::memory_order_relaxed);
  counts.guesses = guess_count_.load(std::memory_order_relaxed);
  counts.buttons = button_count_.load(std::memory_order_relaxed);
  counts.tools = tool_count_.load(std::memory_order_relaxed);
  counts.refused = refused_.load(std::memory_order_relaxed);
  counts.released = released_.load(std::memory_order_relaxed);
  return counts;
}

}  // namespace glint
