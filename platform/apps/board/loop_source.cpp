#include "platform/apps/board/loop_source.hpp"

#include "platform/runtime/rt/clock.hpp"

namespace glint {

LoopSource::LoopSource(const FrameLoop& loop, const ArrivalSettings& settings)
    : loop_(loop),
      settings_(settings),
      wake_ups_ns_(settings.frames > 0 ? static_cast<std::size_t>(settings.frames)
                                       : WakeUpLog::k_entries_max) {}

LoopSource::~LoopSource() {
  stop_ = true;
  if (arrivals_ != nullptr) arrivals_->join();
}

void LoopSource::start(const SourceClock& clock) {
  clock_ = clock;
  if (!clock.live) return;
  const ThreadSettings thread{"glint-arrival", settings_.core, settings_.priority};
  arrivals_ = std::make_unique<RealTimeThread>(thread, [this] { arrive(); });
}

void LoopSource::arrive() {
  for (std::int64_t i = 0; (settings_.frames == 0 || i < settings_.frames) && !ends(); ++i) {
    if (!sleep_until(clock_.epoch + settings_.first + settings_.period * i)) break;
    arrived_count_.fetch_add(1, std::memory_order_release);
    arrived_.post();
  }
  arrived_.post();  // without a frame: the end
}

bool LoopSource::wait(ArrivedFrame& arrived) {
  if (settings_.frames > 0 && delivered_ == settings_.frames) return false;
  const Time stamp = Time{} + settings_.first + settings_.period * delivered_;
  if (clock_.live) {
    const bool found_waiting = arrived_count_.load(std::memory_order_acquire) <= delivered_;
    arrived_.wait();
    if (arrived_count_.load(std::memory_order_acquire) == delivered_) return false;
    if (found_waiting) wake_ups_ns_.add((clock_.now() - stamp).nanoseconds);
  } else if (ends()) {
    return false;
  }
  const std::uint32_t index = loop_.index_of(static_cast<std::uint64_t>(delivered_));
  arrived.frame = loop_.view(index, stamp, static_cast<std::uint64_t>(delivered_ + 1));
  arrived.head = loop_.head(index, stamp);
  arrived.slot = static_cast<int>(index);
  if (loop_.entry(index).kind == LoopFrameKind::worst) ++worst_frames_delivered_;
  ++delivered_;
  return true;
}

// Frames stay in the loop.
void LoopSource::release_pixels(const ArrivedFrame& /*arrived*/) noexcept {}

}  // namespace glint
