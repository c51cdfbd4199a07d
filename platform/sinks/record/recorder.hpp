// Recorder for real-time threads: each offer is copied into its thread's ring; a separate thread
// writes the file.
//
// An offer neither allocates, locks nor waits. If its ring is full it is dropped and counted, and
// the recording is marked incomplete. One counter numbers the offers of all threads, and the file
// has that order. An offer made before a value was published therefore precedes every offer of a
// thread that had read the value.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <thread>

#include "kernels/image/roi.hpp"
#include "platform/sinks/record/offer_ring.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/when_full.hpp"

namespace glint {

inline constexpr std::size_t k_offered_record_bytes_max = 640;

struct RecorderSettings {
  std::size_t frame_lane_bytes = std::size_t{26} << 20;  // 24 full AHAT frames
  std::size_t tick_lane_bytes = std::size_t{6} << 20;    // 5 s at 1 kHz
  std::size_t input_lane_bytes = std::size_t{1} << 16;
  std::size_t slice_lane_bytes = std::size_t{1} << 16;
  OverflowPolicy when_full = OverflowPolicy::drop;
  int roi_margin_px = 8;  // around each region, see roi_layout
  RecordingSettings file;
};

// Offers of one thread. They return false if dropped. Offers excluded by the level are ignored and
// return true.
class RecorderLane {
 public:
  // Copies the frame's pixels: the ROIs at level roi, all of them at level full.
  bool offer_frame(const Frame& frame, const Rois& rois) noexcept;
  bool offer_head_pose(const HeadPose& pose) noexcept;
  bool offer_markers(const MarkerFrame& frame) noexcept;
  bool offer_choice(const ChoiceRecord& choice) noexcept;
  // record: at most k_offered_record_bytes_max, else dropped.
  bool offer_output(const PoseSample& sample, std::span<const std::uint8_t> record) noexcept;
  bool offer_dropped(const DroppedInput& input) noexcept;
  bool offer_robot_frame(const RobotFrameRecord& frame) noexcept;
  bool offer_pen_buttons(const PenButtonsRecord& buttons) noexcept;
  bool offer_button(const ButtonEvent& event) noexcept;  // at every level

 private:
  friend class Recorder;
  template <class Item>
  bool offer(const Item& item) noexcept;
  OfferSlot claim(std::uint32_t kind, std::size_t bytes) noexcept;

  OfferRing ring_;
  std::atomic<std::uint64_t>* ticket_ = nullptr;
  std::atomic<std::uint64_t> dropped_{0};
  RecordingLevel level_ = RecordingLevel::roi;
  OverflowPolicy when_full_ = OverflowPolicy::drop;
  int roi_margin_px_ = 0;
};

class Recorder {
 public:
  // Throws InputError if the file cannot be created. Touches all its memory.
  Recorder(const std::string& path, const RecordingInfo& info, RecorderSettings settings = {});
  ~Recorder();  // closes
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Each lane is used by one thread at a time.
  [[nodiscard]] RecorderLane& frame_lane() noexcept { return lanes_[0]; }
  [[nodiscard]] RecorderLane& tick_lane() noexcept { return lanes_[1]; }
  [[nodiscard]] RecorderLane& input_lane() noexcept { return lanes_[2]; }
  [[nodiscard]] RecorderLane& slice_lane() noexcept { return lanes_[3]; }

  // Number of dropped offers so far; from any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept;
  // Dropped offers, and messages lost by a failed write; from any thread.
  [[nodiscard]] std::uint64_t lost() const noexcept;

  // Raised by the writing thread at each search for offers: every millisecond, or after a write.
  [[nodiscard]] const std::atomic<std::uint64_t>& passes() const noexcept { return passes_; }

  // Call before close(); not from a real-time thread.
  void add_closing_fact(const std::string& name, const std::string& value);

  // Call after the last offer: writes the pending offers and closes the file. Later calls return
  // the same outcome.
  RecordingOutcome close();

 private:
  void run();
  bool write_next();
  void write_item(const OfferSlot& offer);

  RecordingWriter writer_;
  std::array<RecorderLane, 4> lanes_;
  alignas(64) std::atomic<std::uint64_t> ticket_{0};
  std::uint64_t next_ = 0;
  std::atomic<std::uint64_t> not_written_{0};
  std::atomic<std::uint64_t> passes_{0};
  std::atomic<bool> ending_{false};
  std::map<std::string, std::string> closing_facts_;
  RecordingOutcome outcome_;
  std::thread thread_;
};

}  // namespace glint
