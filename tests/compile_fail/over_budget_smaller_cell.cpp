// expect: success
#include "budget.hpp"

// A chain that misses its deadline at the largest limits may meet it with two tools and a small
// frame.
struct FrameChain : FrameUntil<3'000> {};
static_assert(
    meets_deadlines<k_board, Limits{.width = 64, .height = 64, .tools = 2}, TickChain, FrameChain>);
