#include "platform/tools/inspect/explanation.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <utility>

namespace glint {
namespace {

constexpr int k_markers_of_a_pose = 3;
constexpr double k_bright_share_max = 0.2;  // of a frame with a useful threshold

constexpr const char* k_uncover =
    "uncover the markers, or bring the tool into view and turn it to the camera";

// Both without capital and full stop.
struct Cause {
  std::string found, next_step;
};

std::string line_of(const char* format, auto... values) {
  char line[240];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string spots_text(int count) {
  return count == 1 ? "1 spot" : std::to_string(count) + " spots";
}
const char* verb(int count) { return count == 1 ? "is" : "are"; }

std::optional<Cause> cause_in_frames(const ExplainedSituation& now) {
  const char* check_source = "check that the source of the frames runs and is connected";
  if (!now.any_frame) return Cause{"no frame has arrived", check_source};
  if (now.frame_gap > now.frame_gap_max) {
    return Cause{line_of("no frame has arrived for %.2f s", now.frame_gap.seconds()), check_source};
  }
  if (is_overrun(now.reason)) {
    return Cause{"computing the frame missed its deadline",
                 "lower [budget] blobs, or move other work off this computer"};
  }
  if (now.reason == Reason::tool_changed) {
    return Cause{"the tool was removed or replaced", "add it to the tools in use"};
  }
  if (now.frame_refused != Reason::none) {
    return Cause{"the newest frame was refused (" + std::string(name_of(now.frame_refused)) + ")",
                 next_step_of_refused_frame(now.frame_refused)};
  }
  if (now.frame_age > now.lost_after) {
    return Cause{line_of("frames are %.2f s old when they arrive, at most %.2f s is used",
                         now.frame_age.seconds(), now.lost_after.seconds()),
                 "check the clock and the network of the source"};
  }
  return std::nullopt;
}

std::optional<Cause> low_threshold(const ExplainedSituation& now) {
  if (!now.regions || now.regions->bright_share <= k_bright_share_max) return std::nullopt;
  return Cause{line_of("%.0f %% of the picture exceed the threshold of %u counts",
                       1e2 * now.regions->bright_share, now.regions->threshold),
               "set a higher [camera] threshold"};
}

// A threshold that a tool was tracked with is not the cause.
std::optional<Cause> high_threshold(const ExplainedSituation& now) {
  if (!now.regions || now.ever_measured) return std::nullopt;
  if (now.regions->brightest > now.regions->threshold) return std::nullopt;
  return Cause{line_of("no pixel exceeds the threshold of %u counts, the brightest has %u",
                       now.regions->threshold, now.regions->brightest),
               line_of("bring the tool into view; if it is, set [camera] threshold below %u",
                       now.regions->brightest)};
}

// A trial that finds the tool with another setting. Spots that are missing or do not fit are
// explained by what was observed.
std::optional<Cause> cause_in_settings(const ExplainedSituation& now) {
  if (!now.cause) return std::nullopt;
  const std::string& check = now.cause->check;
  const bool by_trial =
      check == "range" || check == "marker size" || check == "brightness" || check == "distances";
  if (!by_trial) return std::nullopt;
  return Cause{now.cause->found, now.cause->next_step};
}

// Too few candidates for a pose.
Cause cause_in_spots(const ExplainedSituation& now, const RegionCounts& counts) {
  const auto would_do = [&](int refused) {
    return refused > 0 && refused + counts.candidates >= k_markers_of_a_pose;
  };
  if (would_do(counts.too_small)) {
    std::string found = spots_text(counts.too_small) + " " + verb(counts.too_small) + " too small";
    if (counts.too_small_range_m > 0) found += line_of(", at %.2f m", counts.too_small_range_m);
    return {found, line_of("move closer than %.2f m", now.range_max_m)};
  }
  if (counts.too_large >= k_markers_of_a_pose) {
    return {spots_text(counts.too_large) + " are too large for a marker",
            line_of("move farther than %.2f m, or check radius_mm of the tool's file",
                    now.range_min_m)};
  }
  if (would_do(counts.no_depth)) {
    return {
        spots_text(counts.no_depth) + " " + (counts.no_depth == 1 ? "has" : "have") + " no depth",
        line_of("hold the tool between %.2f and %.2f m", now.range_min_m, now.range_max_m)};
  }
  if (counts.touching_edge > 0) {
    return {spots_text(counts.touching_edge) + " " + verb(counts.touching_edge) +
                " cut by the edge of the picture",
            "bring the tool to the middle of the picture"};
  }
  if (counts.candidates == 0) return {"no marker is visible", k_uncover};
  return {spots_text(counts.candidates) + " of a marker's size " + verb(counts.candidates) +
              " visible, a pose needs " + std::to_string(k_markers_of_a_pose),
          k_uncover};
}

bool is_mismatch(Reason reason) {
  return reason == Reason::bad_fit || reason == Reason::imprecise || reason == Reason::ambiguous ||
         reason == Reason::markers_assigned_elsewhere || reason == Reason::search_full ||
         reason == Reason::blobs_full;
}

const char* edge_name(LeftView side) {
  switch (side) {
    case LeftView::left:
      return "left";
    case LeftView::right:
      return "right";
    case LeftView::top:
      return "top";
    default:
      return "bottom";
  }
}

Cause cause_of(const ExplainedSituation& now) {
  if (auto cause = cause_in_frames(now)) return *cause;
  if (auto cause = low_threshold(now)) return *cause;
  if (auto cause = cause_in_settings(now)) return *cause;
  if (auto cause = high_threshold(now)) return *cause;
  if (is_mismatch(now.reason)) {
    return {mismatch_text(now.reason), "turn the tool to the camera, or hold it closer"};
  }
  if (now.left_view == LeftView::far) {
    return {line_of("the tool moved farther away than %.2f m", now.range_max_m), "move closer"};
  }
  if (now.left_view != LeftView::no) {
    return {std::string("the tool left the picture at its ") + edge_name(now.left_view) + " edge",
            "turn the headset to the tool, or bring the tool back"};
  }
  if (!now.regions || now.regions->finds_tool) {
    return {now.reason == Reason::too_few_markers ? "fewer than 3 markers were visible"
                                                  : "the newest frame gave no pose",
            k_uncover};
  }
  const RegionCounts& counts = now.regions->counts;
  if (counts.candidates < k_markers_of_a_pose) return cause_in_spots(now, counts);
  // The distances of a tool that was tracked are right.
  if (now.ever_measured) {
    return {"its markers are not visible, none of the " + spots_text(counts.candidates) +
                " in view belongs to it",
            k_uncover};
  }
  return {mismatch_text(Reason::no_labeling),
          "compare the tool's file with the tool: glint calibrate tool"};
}

std::string sentence(std::string lead, const Cause& cause) {
  std::string step = cause.next_step;
  if (!step.empty()) {
    step[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(step[0])));
  }
  return std::move(lead) + ": " + cause.found + "." + (step.empty() ? "" : " " + step + ".");
}

std::string tracked_text(const ExplainedSituation& now) {
  std::string text = line_of("Tracked by %d of %d markers", now.markers_used, now.markers);
  if (now.markers_used >= k_markers_of_a_pose) return text + ".";
  return text + " and its motion. Uncover the others.";
}

}  // namespace

Explanation explain(const ExplainedSituation& now) {
  const std::string reason(name_of(now.reason));
  if (now.state == TrackState::measured) return {"measured", "", tracked_text(now)};
  if (now.state == TrackState::predicted) {
    const std::string lead = line_of("Predicted for %.1f s, lost after %.2f s",
                                     now.unmeasured_for.seconds(), now.lost_after.seconds());
    return {"predicted", reason, sentence(lead, cause_of(now))};
  }
  if (!now.ever_measured) return {"never_found", reason, sentence("Not found", cause_of(now))};
  return {"lost", reason, sentence("Not tracked", cause_of(now))};
}

}  // namespace glint
