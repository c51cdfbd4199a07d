#include "platform/sources/live_source.hpp"

#include <algorithm>
#include <string>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/sources/head_pose_check.hpp"

namespace glint {

LiveSource::LiveSource(const Camera& camera, LiveSettings settings)
    : camera_(camera), settings_(settings), faults_(camera.period), slots_(k_live_frames) {
  const auto pixels = static_cast<std::size_t>(camera_.model.width) *
                      static_cast<std::size_t>(camera_.model.height);
  for (Slot& slot : slots_) {
    slot.pixels.width = camera_.model.width;
    slot.pixels.height = camera_.model.height;
    slot.pixels.depth.resize(pixels);
    if (camera_.reflectivity_bits == 8) {
      slot.pixels.reflectivity_8.resize(pixels);
    } else {
      slot.pixels.reflectivity_16.resize(pixels);
    }
  }
  restart_clock();
}

void LiveSource::start(const SourceClock& clock) {
  if (!clock.live) throw InputError("source: live frames; expected a run in real time");
  clock_ = clock;
  started_ = true;
}

bool LiveSource::is_over(Time now) const noexcept {
  return (settings_.stop != nullptr && *settings_.stop) ||
         (settings_.frames > 0 && delivered_ == static_cast<std::uint64_t>(settings_.frames)) ||
         (settings_.duration > Duration{} && session_time(now) >= Time{} + settings_.duration);
}

bool LiveSource::wait(ArrivedFrame& arrived) {
  std::optional<std::size_t> taken;
  while (!taken) {
    note_advance();
    const Time now = monotonic_now();
    if (is_over(now)) {
      ended_ = true;  // later frames do not count as dropped
      faults_.end();
      return false;
    }
    if (is_read_.wait_until(now + k_live_poll)) taken = take_oldest();
  }
  const Slot& slot = slots_[*taken];
  arrived.frame = slot.pixels.view(slot.mid_exposure, slot.arrival, delivered_++);
  arrived.frame.stamp_sigma = slot.stamp_sigma;
  arrived.head = slot.head;
  arrived.slot = static_cast<int>(*taken);
  return true;
}

// A failed exchange means that the other thread took that frame; it takes one at a time.
std::optional<std::size_t> LiveSource::take_oldest() noexcept {
  for (std::size_t attempt = 0; attempt < k_live_frames; ++attempt) {
    std::uint64_t oldest = taken_;
    if (oldest == written_) return std::nullopt;
    const std::size_t slot = order_[oldest % k_live_frames];
    if (taken_.compare_exchange_strong(oldest, oldest + 1)) return slot;
  }
  return std::nullopt;
}

double LiveSource::delivered_part() const noexcept {
  if (settings_.duration <= Duration{} || !started_) return 0;
  return std::min(
      1.0, (session_time(monotonic_now()) - Time{}).seconds() / settings_.duration.seconds());
}

void LiveSource::restart_clock() {
  if (map_) {
    clock_refused_ += map_->refused();
    clock_restarts_ += map_->restarts();
  }
  map_.emplace(camera_.transport + Duration{camera_.exposure.nanoseconds / 2});
}

bool LiveSource::accept_rising(Time stamp, Time& newest) {
  if (stamp <= newest && newest - stamp < ClockMap::k_step) {
    ++backward_;
    note(SourceFault::stamp_refused);
    return false;
  }
  newest = stamp;
  return true;
}

std::optional<Time> LiveSource::exposure_of(Time stamp, Time arrival) {
  const std::optional<Time> mapped = map_->map(stamp, arrival);
  if (!mapped) note(SourceFault::stamp_refused);
  if (!started_ || !mapped || *mapped < clock_.epoch) return std::nullopt;
  const Time exposure = session_time(*mapped);
  if (exposure <= newest_exposure_) {
    ++backward_;
    note(SourceFault::stamp_refused);
    return std::nullopt;
  }
  newest_exposure_ = exposure;
  return exposure;
}

std::optional<std::size_t> LiveSource::unused_slot() const noexcept {
  const auto unused =
      std::find_if(used_.begin(), used_.end(), [](const auto& used) { return !used; });
  if (unused == used_.end()) return std::nullopt;
  return static_cast<std::size_t>(unused - used_.begin());
}

LiveSource::Slot* LiveSource::slot_for_next() {
  std::optional<std::size_t> slot = unused_slot();
  const bool all_used = !slot;
  if (all_used) slot = take_oldest();
  const bool drops_oldest = all_used && slot;
  if (!slot) slot = unused_slot();  // the tracker took all that waited since the first search
  if ((drops_oldest || !slot) && !ended_) {
    ++dropped_;
    note(SourceFault::frame_dropped);
  }
  if (!slot) return nullptr;
  used_[*slot] = false;
  next_slot_ = *slot;
  return &slots_[next_slot_];
}

void LiveSource::publish(Time mid_exposure, Time arrival, const HeadPose& head) {
  Slot& slot = slots_[next_slot_];
  slot.mid_exposure = mid_exposure;
  slot.stamp_sigma = map_->uncertainty();
  slot.arrival = session_time(arrival);
  slot.head = head.valid ? head : HeadPose{};
  check_head_pose(slot.head);
  if (!slot.head.valid) note(SourceFault::head_pose_missing);
  without_pose_ += head.valid ? 0 : 1;
  poses_refused_ += head.valid && !slot.head.valid ? 1 : 0;
  slot.head.time = mid_exposure;
  used_[next_slot_] = true;
  order_[written_ % k_live_frames] = next_slot_;
  ++written_;
  faults_.note_frame(slot.arrival);
  is_read_.post();
}

// Before the start and after the end nothing is lost.
void LiveSource::note(SourceFault fault) noexcept {
  if (started_ && !ended_) faults_.note(fault, session_time(monotonic_now()));
}

void LiveSource::add_to(SourceReport& report) const {
  for (std::size_t kind = 0; kind < k_source_faults; ++kind) {
    const auto fault = static_cast<SourceFault>(kind);
    for (const SourceFaults::Event& event : faults_.events(fault)) {
      report.events.push_back({name_of(fault), event.time, event.frames});
    }
  }
  std::sort(report.events.begin(), report.events.end(),
            [](const auto& a, const auto& b) { return a.time < b.time; });
  report.counts.insert(
      report.counts.end(),
      {{"frames_dropped", dropped_},
       {"stamps_doubled_or_backward", backward_},
       {"stamps_refused", clock_refused_ + map_->refused()},
       {"clock_restarts", clock_restarts_ + map_->restarts()},
       {"clock_uncertainty_us", static_cast<std::uint64_t>(map_->uncertainty().nanoseconds / 1000)},
       {"frames_without_head_pose", without_pose_},
       {"head_poses_refused", poses_refused_}});
  if (dropped_ > 0) {
    report.failures.push_back(std::to_string(dropped_) +
                              " frames dropped: the tracker was slower than the producer");
  }
}

}  // namespace glint
