#include "platform/sources/simulated_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>

#include "platform/runtime/rt/clock.hpp"

namespace glint {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr auto k_poll = std::chrono::microseconds(200);
constexpr auto k_fill_poll = std::chrono::milliseconds(5);
constexpr auto k_fill_limit = std::chrono::seconds(30);
constexpr int k_slots_min = 24;               // half a second at 45 Hz, 1 MB each for AHAT
constexpr double k_ahead_min_s = 4;           // of frames; a shorter run is rendered completely
constexpr double k_memory_part = 0.25;        // of the available memory
constexpr double k_memory_bytes_max = 1.0e9;  // 21 s of AHAT at 45 Hz
constexpr unsigned k_renderers_max = 2;

double available_bytes() {
  std::ifstream file("/proc/meminfo");
  for (std::string name, unit; file >> name;) {
    double kilobytes = 0;
    file >> kilobytes;
    std::getline(file, unit);
    if (name == "MemAvailable:") return kilobytes * 1024;
  }
  return 0;
}

double frame_bytes(const Camera& camera) {
  const double pixels = static_cast<double>(camera.model.width) * camera.model.height;
  return pixels * (camera.reflectivity_bits / 8.0 + sizeof(std::uint16_t));
}

int slots_for(const sim::Simulator& simulator, bool live) {
  if (!live) return k_slots_min;
  const double bytes = std::min(k_memory_part * available_bytes(), k_memory_bytes_max);
  const int fit = static_cast<int>(bytes / frame_bytes(simulator.scenario().camera));
  return std::max(k_slots_min, std::min(fit, simulator.frame_count()));
}

// More threads get a larger share of a loaded machine.
unsigned renderers() {
  return std::clamp(std::thread::hardware_concurrency(), 1u, k_renderers_max);
}

}  // namespace

SimulatedSource::SimulatedSource(const sim::Simulator& simulator, SimulatedSourceSettings settings)
    : simulator_(simulator),
      settings_(settings),
      slots_(static_cast<std::size_t>(slots_for(simulator, settings.live))),
      truths_(static_cast<std::size_t>(simulator.frame_count())),
      ahead_max_(static_cast<int>(slots_.size())) {
  for (unsigned i = 0; i < renderers(); ++i) renderers_.emplace_back([this] { render_all(); });
}

SimulatedSource::~SimulatedSource() {
  stop_ = true;
  for (std::thread& renderer : renderers_) renderer.join();
}

// If sleeping fails, the tick loop stops, and with it the run.
void SimulatedSource::sleep_until(Time time) const {
  if (clock_.live) (void)glint::sleep_until(clock_.epoch + (time - Time{}));
}

void SimulatedSource::render_all() {
  sim::SimFrame frame;
  for (int i = next_++; i < simulator_.frame_count(); i = next_++) {
    while (i >= released_ + ahead_max_) {
      if (stop_) return;
      std::this_thread::sleep_for(k_poll);
    }
    if (stop_) return;
    simulator_.render(i, frame);
    put(i, frame);
  }
}

// Publishes the frames in order, independent of which renderer finishes first.
void SimulatedSource::put(int number, sim::SimFrame& frame) {
  Slot& slot = slot_of(number);
  std::swap(slot.pixels, frame.pixels);
  slot.mid_exposure = frame.mid_exposure;
  slot.sequence = frame.sequence;
  slot.head = frame.head;
  truths_[static_cast<std::size_t>(number)] = frame.truth;  // allocates: not under the lock
  const std::lock_guard lock(order_);
  slot.rendered = true;
  // At most as many iterations as there are renderers: the other frames wait for earlier ones.
  while (rendered_count_ < simulator_.frame_count() && slot_of(rendered_count_).rendered) {
    slot_of(rendered_count_).rendered = false;
    ++rendered_count_;
    is_rendered_.post();
  }
}

int SimulatedSource::frames_wanted(double frames_a_second) const {
  const double count = simulator_.frame_count();
  const double needed_a_second = count / simulator_.scenario().duration.seconds();
  const double in_time = 0.5 * frames_a_second / needed_a_second;
  const double ahead = std::max(count * (1 - in_time), k_ahead_min_s * needed_a_second);
  const double room = static_cast<double>(slots_.size());
  return static_cast<int>(std::min({std::ceil(ahead), room, count}));
}

void SimulatedSource::prepare(const std::function<bool(int, int)>& go_on) {
  const SteadyClock::time_point begin = SteadyClock::now();
  int wanted = std::min(k_slots_min / 2, simulator_.frame_count());
  for (;;) {
    const int rendered = rendered_count_;
    const std::chrono::duration<double> taken = SteadyClock::now() - begin;
    if (settings_.live && rendered > 0) wanted = frames_wanted(rendered / taken.count());
    if (rendered >= wanted || taken > k_fill_limit || (go_on && !go_on(rendered, wanted))) break;
    std::this_thread::sleep_for(k_fill_poll);
  }
  // From here on each returned frame makes room for one.
  ahead_max_ = std::clamp(rendered_count_.load(), std::min(k_slots_min, ahead_max_.load()),
                          ahead_max_.load());
}

bool SimulatedSource::wait(ArrivedFrame& arrived) {
  const int number = delivered_;
  if (number == simulator_.frame_count()) {
    late_since_ns_ = INT64_MAX;  // no further frame is due
    return false;
  }
  Time arrival = simulator_.timing(number).arrival;
  sleep_until(arrival);
  const bool slow = settings_.frame_time > Duration{};
  const bool late = slow || (clock_.live && rendered_count_ <= number);
  late_since_ns_ = !late ? INT64_MAX : std::min(late_since_ns_.load(), arrival.nanoseconds);
  if (slow) {
    arrival = ready_ = std::max(ready_, arrival) + settings_.frame_time;
    sleep_until(arrival);
  }
  is_rendered_.wait();
  if (late) ++late_frames_;
  if (late && clock_.live) arrival = clock_.now();  // the last byte is in memory only now
  const Slot& slot = slot_of(number);
  arrived.frame = slot.pixels.view(slot.mid_exposure, arrival, slot.sequence);
  arrived.head = slot.head;
  arrived.slot = number;
  delivered_ = number + 1;
  return true;
}

void SimulatedSource::release_pixels(const ArrivedFrame& /*arrived*/) noexcept { ++released_; }

double SimulatedSource::delivered_part() const noexcept {
  return static_cast<double>(delivered_) / std::max(1, simulator_.frame_count());
}

}  // namespace glint
