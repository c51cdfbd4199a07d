// Benchmark of Glint's chain and the published method on the same frames, one thread: first each
// row alone, then the ratios, measured in turn. Exit 1: a limit is missed.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "bench_frames.hpp"
#include "platform/lab/baseline/baseline_tracker.hpp"
#include "platform/lab/experiments/glint_chain.hpp"
#include "ratios.hpp"

namespace glint::bench {
namespace {

const Sensor& sensor_of(const benchmark::State& state) {
  return state.range(0) == 8 ? short_throw() : ahat();
}

void report_rate(benchmark::State& state, int tracked) {
  state.counters["tracked"] = benchmark::Counter(tracked, benchmark::Counter::kAvgIterations);
}

void seed_front_end(benchmark::State& state) {
  BaselineTracker tracker(sensor_of(state).camera, sensor_of(state).tool);
  Player player(sensor_of(state));
  for (auto _ : state) {
    player.next();
    benchmark::DoNotOptimize(tracker.front_end(player.frame()).size());
  }
}

void seed_chain(benchmark::State& state, bool roi) {
  BaselineSettings settings;
  settings.use_roi = roi;
  BaselineTracker tracker(sensor_of(state).camera, sensor_of(state).tool, settings);
  Player player(sensor_of(state));
  int tracked = 0;
  for (auto _ : state) {
    player.next();
    tracked += tracker.process(player.frame(), player.head()).reason == Reason::none;
  }
  report_rate(state, tracked);
}
void baseline_full_frame(benchmark::State& state) { seed_chain(state, false); }
void seed_roi(benchmark::State& state) { seed_chain(state, true); }

void glint_chain(benchmark::State& state, SearchArea area) {
  GlintChain chain(sensor_of(state).camera, sensor_of(state).tool, area);
  Player player(sensor_of(state));
  int tracked = 0;
  for (auto _ : state) {
    player.next();
    tracked += static_cast<bool>(chain.process(player.frame(), player.head()));
  }
  report_rate(state, tracked);
}
void glint_full_frame(benchmark::State& state) { glint_chain(state, SearchArea::whole_frame); }
void glint_roi(benchmark::State& state) { glint_chain(state, SearchArea::predicted); }

void plain_threshold(benchmark::State& state) {
  const Frame frame = sensor_of(state).frames.front().view();
  const cv::Size size(frame.width(), frame.height());
  const cv::Mat plane =
      state.range(0) == 8
          ? cv::Mat(size, CV_8U, const_cast<std::uint8_t*>(frame.reflectivity_8.pixels))
          : cv::Mat(size, CV_16U, const_cast<std::uint16_t*>(frame.reflectivity_16.pixels));
  cv::Mat out;
  for (auto _ : state) {
    cv::threshold(plane, out, sensor_of(state).camera.threshold, 255, cv::THRESH_BINARY);
    benchmark::DoNotOptimize(out.data);
  }
}

BENCHMARK(plain_threshold)->Name("plain_cv_threshold")->Arg(8)->Arg(16);
BENCHMARK(seed_front_end)->Name("seed/front_end")->Arg(8)->Arg(16);
BENCHMARK(baseline_full_frame)->Name("seed/chain/whole_frame")->Arg(8)->Arg(16);
BENCHMARK(seed_roi)->Name("seed/chain/roi")->Arg(8)->Arg(16);
BENCHMARK(glint_full_frame)->Name("glint/chain/whole_frame")->Arg(8)->Arg(16);
BENCHMARK(glint_roi)->Name("glint/chain/roi")->Arg(8)->Arg(16);

}  // namespace
}  // namespace glint::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::puts(
      "argument 8: 448x450 8 bit, 16: 512x512 16 bit; tracked: part of the frames with a pose");
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return glint::bench::print_ratios() ? 0 : 1;
}
