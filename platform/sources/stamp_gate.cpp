#include "platform/sources/stamp_gate.hpp"

#include <algorithm>

namespace glint {

bool StampGate::take(Time stamp) {
  if (stamp > k_stamp_max || stamp.nanoseconds < -k_stamp_max.nanoseconds) {
    ++counts_.far_off;
    return false;
  }
  if (!any_) {
    any_ = true;
    newest_ = stamp;
    return true;
  }
  const Duration gap = stamp - newest_;
  if (gap == Duration{}) {
    ++counts_.doubled;
    return false;
  }
  if (gap > Duration{} && gap <= k_stamp_step_max) {
    if (gap > k_gap_counted) ++counts_.gaps;
    counts_.longest_gap = std::max(counts_.longest_gap, gap);
  } else if (restarts_at(stamp)) {
    ++counts_.restarts;
    offset_ = offset_ + (newest_ - stamp) + nominal_gap_;
  } else {
    ++(gap < Duration{} ? counts_.backward : counts_.far_off);
    return false;
  }
  newest_ = stamp;
  skipped_in_row_ = 0;
  return true;
}

bool StampGate::restarts_at(Time stamp) {
  const bool follows = skipped_in_row_ > 0 && stamp > skipped_ && stamp - skipped_ <= k_gap_counted;
  skipped_in_row_ = follows ? skipped_in_row_ + 1 : 1;
  skipped_ = stamp;
  return skipped_in_row_ > k_restart_stamps;
}

}  // namespace glint
