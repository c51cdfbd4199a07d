// Compile-time check for a build with -DGLINT_BOARD=NAME: this file compiles only if the usual
// cell's chains meet their deadlines on that board.
#include "glint_board_costs.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/budget/measure/measured_limits.hpp"
#include "schedules/fits.hpp"

namespace glint {

struct TickChain {
  using Graph = Output;
  static constexpr std::int64_t deadline_ns = 4'000'000;  // 250 Hz
  static constexpr std::int64_t gap_ns = 4'000'000;
};
struct FrameChain {
  using Graph = Tracker;
  static constexpr std::int64_t deadline_ns = 22'222'222;  // AHAT at 45 Hz
  static constexpr std::int64_t gap_ns = 22'222'222;
};
static_assert(meets_deadlines<board::k_table, measured_cell_limits(), TickChain, FrameChain>);

}  // namespace glint
