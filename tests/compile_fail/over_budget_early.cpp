// expect: ChainMissesDeadline<FrameChain, FindSpots, 3222(L|LL|l)?, false>
#include "budget.hpp"

struct FrameChain : FrameUntil<3'000> {};
static_assert(meets_deadlines<k_board, k_limits, TickChain, FrameChain>);
