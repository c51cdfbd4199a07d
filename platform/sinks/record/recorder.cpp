#include "platform/sinks/record/recorder.hpp"

#include <pthread.h>

#include <chrono>
#include <cstring>
#include <new>
#include <thread>
#include <type_traits>

#include "platform/sinks/record/recording_format.hpp"

namespace glint {
namespace {

enum Kind : std::uint32_t {
  k_frame,
  k_head_pose,
  k_markers,
  k_choice,
  k_output,
  k_dropped,
  k_button,
  k_robot_frame_record,
  k_pen_buttons_record
};

struct OutputOffer {
  PoseSample sample;
  std::size_t record_bytes = 0;
  std::array<std::uint8_t, k_offered_record_bytes_max> record{};
};

template <class Item>
constexpr Kind k_kind_of = k_frame;
template <>
constexpr Kind k_kind_of<HeadPose> = k_head_pose;
template <>
constexpr Kind k_kind_of<MarkerFrame> = k_markers;
template <>
constexpr Kind k_kind_of<ChoiceRecord> = k_choice;
template <>
constexpr Kind k_kind_of<OutputOffer> = k_output;
template <>
constexpr Kind k_kind_of<DroppedInput> = k_dropped;
template <>
constexpr Kind k_kind_of<ButtonEvent> = k_button;
template <>
constexpr Kind k_kind_of<RobotFrameRecord> = k_robot_frame_record;
template <>
constexpr Kind k_kind_of<PenButtonsRecord> = k_pen_buttons_record;

// Short compared with the seconds that the rings hold, long compared with a wake-up's cost.
constexpr auto k_look_again = std::chrono::microseconds(500);

template <class Item>
const Item& item_in(const OfferSlot& slot) {
  return *std::launder(reinterpret_cast<const Item*>(slot.bytes.data()));
}

}  // namespace

OfferSlot RecorderLane::claim(std::uint32_t kind, std::size_t bytes) noexcept {
  OfferSlot slot = ring_.claim(bytes);
  while (slot.empty() && when_full_ == OverflowPolicy::wait && ring_.ever_fits(bytes)) {
    std::this_thread::sleep_for(k_look_again);
    slot = ring_.claim(bytes);
  }
  if (slot.empty()) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return slot;
  }
  slot.kind = kind;
  // Relaxed order is sufficient: of two additions to one counter, of which one happens before the
  // other, the first gets the smaller number.
  slot.ticket = ticket_->fetch_add(1, std::memory_order_relaxed);
  return slot;
}

template <class Item>
bool RecorderLane::offer(const Item& item) noexcept {
  static_assert(std::is_trivially_destructible_v<Item> && alignof(Item) <= k_offer_alignment);
  const OfferSlot slot = claim(k_kind_of<Item>, sizeof(Item));
  if (slot.empty()) return false;
  new (slot.bytes.data()) Item(item);
  ring_.publish(slot);
  return true;
}

bool RecorderLane::offer_frame(const Frame& frame, const Rois& rois) noexcept {
  if (!records_frames(level_)) return true;
  const FrameLayout layout = level_ == RecordingLevel::full
                                 ? whole_frame_layout(frame)
                                 : roi_layout(frame, rois, roi_margin_px_);
  const OfferSlot slot = claim(k_frame, sizeof layout + pixel_bytes(layout));
  if (slot.empty()) return false;
  new (slot.bytes.data()) FrameLayout(layout);
  const auto pixels = slot.bytes.subspan(sizeof layout);
  copy_pixels(frame, layout, {reinterpret_cast<std::uint8_t*>(pixels.data()), pixels.size()});
  ring_.publish(slot);
  return true;
}

bool RecorderLane::offer_head_pose(const HeadPose& pose) noexcept {
  return !records_inputs(level_) || offer(pose);
}
bool RecorderLane::offer_markers(const MarkerFrame& frame) noexcept {
  return level_ != RecordingLevel::blobs || offer(frame);
}
bool RecorderLane::offer_choice(const ChoiceRecord& choice) noexcept {
  return !records_inputs(level_) || offer(choice);
}
bool RecorderLane::offer_dropped(const DroppedInput& input) noexcept {
  return !records_inputs(level_) || offer(input);
}
bool RecorderLane::offer_robot_frame(const RobotFrameRecord& frame) noexcept {
  return !records_inputs(level_) || offer(frame);
}
bool RecorderLane::offer_pen_buttons(const PenButtonsRecord& buttons) noexcept {
  return !records_inputs(level_) || offer(buttons);
}
bool RecorderLane::offer_button(const ButtonEvent& event) noexcept { return offer(event); }

bool RecorderLane::offer_output(const PoseSample& sample,
                                std::span<const std::uint8_t> record) noexcept {
  if (record.size() > k_offered_record_bytes_max) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  OutputOffer output;
  output.sample = sample;
  output.record_bytes = record.size();
  if (!record.empty()) std::memcpy(output.record.data(), record.data(), record.size());
  return offer(output);
}

Recorder::Recorder(const std::string& path, const RecordingInfo& info, RecorderSettings settings)
    : writer_(path, info, settings.file) {
  frame_lane().ring_.reserve(settings.frame_lane_bytes);
  tick_lane().ring_.reserve(settings.tick_lane_bytes);
  input_lane().ring_.reserve(settings.input_lane_bytes);
  slice_lane().ring_.reserve(settings.slice_lane_bytes);
  for (RecorderLane& lane : lanes_) {
    lane.ticket_ = &ticket_;
    lane.level_ = info.level;
    lane.when_full_ = settings.when_full;
    lane.roi_margin_px_ = settings.roi_margin_px;
  }
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "glint_record");
}

Recorder::~Recorder() { close(); }

std::uint64_t Recorder::dropped() const noexcept {
  std::uint64_t sum = 0;
  for (const RecorderLane& lane : lanes_) sum += lane.dropped_.load(std::memory_order_relaxed);
  return sum;
}

std::uint64_t Recorder::lost() const noexcept {
  return dropped() + not_written_.load(std::memory_order_relaxed);
}

void Recorder::add_closing_fact(const std::string& name, const std::string& value) {
  closing_facts_[name] = value;
}

void Recorder::run() {
  for (;;) {
    const bool ending = ending_.load(std::memory_order_acquire);
    while (write_next()) {
    }
    if (ending) return;
    std::this_thread::sleep_for(k_look_again);
  }
}

// Writes the offer with the next number, from any lane. Returns false if it is still being filled.
bool Recorder::write_next() {
  passes_.fetch_add(1, std::memory_order_relaxed);
  for (RecorderLane& lane : lanes_) {
    const OfferSlot offer = lane.ring_.front();
    if (offer.empty() || offer.ticket != next_) continue;
    write_item(offer);
    not_written_.store(writer_.messages_lost(), std::memory_order_relaxed);
    lane.ring_.release();
    ++next_;
    return true;
  }
  return false;
}

void Recorder::write_item(const OfferSlot& offer) {
  switch (static_cast<Kind>(offer.kind)) {
    case k_frame: {
      const auto pixels = offer.bytes.subspan(sizeof(FrameLayout));
      writer_.write_frame({item_in<FrameLayout>(offer),
                           {reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size()}});
      break;
    }
    case k_head_pose:
      writer_.write_head_pose(item_in<HeadPose>(offer));
      break;
    case k_markers:
      writer_.write_markers(item_in<MarkerFrame>(offer));
      break;
    case k_choice:
      writer_.write_choice(item_in<ChoiceRecord>(offer));
      break;
    case k_output: {
      const auto& output = item_in<OutputOffer>(offer);
      writer_.write_output(output.sample, std::span(output.record).first(output.record_bytes));
      break;
    }
    case k_dropped:
      writer_.write_dropped(item_in<DroppedInput>(offer));
      break;
    case k_robot_frame_record:
      writer_.write_robot_frame(item_in<RobotFrameRecord>(offer));
      break;
    case k_pen_buttons_record:
      writer_.write_pen_buttons(item_in<PenButtonsRecord>(offer));
      break;
    case k_button:
      writer_.write_button(item_in<ButtonEvent>(offer));
      break;
  }
}

RecordingOutcome Recorder::close() {
  if (!thread_.joinable()) return outcome_;
  ending_.store(true, std::memory_order_release);
  thread_.join();
  writer_.count_dropped_offers(dropped());
  for (const auto& [name, value] : closing_facts_) writer_.add_closing_fact(name, value);
  outcome_ = writer_.close();
  return outcome_;
}

}  // namespace glint
