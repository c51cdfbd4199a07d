// Explanation: why a tool is tracked or not, in one sentence with the next step.
//
// A pure function of what the viewer's thread has observed, for the live view, recordings and
// `glint inspect --recording`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kernels/reason.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/tools/inspect/diagnosis.hpp"
#include "platform/tools/inspect/examined_frame.hpp"

namespace glint {

// Brightness and regions of the newest examined frame.
struct ObservedRegions {
  unsigned threshold = 0, brightest = 0;
  double bright_share = 0;
  RegionCounts counts;
  bool finds_tool = false;  // a search of this frame alone finds the tool
};

// Where a tool that keeps its last velocity is outside the picture, or beyond the range.
enum class LeftView : std::uint8_t { no, left, right, top, bottom, far };

struct ExplainedSituation {
  // The tool's newest output.
  TrackState state = TrackState::none;
  Reason reason = Reason::no_frame_yet;
  int markers_used = 0, markers = 0;
  Duration unmeasured_for;     // since its newest measurement
  bool ever_measured = false;  // had a pose before
  // The frames.
  bool any_frame = false;
  Duration frame_gap;                      // since the newest one arrived
  Duration frame_gap_max;                  // longer: none arrives
  Duration frame_age;                      // of the newest one, at its arrival
  Duration lost_after;                     // maximum age of a measurement
  Reason frame_refused = Reason::none;     // the newest one
  std::optional<ObservedRegions> regions;  // none: frames are not recorded
  LeftView left_view = LeftView::no;
  std::optional<CheckRow> cause;            // the setting that a trial found wrong
  double range_min_m = 0, range_max_m = 0;  // where tools are expected
};

struct Explanation {
  std::string state;   // measured, predicted, lost, never_found
  std::string reason;  // name of the Reason; "" if measured
  std::string text;
};

[[nodiscard]] Explanation explain(const ExplainedSituation& situation);

}  // namespace glint
