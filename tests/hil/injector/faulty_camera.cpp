#include "tests/hil/injector/faulty_camera.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/session/run_schedule.hpp"

namespace glint::hil {
namespace {

// Above the frames' thread, which waits for a frame, and below the ticks', which a camera of
// another device does not delay.
constexpr int k_camera_priority = (k_frame_priority + k_tick_priority) / 2;
constexpr std::uint16_t k_threshold = 1280;  // of the built-in HoloLens 2 camera
constexpr int k_marker_px = 24;              // wider than a marker's image
constexpr std::uint16_t k_depth_invalid_from = 4090;

}  // namespace

FaultyCamera::FaultyCamera(const std::string& loop_file, std::string socket, Time start)
    : loop_(loop_file),
      socket_path_(std::move(socket)),
      start_(start),
      thread_({"hil-camera", -1, k_camera_priority}, [this] { run(); }) {}

FaultyCamera::~FaultyCamera() { stop_ = true; }

void FaultyCamera::apply(const Command& command) {
  const std::lock_guard lock(mutex_);
  const std::int64_t number = command.number[0];
  if (command.verb == "every") faults_.every = std::max<std::int64_t>(number, 1);
  if (command.verb == "go") faults_ = {};
  if (command.verb == "freeze") faults_.frozen = true;
  if (command.verb == "drop") faults_.drop = number;
  if (command.verb == "repeat") faults_.repeats = number != 0;
  if (command.verb == "hide") faults_.hides = number != 0;
  if (command.verb == "bias") faults_.bias_mm = number;
  if (command.verb == "delay") faults_.delay_ms = number;
  if (command.verb == "worst") faults_.worst = number != 0;
}

CameraFaults FaultyCamera::faults_of_next_frame() {
  const std::lock_guard lock(mutex_);
  const CameraFaults faults = faults_;
  if (faults_.drop > 0) --faults_.drop;
  return faults;
}

bool FaultyCamera::is_connected() {
  const FrameLoopHeader& header = loop_.header();
  return to_glint_.socket_fd > 0 ||
         glint_frames_connect(&to_glint_, socket_path_.c_str(), header.width, header.height,
                              header.reflectivity_bits) == 0;
}

// Until the destructor; at most as many frames as a scenario lasts.
void FaultyCamera::run() {
  const Duration period{loop_.header().period_ns};
  std::int64_t old_stamp = 0;
  for (std::int64_t number = 0; !stop_; ++number) {
    const Time arrival = start_ + period * number;
    if (!sleep_until(arrival)) break;
    const CameraFaults faults = faults_of_next_frame();
    if (!sleep_until(arrival + milliseconds(faults.delay_ms)) || stop_) break;
    const bool is_sent = !faults.frozen && faults.drop == 0 && number % faults.every == 0;
    if (!is_sent || !is_connected()) continue;
    std::uint16_t* const depth = glint_frames_begin(&to_glint_);
    if (depth == nullptr) continue;  // Glint does not read
    const std::uint32_t index = loop_.index_of(static_cast<std::uint64_t>(number));
    draw(index, faults, depth);
    const LoopFrame& entry = loop_.entry(index);
    const std::int64_t stamp =
        faults.repeats ? old_stamp : arrival.nanoseconds - entry.exposure_to_arrival_ns;
    old_stamp = stamp;
    double pose[7];
    std::copy_n(entry.position_m, 3, pose);
    std::copy_n(entry.rotation_xyzw, 4, pose + 3);
    if (glint_frames_send(&to_glint_, stamp, entry.head_valid != 0 ? pose : nullptr) == 0) {
      deliveries_.push_back({monotonic_now().nanoseconds, stamp});
    }
  }
}

void FaultyCamera::draw(std::uint32_t index, const CameraFaults& faults,
                        std::uint16_t* depth) const {
  const FrameLoopHeader& header = loop_.header();
  const std::size_t pixels = std::size_t{header.width} * header.height;
  const Frame frame = loop_.view(index, Time{}, 0);
  std::uint16_t* const reflectivity = depth + pixels;
  std::copy_n(frame.depth.pixels, pixels, depth);
  std::copy_n(frame.reflectivity_16.pixels, pixels, reflectivity);
  if (faults.worst) std::fill_n(reflectivity, pixels, std::uint16_t{k_threshold + 1});
  if (faults.hides) hide_topmost_marker(reflectivity);
  if (faults.bias_mm == 0) return;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (depth[i] == 0 || depth[i] >= k_depth_invalid_from) continue;
    depth[i] = static_cast<std::uint16_t>(depth[i] + faults.bias_mm);
  }
}

void FaultyCamera::hide_topmost_marker(std::uint16_t* reflectivity) const {
  const int width = static_cast<int>(loop_.header().width);
  const int height = static_cast<int>(loop_.header().height);
  for (int at = 0; at < width * height; ++at) {
    if (reflectivity[at] <= k_threshold) continue;
    const int left = std::max(at % width - k_marker_px / 2, 0);
    const int right = std::min(left + k_marker_px, width);
    const int bottom = std::min(at / width + k_marker_px, height);
    for (int y = at / width; y < bottom; ++y) {
      std::fill(reflectivity + y * width + left, reflectivity + y * width + right,
                std::uint16_t{0});
    }
    return;
  }
}

void FaultyCamera::write_deliveries(const std::string& file) {
  stop_ = true;
  thread_.join();
  std::FILE* const to = std::fopen(file.c_str(), "w");
  if (to == nullptr) return;
  for (const Delivery& delivery : deliveries_) {
    std::fprintf(to, "%lld %lld\n", static_cast<long long>(delivery.delivered_ns),
                 static_cast<long long>(delivery.exposed_ns));
  }
  std::fclose(to);
}

}  // namespace glint::hil
