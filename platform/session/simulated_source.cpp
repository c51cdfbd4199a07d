#include "platform/session/simulated_source.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace glint {
namespace {
constexpr auto k_poll = std::chrono::microseconds(200);
}  // namespace

SimulatedSource::SimulatedSource(const sim::Simulator& simulator, SleepUntil sleep_until,
                                 std::function<Time()> now)
    : simulator_(simulator), sleep_until_(std::move(sleep_until)), now_(std::move(now)) {
  truths_.resize(static_cast<std::size_t>(simulator.frame_count()));
  for (int i = 0; i < k_slots; ++i) {
    slots_.push_back(std::make_unique<sim::SimFrame>());
    (void)free_.push(i);
  }
  renderer_ = std::thread([this] { render_all(); });
}

SimulatedSource::~SimulatedSource() {
  stop_ = true;
  renderer_.join();
}

void SimulatedSource::render_all() {
  for (int i = 0; i < simulator_.frame_count() && !stop_; ++i) {
    int slot = -1;
    while (!free_.pop(slot)) {
      if (stop_) return;
      std::this_thread::sleep_for(k_poll);
    }
    sim::SimFrame& frame = *slots_[static_cast<std::size_t>(slot)];
    simulator_.render(i, frame);
    truths_[static_cast<std::size_t>(i)] = frame.truth;  // here, for it allocates
    (void)rendered_.push(slot);  // cannot be full: it holds more than there are slots
    ++rendered_count_;
    is_rendered_.post();
  }
}

void SimulatedSource::fill() {
  const int goal = std::min(k_slots / 2, simulator_.frame_count());
  while (rendered_count_ < goal) std::this_thread::sleep_for(k_poll);
}

bool SimulatedSource::wait(ArrivedFrame& arrived) {
  if (delivered_ == simulator_.frame_count()) return false;
  if (sleep_until_) sleep_until_(simulator_.timing(delivered_).arrival);
  const bool late = rendered_count_ <= delivered_;
  is_rendered_.wait();
  int slot = -1;
  (void)rendered_.pop(slot);  // it is there: it was posted
  const sim::SimFrame& frame = *slots_[static_cast<std::size_t>(slot)];
  Time arrival = frame.arrival;
  if (sleep_until_ && late) {
    ++late_renders_;
    arrival = now_();  // the last byte is in memory only now
  }
  arrived.frame = frame.pixels.view(frame.mid_exposure, arrival, frame.sequence);
  arrived.head = frame.head;
  arrived.slot = slot;
  ++delivered_;
  return true;
}

void SimulatedSource::give_back(const ArrivedFrame& arrived) noexcept {
  (void)free_.push(arrived.slot);
}

}  // namespace glint
