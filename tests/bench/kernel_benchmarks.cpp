// Benchmark of each kernel alone, on its input in the chain.
#include <benchmark/benchmark.h>

#include <memory>

#include "bench_frames.hpp"
#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/back_project.hpp"
#include "kernels/pose/correspond.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "platform/lab/experiments/glint_chain.hpp"

namespace glint::bench {
namespace {

const Sensor& sensor_of(const benchmark::State& state) {
  return state.range(0) == 8 ? short_throw() : ahat();
}

// A chain after ten frames, with the tokens that are the kernels' input.
struct Warm {
  explicit Warm(const Sensor& sensor) : chain(sensor.camera, sensor.tool), player(sensor) {
    for (int i = 0; i < 10; ++i) {
      player.next();
      (void)chain.process(player.frame(), player.head());
    }
  }
  template <class T>
  const T& token() {
    return chain.tracker().token<T>();
  }
  GlintChain chain;
  Player player;
};

void threshold_in(benchmark::State& state, bool whole) {
  Warm warm(sensor_of(state));
  const Frame& frame = warm.player.frame();
  const Rois rois = whole ? whole_frame(frame) : warm.token<Rois>();
  auto runs = std::make_unique<Runs>();
  for (auto _ : state) {
    threshold_runs(frame, rois, sensor_of(state).camera.threshold, RowBand{0, 1}, *runs);
    benchmark::DoNotOptimize(runs->count);
  }
}
void threshold_full_frame(benchmark::State& state) { threshold_in(state, true); }
void threshold_roi(benchmark::State& state) { threshold_in(state, false); }

void blobs(benchmark::State& state) {
  Warm warm(sensor_of(state));
  const Frame& frame = warm.player.frame();
  auto runs = std::make_unique<Runs>();
  auto scratch = std::make_unique<BlobScratch>();
  auto out = std::make_unique<Blobs>();
  threshold_runs(frame, whole_frame(frame), sensor_of(state).camera.threshold, RowBand{0, 1},
                 *runs);
  const Runs* const bands[] = {runs.get()};
  const BlobSettings settings = warm.chain.tracker().node<FindBlobs>().settings;
  for (auto _ : state) {
    find_blobs(frame, bands, settings, {}, *scratch, *out);
    benchmark::DoNotOptimize(out->count);
  }
  state.counters["blobs"] = out->count;
}

void back_projection(benchmark::State& state) {
  Warm warm(sensor_of(state));
  const Blobs& found = warm.token<Blobs>();
  const BackProject& node = warm.chain.tracker().node<BackProject>();
  const SphereOffset shift = sphere_offset(node.camera);
  Marker marker;
  for (auto _ : state) {
    for (int i = 0; i < found.count; ++i) {
      const bool seen = measure_marker(
          warm.player.frame(), found.items[static_cast<std::size_t>(i)],
          static_cast<std::uint16_t>(i), node.camera, shift, node.depth, node.nominal, marker);
      benchmark::DoNotOptimize(seen);
    }
  }
  state.counters["blobs"] = found.count;
}

void correspondence_with(benchmark::State& state, bool prior) {
  Warm warm(sensor_of(state));
  const Sensor& sensor = sensor_of(state);
  const Markers& markers = warm.token<Markers>();
  const CorrespondSettings settings = warm.chain.tracker().node<Correspond>().settings;
  const Pose predicted = warm.token<Predictions>().tools[0].T_camera_tool;
  auto labelings = std::make_unique<Labelings>();
  auto scratch = std::make_unique<CorrespondScratch>();
  for (auto _ : state) {
    propose_labelings(markers, sensor.tool, settings, prior ? &predicted : nullptr, *scratch,
                      *labelings);
    benchmark::DoNotOptimize(labelings->count);
  }
  state.counters["markers"] = markers.count;
}
void correspondence(benchmark::State& state) { correspondence_with(state, false); }
void correspondence_with_prior(benchmark::State& state) { correspondence_with(state, true); }

void rigid_fit(benchmark::State& state) {
  const Sensor& sensor = sensor_of(state);
  const std::span model(sensor.tool.markers_m.data(),
                        static_cast<std::size_t>(sensor.tool.marker_count));
  const Pose pose{Quaternion(0.8, 0.3, -0.4, 0.2).normalized(), Vector3(0.1, 0, 0.5)};
  std::vector<Vector3> measured;
  for (const Vector3& marker : model) measured.push_back(pose * marker);
  for (auto _ : state) {
    RigidFit fit = fit_rigid(model, measured);
    benchmark::DoNotOptimize(fit.rms_m);
  }
}

void prediction(benchmark::State& state) {
  const TimedPose a{Time{0}, {Quaternion(0.8, 0.3, -0.4, 0.2).normalized(), Vector3(0.1, 0, 0.5)}};
  const TimedPose b{Time{22'000'000},
                    {Quaternion(0.8, 0.32, -0.41, 0.2).normalized(), Vector3(0.11, 0, 0.5)}};
  std::int64_t time = 22'000'000;
  for (auto _ : state) {
    Pose pose = extrapolate(a, b, Time{++time}, milliseconds(60));
    benchmark::DoNotOptimize(pose.translation.x());
  }
}

BENCHMARK(threshold_full_frame)->Name("kernel/roi_threshold/whole_frame")->Arg(8)->Arg(16);
BENCHMARK(threshold_roi)->Name("kernel/roi_threshold/roi")->Arg(8)->Arg(16);
BENCHMARK(blobs)->Name("kernel/find_blobs")->Arg(8)->Arg(16);
BENCHMARK(back_projection)->Name("kernel/measure_marker/all_blobs")->Arg(8)->Arg(16);
BENCHMARK(correspondence)->Name("kernel/propose_labelings")->Arg(8)->Arg(16);
BENCHMARK(correspondence_with_prior)->Name("kernel/propose_labelings/prior")->Arg(8)->Arg(16);
BENCHMARK(rigid_fit)->Name("kernel/fit_rigid/5_markers")->Arg(8);
BENCHMARK(prediction)->Name("kernel/extrapolate")->Arg(8);

}  // namespace
}  // namespace glint::bench
