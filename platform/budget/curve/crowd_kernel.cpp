#include "platform/budget/curve/crowd_kernel.hpp"

#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/crowded.hpp"

namespace glint {
namespace {

constexpr std::uint64_t k_scene_random_seed = 1;

}  // namespace

void DenseSceneKernel::prepare() {
  const Cell cell = crowd_cell(point_.tools);
  const sim::Simulator simulator(sim::crowded_run(cell.tools, point_.strays, k_scene_random_seed));
  period_ = cell.camera.period;
  for (std::size_t i = 0; i < k_frames; ++i) {
    frames_[i] = std::make_unique<sim::SimFrame>();
    simulator.render(static_cast<int>(i), *frames_[i]);
  }
  tracker_ = std::make_unique<Tracker>();
  configure(cell, *tracker_);
  tool_set_.write_slot() = cell.tools;
  tool_set_.publish(1, 0);
  tracker_->latest<ToolSet>().bind(tool_set_);
  tracker_->sample();
  // The first frame finds the tools; from the second on they are searched around their predictions.
  for (int i = 0; i < 2; ++i) {
    frame_ = frames_[0].get();
    rewind();
    run();
  }
}

void DenseSceneKernel::set_input(InputKind /*kind*/, std::uint64_t number,
                                 const Limits& /*limits*/) {
  if (tracker_ == nullptr) prepare();
  const std::uint64_t position = number % (2 * k_frames - 2);
  const std::uint64_t at = position < k_frames ? position : 2 * k_frames - 2 - position;
  frame_ = frames_[at].get();
}

void DenseSceneKernel::rewind() {
  ++sequence_;
  const Time now = Time{} + period_ * static_cast<std::int64_t>(sequence_);
  tracker_->input<Frame>() = frame_->pixels.view(now, now, sequence_);
  tracker_->input<HeadPose>() = frame_->head;
  tracker_->input<HeadPose>().time = now;
}

int DenseSceneKernel::tools_seen() const {
  int seen = 0;
  const Estimates& estimates = tracker_->output<Estimates>();
  for (const Track& track : estimates.tracks) seen += track.measured_now ? 1 : 0;
  return seen;
}

}  // namespace glint
