// Camera with faults: streams a loop of frames to Glint through shared memory, as a process of
// another device would. A thread of its own sends each frame at its time.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/sources/glint_frames.h"
#include "tests/hil/injector/script.hpp"

namespace glint::hil {

// Faults that last until they are changed.
struct CameraFaults {
  std::int64_t every = 1;     // one of that many frames is sent
  bool frozen = false;        // no frame is sent
  std::int64_t drop = 0;      // frames still to lose
  bool repeats = false;       // sends the newest frame again, with its old stamp
  bool hides = false;         // paints the topmost marker dark
  std::int64_t bias_mm = 0;   // added to each depth
  std::int64_t delay_ms = 0;  // from the frame's own arrival to its delivery
  bool worst = false;         // every pixel bright: one blob of the complete frame
};

class FaultyCamera {
 public:
  // Connects to Glint's socket whenever it listens. `start`: of the first frame.
  FaultyCamera(const std::string& loop_file, std::string socket, Time start);
  ~FaultyCamera();
  FaultyCamera(const FaultyCamera&) = delete;
  FaultyCamera& operator=(const FaultyCamera&) = delete;

  void apply(const Command& command);
  // Stops, and writes a line per delivered frame: time of delivery and of exposure, ns.
  void write_deliveries(const std::string& file);

 private:
  void run();
  [[nodiscard]] bool is_connected();
  [[nodiscard]] CameraFaults faults_of_next_frame();
  void draw(std::uint32_t index, const CameraFaults& faults, std::uint16_t* depth) const;
  void hide_topmost_marker(std::uint16_t* reflectivity) const;

  struct Delivery {
    std::int64_t delivered_ns, exposed_ns;
  };

  FrameLoop loop_;
  std::string socket_path_;
  Time start_;
  std::mutex mutex_;
  CameraFaults faults_;
  std::atomic<bool> stop_{false};
  glint_frames to_glint_{};
  std::vector<Delivery> deliveries_;
  RealTimeThread thread_;  // last: it uses all of the above
};

}  // namespace glint::hil
