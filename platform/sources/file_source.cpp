#include "platform/sources/file_source.hpp"

#include <algorithm>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/sources/head_pose_check.hpp"

namespace glint {
namespace {

constexpr std::size_t k_slots = 24;                         // half a second of AHAT, 1 MB each
constexpr Duration k_transport_max = milliseconds(10'000);  // a later arrival is not this frame's

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

FileSource::FileSource(std::unique_ptr<FrameReader> reader, const Camera& camera, Duration duration)
    : reader_(std::move(reader)),
      camera_(camera),
      duration_(duration),
      slots_(k_slots),
      gate_(camera.period) {
  Slot& first = slot_of(0);
  if (!reader_->next(first.frame)) {
    std::string why;
    for (const auto& [name, count] : reader_->counts()) {
      if (count > 0) why += ", " + name + " " + std::to_string(count);
    }
    if (reader_->unreadable() > 0) why += "; the first: " + reader_->first_unreadable();
    throw InputError(reader_->text() + ": no frame" + why + "; expected at least one");
  }
  if (const std::string wrong = camera_mismatch(first.frame.pixels); !wrong.empty()) {
    throw InputError(reader_->text() + ": the first frame has " + wrong);
  }
  // If the first stamp is within a second of 0, stamps count from the session's start, as in a
  // simulator. Otherwise the first frame arrives one nominal gap after the start.
  const Time begin = first.frame.mid_exposure;
  if (begin < Time{} || begin - Time{} > k_gap_counted) {
    const Duration lead{camera.period.nanoseconds - camera.transport.nanoseconds -
                        camera.exposure.nanoseconds / 2};
    origin_ = Duration{begin.nanoseconds} - std::max(lead, Duration{});
  }
  if (!gate_.take(begin)) {
    throw InputError(reader_->text() + ": the first frame's stamp is " +
                     std::to_string(begin.nanoseconds) + " ns; expected within 4e18 of 0");
  }
  convert_to_session_time(first);
  read_ = 1;
  is_read_.post();
  for (std::size_t i = 1; i < slots_.size(); ++i) is_free_.post();
  thread_ = std::thread([this] { read_all(); });
}

FileSource::~FileSource() { stop(); }

void FileSource::stop() {
  stop_ = true;
  is_free_.post();
  if (thread_.joinable()) thread_.join();
}

void FileSource::read_all() noexcept {
  for (bool end = false; !end;) {
    is_free_.wait();
    if (stop_) return;
    Slot& slot = slot_of(read_);
    try {
      end = !read_usable(slot);
    } catch (const std::exception& error) {
      ended_by_ = error.what();
      end = true;
    }
    slot.end = end;
    ++read_;
    is_read_.post();
  }
}

bool FileSource::read_usable(Slot& slot) {
  while (!stop_ && reader_->next(slot.frame)) {
    if (std::string wrong = camera_mismatch(slot.frame.pixels); !wrong.empty()) {
      if (camera_mismatches_++ == 0) first_camera_mismatch_ = std::move(wrong);
      continue;
    }
    if (!gate_.take(slot.frame.mid_exposure)) continue;
    convert_to_session_time(slot);
    return duration_ == Duration{} || slot.arrival < Time{} + duration_;
  }
  return false;
}

// Returns the mismatch of a frame's planes with the camera; empty if they match.
std::string FileSource::camera_mismatch(const FrameBuffer& pixels) const {
  const int width = camera_.model.width, height = camera_.model.height;
  const std::string expected = "; expected " + size_text(width, height) + " pixels with " +
                               std::to_string(camera_.reflectivity_bits) +
                               " bits of reflectivity, and depth (" + camera_.name + ")";
  if (pixels.width != width || pixels.height != height) {
    return size_text(pixels.width, pixels.height) + " pixels" + expected;
  }
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::size_t bright =
      camera_.reflectivity_bits == 8 ? pixels.reflectivity_8.size() : pixels.reflectivity_16.size();
  if (bright != count) {
    const bool none = pixels.reflectivity_8.empty() && pixels.reflectivity_16.empty();
    return (none ? "no reflectivity" : "reflectivity with another number of bits") + expected;
  }
  if (pixels.depth.size() != count) return "no depth" + expected;
  return {};
}

void FileSource::convert_to_session_time(Slot& slot) {
  ReadFrame& frame = slot.frame;
  const Duration moved = gate_.offset() - origin_;
  const Time declared =
      frame.mid_exposure + Duration{camera_.exposure.nanoseconds / 2} + camera_.transport;
  const bool stated = frame.arrival && *frame.arrival >= frame.mid_exposure &&
                      *frame.arrival <= frame.mid_exposure + k_transport_max;
  slot.arrival = std::max((stated ? *frame.arrival : declared) + moved, newest_arrival_);
  newest_arrival_ = slot.arrival;
  frame.mid_exposure = frame.mid_exposure + moved;
  const bool has_pose = frame.head.valid;
  check_head_pose(frame.head);
  without_pose_ += has_pose ? 0 : 1;
  poses_refused_ += has_pose && !frame.head.valid ? 1 : 0;
  frame.head.time = frame.mid_exposure;
  slot.sequence = frame.sequence.value_or(next_sequence_);
  next_sequence_ = slot.sequence + 1;
}

bool FileSource::wait(ArrivedFrame& arrived) {
  const bool ready = read_ > delivered_;
  if (!ready) late_since_ns_ = (newest_delivered_ + camera_.period).nanoseconds;
  is_read_.wait();
  late_since_ns_ = INT64_MAX;
  const Slot& slot = slot_of(delivered_);
  if (slot.end) {
    is_read_.post();  // further calls return the same
    return false;
  }
  Time arrival = slot.arrival;
  if (clock_.live) {
    const Time now = clock_.now();
    if (!ready && now > arrival) {
      ++late_frames_;
      arrival = now;  // the last byte is in memory only now
    }
    // If sleeping fails, the tick loop stops, and with it the run.
    (void)sleep_until(clock_.epoch + (arrival - Time{}));
  }
  newest_delivered_ = arrival;
  arrived.frame = slot.frame.pixels.view(slot.frame.mid_exposure, arrival, slot.sequence);
  arrived.frame.stamp_sigma = slot.frame.stamp_sigma;
  arrived.head = slot.frame.head;
  arrived.slot = static_cast<int>(delivered_ % slots_.size());
  ++delivered_;
  return true;
}

std::optional<Duration> FileSource::unix_offset() const noexcept {
  const std::optional<Duration> of_stamps = reader_->unix_offset();
  if (!of_stamps) return std::nullopt;
  return *of_stamps + origin_;
}

SourceReport FileSource::report() {
  stop();
  SourceReport report;
  report.text = reader_->text();
  const StampCounts& stamps = gate_.counts();
  report.counts = {
      {"stamps_doubled", stamps.doubled},
      {"stamps_backward", stamps.backward},
      {"stamps_far_off", stamps.far_off},
      {"clock_restarts", stamps.restarts},
      {"gaps_over_1_s", stamps.gaps},
      {"longest_gap_ms", static_cast<std::uint64_t>(stamps.longest_gap.nanoseconds / 1'000'000)},
      {"frames_without_head_pose", without_pose_},
      {"head_poses_refused", poses_refused_},
      {"frames_unreadable", reader_->unreadable() + camera_mismatches_}};
  for (const auto& count : reader_->counts()) report.counts.push_back(count);
  if (reader_->unreadable() > 0) {
    report.failures.push_back(std::to_string(reader_->unreadable()) +
                              " frames cannot be read, the first: " + reader_->first_unreadable());
  }
  if (camera_mismatches_ > 0) {
    report.failures.push_back(std::to_string(camera_mismatches_) +
                              " frames do not match the camera; the first has " +
                              first_camera_mismatch_);
  }
  if (const std::string missing = reader_->missing(); !missing.empty()) {
    report.failures.push_back(missing);
  }
  if (!ended_by_.empty()) report.failures.push_back("reading stopped early: " + ended_by_);
  return report;
}

}  // namespace glint
