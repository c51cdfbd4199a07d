#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/unit/platform/budget/report/sample_files.hpp"

namespace glint {
namespace {

struct SampleNode {
  const char* name;
  int core;
  double start_us;  // as in the schedule
  double usual_us;
  double bound_us;
};

// In the schedule's order. A node starts when its predecessor on the same core has ended.
constexpr SampleNode k_frame_nodes[] = {
    {"StampFrame", 0, 0, 0.2, 1.1},        {"CheckFrame", 0, 1.1, 0.4, 2.4},
    {"PredictTracks", 0, 3.5, 1.6, 9.8},   {"LocateRois", 0, 13.3, 1.1, 7.2},
    {"RoiThreshold#0", 0, 20.5, 7.5, 61},  {"RoiThreshold#1", 1, 20.5, 7.1, 61},
    {"FindBlobs", 0, 81.5, 6.2, 58},       {"BackProject", 0, 139.5, 4.4, 33},
    {"Correspond#0", 0, 172.5, 5.1, 71},   {"Correspond#1", 1, 172.5, 4.6, 71},
    {"AssignMarkers", 0, 243.5, 1.2, 8.5}, {"RefinePose#0", 0, 252, 3.9, 27},
    {"RefinePose#1", 1, 252, 3.4, 27},     {"TrackTools", 0, 279, 2.3, 14}};
constexpr SampleNode k_tick_nodes[] = {{"PredictTools", 0, 0, 2.1, 12}, {"PackCan", 0, 12, 1.4, 6}};

std::int64_t ns(double us) { return std::llround(us * 1e3); }

template <std::size_t N>
TraceGroup group_of(const char* name, const SampleNode (&nodes)[N]) {
  TraceGroup group{name, {}, {}};
  for (const SampleNode& node : nodes) {
    group.nodes.emplace_back(node.name);
    group.cores.push_back(node.core);
  }
  return group;
}

class TraceMaker {
 public:
  TraceMaker(const SampleSettings& settings, TraceFile& trace)
      : settings_(settings), trace_(trace) {}

  std::int64_t frame(int number, std::int64_t release_ns) {
    const auto activation = static_cast<std::uint64_t>(number);
    const std::int64_t wake = release_ns + ns(4 + 3 * uniform());
    add({activation, release_ns, wake, static_cast<std::uint32_t>(number), 0, 0, 0, k_span_release,
         0});
    std::array<std::int64_t, 2> free_at{wake, wake};
    for (std::size_t i = 0; i < std::size(k_frame_nodes); ++i) {
      const SampleNode& node = k_frame_nodes[i];
      const bool pair = i + 1 < std::size(k_frame_nodes) && k_frame_nodes[i + 1].core == 1;
      if (node.core == 0 && !pair) free_at[0] = std::max(free_at[0], free_at[1]);
      if (node.core == 1) free_at[1] = std::max(free_at[1], pair_begin_);
      const std::int64_t begin = free_at[static_cast<std::size_t>(node.core & 1)];
      if (pair) pair_begin_ = begin;
      double us = node.usual_us * (0.9 + 0.25 * uniform() - 0.02 * std::log(uniform()));
      std::uint8_t flags = 0;
      if (number == 1234 && node.name == std::string_view("FindBlobs")) {
        us = settings_.one_frame_above_bound ? node.bound_us + 25 : 0.8 * node.bound_us;
        flags = settings_.one_frame_above_bound ? std::uint8_t{k_span_will_miss} : std::uint8_t{0};
      }
      free_at[static_cast<std::size_t>(node.core & 1)] = begin + ns(us) + 40;
      add({activation, begin, begin + ns(us), static_cast<std::uint32_t>(number), 0,
           static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(node.core), flags,
           ns(node.bound_us)});
    }
    return std::max(free_at[0], free_at[1]);
  }

  void tick(std::uint64_t activation, std::int64_t release_ns, std::uint32_t newest_frame) {
    std::int64_t at = release_ns + ns(2 + 2 * uniform());
    add({activation, release_ns, at, newest_frame, 1, 0, 0, k_span_release, 0});
    for (std::size_t i = 0; i < std::size(k_tick_nodes); ++i) {
      const double us = k_tick_nodes[i].usual_us * (0.9 + 0.3 * uniform());
      add({activation, at, at + ns(us), newest_frame, 1, static_cast<std::uint8_t>(i), 0, 0,
           ns(k_tick_nodes[i].bound_us)});
      at += ns(us) + 40;
    }
    add({activation, at, at + ns(8 + 4 * uniform()), newest_frame, 1, 0, 0, k_span_sent, 0});
  }

 private:
  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  void add(const TraceSpan& span) { trace_.spans.push_back(span); }

  const SampleSettings& settings_;
  TraceFile& trace_;
  std::mt19937_64 random_{42};
  std::int64_t pair_begin_ = 0;
};

}  // namespace

TraceFile sample_trace(const SampleSettings& settings) {
  TraceFile trace;
  trace.groups = {group_of("frame", k_frame_nodes), group_of("tick", k_tick_nodes)};
  trace.epoch_unix_ns = 1'700'000'000'000'000'000;
  trace.board = "sample-x86-64";
  trace.cell = "sample.toml";
  TraceMaker maker(settings, trace);
  std::uint64_t tick = 0;
  std::uint32_t newest = 0;
  std::int64_t next_tick_ns = 700'000;
  for (int number = 1; number <= settings.frames; ++number) {
    const std::int64_t release_ns = std::int64_t{number} * 22'222'000;
    for (; next_tick_ns < release_ns; next_tick_ns += 4'000'000) {
      maker.tick(++tick, next_tick_ns, newest);
    }
    const std::int64_t end_ns = maker.frame(number, release_ns);
    newest = static_cast<std::uint32_t>(number);
    // A tick between a frame's release and its end still reads the previous frame.
    for (; next_tick_ns < end_ns; next_tick_ns += 4'000'000) {
      maker.tick(++tick, next_tick_ns, newest - 1);
    }
  }
  maker.tick(++tick, next_tick_ns, newest);
  return trace;
}

}  // namespace glint
