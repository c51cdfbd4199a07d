// expect: success
#include "budget.hpp"

// What is late at the largest limits may be in time in a cell of two tools and a small frame.
struct FrameChain : FrameUntil<3'000> {};
static_assert(fits<k_board, Limits{.width = 64, .height = 64, .tools = 2}, TickChain, FrameChain>);
