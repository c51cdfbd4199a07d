// Benchmark of one tool's filter and prediction, and of a tick with sixteen tools.
#include <benchmark/benchmark.h>

#include <memory>

#include "kernels/elementary.hpp"
#include "kernels/motion/integrate_motion.hpp"
#include "kernels/motion/predict_motion.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"

namespace glint::bench {
namespace {

constexpr Duration k_gap = {22'222'222};
constexpr Duration k_ahead = milliseconds(25);
constexpr int k_swing_frames = 90;  // 2 s of frames, four periods

// A tool that swings 50 mm in each direction at 2 Hz, with declared noise of 1 mm and 0.3 degrees;
// or a static tool.
UncertainPose seen(int frame, bool moving) {
  constexpr double two_hertz = 2 * 2 * M_PI;
  UncertainPose pose;
  pose.time = Time{} + k_gap * frame;
  const double phase = two_hertz * k_gap.seconds() * frame;
  const double swing = moving ? sine_cosine(phase).sine : 0;
  pose.pose.translation = {0.05 * swing, 0, 0.5};
  const SineCosine half = sine_cosine(0.1 * swing);
  pose.pose.rotation = Quaternion(half.cosine, 0, half.sine, 0);
  pose.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 2.7e-5, 2.7e-5, 2.7e-5;
  return pose;
}

// A frame's update of the filter and the static detector, then one prediction: integrated, with
// covariance.
void filter_and_predict(benchmark::State& state) {
  const bool moving = state.range(0) != 0;
  auto motion = std::make_unique<ToolMotion>();
  MotionIntegrator integrator;
  if (integrator.prepare(motion->settings.motion) != Reason::none) {
    state.SkipWithError("SUNDIALS cannot be prepared: no memory");
    return;
  }
  int frame = 0;
  // Until the static window has its maximal length.
  for (; frame < 4 * k_swing_frames; ++frame) (void)motion->update(seen(frame, moving));
  for (auto _ : state) {
    benchmark::DoNotOptimize(motion->update(seen(++frame, moving)));
    const MotionState now = motion->estimate();
    const Time then = now.time + k_ahead;
    const MovingPose pose = integrator.after(now, k_ahead).value;
    const UncertainPose predicted =
        predict_pose(now, then, motion->settings.motion, motion->noise_scale());
    benchmark::DoNotOptimize(pose.pose.translation.sum() + predicted.covariance.sum());
  }
  state.counters["rests"] = motion->is_static() ? 1 : 0;
}

// Both nodes of a tick: all sixteen tools have a pose, and CAN's periodic frames are due.
void tick_of_sixteen(benchmark::State& state) {
  Limits limits;
  limits.tools = k_tools_max;
  const auto predict = inputs::predict_tools_kernel();
  const auto pack = inputs::pack_can_kernel();
  predict->set_input(InputKind::worst, 1, limits);
  pack->set_input(InputKind::worst, 1, limits);
  for (auto _ : state) {
    pack->rewind();
    predict->run();
    pack->run();
    benchmark::ClobberMemory();
  }
}

BENCHMARK(filter_and_predict)->Name("kernel/filter_and_predict/moving")->Arg(0)->Arg(1);
BENCHMARK(tick_of_sixteen)->Name("group/tick/16_tools");

}  // namespace
}  // namespace glint::bench
