// Two chains with budgets, and the cost table k_board: the tick takes 1,000 ns, the frame's nodes
// at k_limits 2,621 ns (262,144 pixels at 10 ps) and 1,600 ns (16 tools at 100 ns).
#pragma once

#include "schedules/fits.hpp"

using namespace glint;

struct Frame {};
struct Spots {};
struct Poses {};
struct Now {};
struct Sent {};

struct FindSpots {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "pixels"};
  static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, static_cast<std::int64_t>(limits.width) * limits.height}};
  }
  graph::LoopCounts counts() const noexcept { return {{1, 0}}; }
  void operator()(const Frame&, Spots&) noexcept {}
};
struct FitSpots {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "tools"};
  static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools}};
  }
  graph::LoopCounts counts() const noexcept { return {{1, 0}}; }
  void operator()(const Spots&, Poses&) noexcept {}
};
struct Send {
  static constexpr std::array<std::string_view, 1> k_loops = {"call"};
  static constexpr graph::LoopCounts worst(const Limits&) noexcept { return {{1}}; }
  graph::LoopCounts counts() const noexcept { return {{1}}; }
  void operator()(const Now&, Sent&) noexcept {}
};

inline constexpr Limits k_limits{.width = 512, .height = 512};
inline constexpr std::array<KernelCost, 3> k_costs = {{
    {"FindSpots", {"call", "pixels"}, {0, 10}},
    {"FitSpots", {"call", "tools"}, {0, 100'000}},
    {"Send", {"call"}, {1'000'000}},
}};
inline constexpr CostTable k_board = {"bench", "any", "none", k_costs};

struct TickChain {
  using Graph = graph::Graph<graph::Inputs<Now>, graph::Outputs<Sent>, Send>;
  static constexpr std::int64_t deadline_ns = 4'000;
  static constexpr std::int64_t gap_ns = 4'000;
};
// 2,622 + 1,600 = 4,222 ns, and two ticks of 1,000 ns that may come meanwhile.
template <std::int64_t deadline>
struct FrameUntil {
  using Graph = graph::Graph<graph::Inputs<Frame>, graph::Outputs<Poses>, FindSpots, FitSpots>;
  static constexpr std::int64_t deadline_ns = deadline;
  static constexpr std::int64_t gap_ns = 20'000;
};
