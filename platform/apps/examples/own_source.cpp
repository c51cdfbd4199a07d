// A frame source of this program: Glint's loop waits for each frame and returns its pixels.
#include <cstdio>
#include <glint/platform/runtime/session/frame_source.hpp>
#include <glint/platform/runtime/session/pipeline.hpp>
#include <memory>

#include "drawn_frame.hpp"

namespace {

using namespace glint;

// The pen moves 2 mm a frame along x. A driver would block in wait() until its device delivers.
class DrawnSource final : public FrameSource {
 public:
  DrawnSource(const Cell& cell, std::uint64_t frames)
      : cell_(&cell), frames_(frames), drawn_(cell.camera) {}

  void start(const SourceClock& /*clock*/) override { sent_ = 0; }
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override {
    if (sent_ == frames_) return false;
    ++sent_;
    Pose T_camera_tool;
    T_camera_tool.translation = Vector3(0.002 * static_cast<double>(sent_), 0, 0.35);
    const Time time = Time{} + cell_->camera.period * static_cast<std::int64_t>(sent_);
    arrived.frame = drawn_.draw(cell_->tools.items[0], T_camera_tool, time, sent_);
    arrived.head = {};
    note_advance();
    return true;
  }
  void release_pixels(const ArrivedFrame& /*arrived*/) noexcept override { ++released_; }
  [[nodiscard]] SourceReport report() override {
    return {"drawn frames", {{"sent", sent_}, {"held", sent_ - released_}}, {}, {}};
  }

 private:
  const Cell* cell_;
  std::uint64_t frames_, sent_ = 0, released_ = 0;
  DrawnFrame drawn_;
};

// Returns the number of frames in which the pen was measured. Accepts any source.
int track_all(const Cell& cell, FrameSource& source) {
  const auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);
  source.start({});
  int measured = 0;
  for (ArrivedFrame arrived; source.wait(arrived);) {
    tracker->input<Frame>() = arrived.frame;
    tracker->input<HeadPose>() = arrived.head;
    tracker->activate();
    source.release_pixels(arrived);
    measured += tracker->output<Estimates>().tracks[0].measured_now ? 1 : 0;
  }
  return measured;
}

}  // namespace

int main() {
  const Cell cell = default_cell();
  DrawnSource source(cell, 20);
  const int measured = track_all(cell, source);
  const SourceReport report = source.report();
  std::printf("%s: %d measured", report.text.c_str(), measured);
  for (const auto& [name, count] : report.counts) {
    std::printf(", %llu %s", static_cast<unsigned long long>(count), name.c_str());
  }
  std::printf("\n");
  return measured == 20 ? 0 : 1;
}
