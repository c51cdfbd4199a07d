// expect: NodeWithoutCost<FitSpots, false>
#include "budget.hpp"

inline constexpr std::array<KernelCost, 3> k_stale = {{
    {"FindSpots", {"call", "pixels"}, {0, 10}},
    {"FitSpots", {"call", "markers"}, {0, 100'000}},
    {"Send", {"call"}, {1'000'000}},
}};
inline constexpr CostTable k_stale_board = {"bench", "any", "none", k_stale};

struct FrameChain : FrameUntil<20'000> {};
static_assert(meets_deadlines<k_stale_board, k_limits, TickChain, FrameChain>);
