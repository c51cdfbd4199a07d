// expect: success
#include "budget.hpp"

struct FrameChain : FrameUntil<6'222> {};
static_assert(meets_deadlines<k_board, k_limits, TickChain, FrameChain>);
