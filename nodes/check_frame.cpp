#include "nodes/check_frame.hpp"

namespace glint {

void CheckFrame::operator()(const FrameStamp& stamp, FrameVerdict& verdict) noexcept {
  Reason reason = stamp.reason;
  const bool first = counts_.accepted == 0;
  // A frame cannot have been exposed after its last byte arrived.
  if (reason == Reason::none && stamp.mid_exposure > stamp.arrival) reason = Reason::frame_invalid;
  if (reason == Reason::none && !first) {
    if (stamp.mid_exposure == newest_ || stamp.sequence == sequence_) {
      reason = Reason::frame_duplicate;
    } else if (stamp.mid_exposure < newest_) {
      reason = Reason::frame_late;
    }
  }

  bool resynchronised = false;
  if (reason == Reason::frame_late) {
    refused_in_row_ = stamp.mid_exposure > refused_newest_ ? refused_in_row_ + 1 : 1;
    refused_newest_ = stamp.mid_exposure;
    if (refused_in_row_ >= k_resync_frames) {
      reason = Reason::none;
      resynchronised = true;
      ++counts_.resynchronisations;
    }
  }

  switch (reason) {
    case Reason::none:
      ++counts_.accepted;
      newest_ = stamp.mid_exposure;
      sequence_ = stamp.sequence;
      refused_in_row_ = 0;
      break;
    case Reason::frame_late:
      ++counts_.late;
      break;
    case Reason::frame_duplicate:
      ++counts_.doubled;
      break;
    default:
      ++counts_.invalid;
      break;
  }

  verdict = counts_;
  verdict.stamp = stamp;
  verdict.reason = reason;
  verdict.resynchronised = resynchronised;
}

}  // namespace glint
