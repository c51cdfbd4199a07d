// Compiled when the build is made for a board (-DGLINT_BOARD=NAME): the usual cell's chains must
// meet their deadlines there, or this file does not compile.
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
static_assert(fits<board::k_table, measured_cell_limits(), TickChain, FrameChain>);

}  // namespace glint
