// expect: ChainMissesDeadline<FrameChain, FitSpots, 1(L|LL|l)?, false>
#include "budget.hpp"

struct FrameChain : FrameUntil<6'221> {};
static_assert(meets_deadlines<k_board, k_limits, TickChain, FrameChain>);
