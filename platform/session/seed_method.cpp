#include "platform/session/seed_method.hpp"

namespace glint {

SeedMethod::SeedMethod(const Cell& cell) : seed_(cell.camera, cell.tools.items[0]) {
  ToolSet set = cell.tools;
  set.count = 1;
  tools_.set(set, 1, 0);
  track_.settings.lost_after = cell.lost_after;
}

const Estimates& SeedMethod::process(const ArrivedFrame& arrived) {
  FrameStamp stamp{arrived.frame.mid_exposure, arrived.frame.arrival, arrived.frame.sequence,
                   Reason::none};
  FrameVerdict verdict;
  check_(stamp, verdict);

  FittedTool& fitted = fitted_[0].tools[0];
  fitted = FittedTool{};
  fitted.reason = verdict.reason;
  if (verdict.usable()) {
    const SeedResult result = seed_.process(arrived.frame, arrived.head);
    fitted.reason = result.reason;
    fitted.rms_m = result.rms_m;
    fitted.T_camera_tool = result.T_camera_tool;
    // The publication says nothing of which markers: the mask tells only how many.
    fitted.marker_mask = static_cast<std::uint8_t>((1u << result.marker_count) - 1u);
  }
  last_ = estimates_;
  track_(verdict, arrived.head, tools_, fitted_, graph::Previous<Estimates>(last_), estimates_);
  return estimates_;
}

}  // namespace glint
