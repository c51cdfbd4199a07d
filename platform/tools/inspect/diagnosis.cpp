#include "platform/tools/inspect/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "platform/cells/tool_file.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {
namespace {

constexpr int k_markers_needed = 3;
// With more blobs, some match a tool's distances by chance: such a trial shows no cause.
constexpr int k_blobs_trial_max = 40;

std::string name_of_tool(const Cell& cell, int tool) {
  return cell.tools.items[static_cast<std::size_t>(tool)].name.data();
}

// Repeats the search of one frame with other settings, one tool at a time.
class Trials {
 public:
  Trials(const Cell& cell, const Frame& frame, const Tool& tool) : cell_(cell), frame_(frame) {
    cell_.tools = ToolSet{};
    cell_.tools.count = 1;
    cell_.tools.items[0] = tool;
    cell_.reference = -1;
  }

  // Returns whether the tool is found after `change(cell)`.
  [[nodiscard]] bool finds(const auto& change) {
    Cell cell = cell_;
    change(cell);
    tracker_ = std::make_unique<Tracker>();
    configure(cell, *tracker_);
    tracker_->latest<ToolSet>().set(cell.tools, 1, 0);
    tracker_->input<Frame>() = frame_;
    tracker_->activate();
    const Blobs& blobs = tracker_->token<Blobs>();
    return tracker_->output<Estimates>().tracks[0].measured_now &&
           blobs.count + static_cast<int>(blobs.left_out) <= k_blobs_trial_max;
  }

 private:
  Cell cell_;
  Frame frame_;
  std::unique_ptr<Tracker> tracker_;
};

void scale_radius(Cell& cell, double factor) {
  Tool& tool = cell.tools.items[0];
  tool.marker_radius_m *= factor;
  (void)prepare_tool(tool);
}

std::string text(const char* format, auto... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

struct ObservedBlobs {
  const Blobs& blobs;
  const Markers& markers;
  int without_depth = 0;

  explicit ObservedBlobs(Tracker& tracker)
      : blobs(tracker.token<Blobs>()), markers(tracker.token<Markers>()) {
    int ranged = 0;
    for (int i = 0; i < markers.count; ++i) {
      ranged += (markers.items[static_cast<std::size_t>(i)].flags & k_marker_no_depth) == 0;
    }
    without_depth = blobs.count - ranged;
  }
  [[nodiscard]] int ranged() const { return blobs.count - without_depth; }
  [[nodiscard]] unsigned outside_gate() const { return blobs.dropped - blobs.left_out; }
};

CheckRow frame_row(const Tracker& tracker) {
  const FrameVerdict& verdict = tracker.output<Estimates>().verdict;
  if (verdict.usable()) return {"frame", true, "accepted", ""};
  return {"frame", false, "refused: " + std::string(name_of(verdict.reason)),
          next_step_of_refused_frame(verdict.reason)};
}

CheckRow head_row(Tracker& tracker) {
  if (tracker.input<HeadPose>().valid) return {"head pose", true, "valid", ""};
  return {"head pose", true, "none: poses in the camera's frame only",
          "record the head pose with the frames for poses in the world"};
}

// Tries range, marker size and brightness, in this order: a lower threshold enlarges blobs and can
// hide a wrong size; a wrong size can imitate a wrong range. Returns true if one of them is the
// cause.
bool add_settings_rows(const Camera& camera, const Tool& tool, const ObservedBlobs& seen,
                       Trials& trials, std::vector<CheckRow>& rows) {
  bool explained = false;
  const auto add = [&](CheckRow row, const auto& values, const auto& change, const auto& explain) {
    for (const auto& value : values) {
      if (explained) break;
      if (!trials.finds([&](Cell& changed) { change(changed, value); })) continue;
      row.passes = false;
      explain(row, value);
      explained = true;
    }
    rows.push_back(std::move(row));
  };

  using Factors = std::pair<double, double>;
  add(
      {"range", true,
       text("tools are expected from %.0f to %.0f mm; %d spots have no depth",
            1e3 * camera.range_min_m, 1e3 * camera.range_max_m, seen.without_depth),
       ""},
      std::array{Factors{0.3, 1.0}, Factors{1.0, 2.0}, Factors{1.0, 4.0}},
      [](Cell& changed, const Factors& factors) {
        changed.camera.range_min_m *= factors.first;
        changed.camera.range_max_m *= factors.second;
      },
      [&](CheckRow& row, const Factors& factors) {
        const double from = 1e3 * factors.first * camera.range_min_m;
        const double to = 1e3 * factors.second * camera.range_max_m;
        row.found += text("; with range %.0f to %.0f mm the tool is found", from, to);
        row.next_step = text(
            "hold the tool within the range, or set [camera] range_mm = [%.0f, %.0f]", from, to);
      });
  if (!explained && seen.blobs.count >= k_markers_needed && seen.ranged() < k_markers_needed) {
    rows.back().passes = false;
    rows.back().next_step =
        "check the depth plane and [camera] depth, depth_unit_mm, depth_invalid_from";
    explained = true;
  }
  add(
      {"marker size", true,
       text("%u bright spots are too small or too large for a marker", seen.outside_gate()), ""},
      std::array{0.7, 1.4, 0.5, 2.0, 0.35, 2.8},
      [](Cell& changed, double factor) { scale_radius(changed, factor); },
      [&](CheckRow& row, double factor) {
        row.found += text("; with a radius of %.1f mm the tool is found",
                          1e3 * factor * tool.marker_radius_m);
        row.next_step = text("measure the markers: the tool's file has radius_mm = %.1f",
                             1e3 * tool.marker_radius_m);
      });
  const auto lowered = [&](double part) {
    return unsigned{static_cast<std::uint16_t>(std::max(1.0, part * camera.threshold))};
  };
  add(
      {"brightness", true,
       text("%d spots of a marker's size above %u counts", seen.blobs.count,
            unsigned{camera.threshold}),
       ""},
      std::array{0.7, 0.5, 0.35, 0.25, 0.1, 0.04, 0.016},
      [&](Cell& changed, double part) {
        changed.camera.threshold = static_cast<std::uint16_t>(lowered(part));
      },
      [&](CheckRow& row, double part) {
        row.found += text("; with %u the tool is found", lowered(part));
        row.next_step = text("set [camera] threshold = %u, or clean the markers", lowered(part));
      });
  return explained;
}

// Adds the observations, and the change of the trial that finds the tool.
void add_causes(const Cell& cell, Tracker& tracker, const Tool& tool, Reason reason,
                std::vector<CheckRow>& rows) {
  const ObservedBlobs seen(tracker);
  Trials trials(cell, tracker.input<Frame>(), tool);
  CheckRow search{"search", true, "the whole frame, or the region around the prediction", ""};
  if (trials.finds([](Cell&) {})) {
    search.passes = false;
    search.found = "a newly started tracker finds the tool in this frame";
    search.next_step =
        "check the previous frames: the track was elsewhere, or the tool has just reappeared";
    rows.push_back(search);
    return;
  }
  rows.push_back(search);
  const bool explained = add_settings_rows(cell.camera, tool, seen, trials, rows);

  CheckRow spots{"spots", true,
                 text("%d with a range; a pose needs %d", seen.ranged(), k_markers_needed), ""};
  if (!explained && seen.ranged() < k_markers_needed) {
    spots.passes = false;
    spots.next_step = "uncover the markers, or turn the tool to the camera";
  }
  rows.push_back(spots);
  if (explained || !spots.passes) return;

  CheckRow distances{
      "distances", false, mismatch_text(reason),
      "bring the tool into view; if it is, compare its file with it: glint calibrate "
      "tool"};
  for (const char* other : {"pen", "board"}) {
    const std::optional<Tool> built_in = built_in_tool(other);
    if (!built_in || tool.name == built_in->name) continue;
    if (!Trials(cell, tracker.input<Frame>(), *built_in).finds([](Cell&) {})) continue;
    distances.found += std::string("; they fit the tool \"") + other + "\"";
    distances.next_step = std::string("list the tool in view: tools = [\"") + other + "\"]";
  }
  for (int t = 0; t < cell.tools.count; ++t) {
    const Track& track = tracker.output<Estimates>().tracks[static_cast<std::size_t>(t)];
    if (track.measured_now) distances.found += "; \"" + name_of_tool(cell, t) + "\" has its own";
  }
  rows.push_back(distances);
}

std::string result_text(const Track& track) {
  if (!track.measured_now) return std::string(name_of(track.reason));
  std::string markers;
  for (int m = 0; m < k_markers_per_tool_max; ++m) {
    if ((track.marker_mask >> m & 1) != 0)
      markers += (markers.empty() ? "" : ", ") + std::to_string(m + 1);
  }
  return "by markers " + markers + text(", rms %.2f mm", track.rms_m * 1e3);
}

}  // namespace

const char* next_step_of_refused_frame(Reason reason) {
  return reason == Reason::frame_invalid
             ? "set [camera] to the size and bits of the frames; record their depth"
             : "set increasing stamps at the source";
}

const char* mismatch_text(Reason reason) {
  switch (reason) {
    case Reason::bad_fit:
      return "three spots or more have the tool's distances, but not within the noise";
    case Reason::imprecise:
      return "the spots fit, but the pose is too imprecise: few or nearly collinear spots";
    case Reason::ambiguous:
      return "the spots fit in two ways: a symmetric, flat or far tool";
    case Reason::markers_assigned_elsewhere:
      return "the spots that fit belong to another tool";
    case Reason::search_full:
      return "too many spots for [budget] search_steps";
    case Reason::blobs_full:
      return "too many spots for [budget] blobs: not all were compared";
    default:
      return "no three spots match the distances of the tool's markers";
  }
}

ToolDiagnosis diagnose_tool(const Cell& cell, Tracker& tracker, std::size_t tool) {
  const Track& track = tracker.output<Estimates>().tracks[tool];
  ToolDiagnosis diagnosis;
  diagnosis.tool = name_of_tool(cell, static_cast<int>(tool));
  diagnosis.found = track.measured_now;
  diagnosis.rows = {frame_row(tracker), head_row(tracker)};
  const bool usable = diagnosis.rows[0].passes;
  if (usable && !track.measured_now) {
    add_causes(cell, tracker, cell.tools.items[tool], track.reason, diagnosis.rows);
  }
  diagnosis.rows.push_back({"pose", track.measured_now, result_text(track),
                            track.measured_now ? "" : "see the first failed check above"});
  for (const CheckRow& row : diagnosis.rows) {
    if (!row.passes && diagnosis.cause.empty()) diagnosis.cause = row.check;
  }
  return diagnosis;
}

std::vector<ToolDiagnosis> diagnose(const Cell& cell, Tracker& tracker) {
  std::vector<ToolDiagnosis> all;
  for (int t = 0; t < cell.tools.count; ++t) {
    all.push_back(diagnose_tool(cell, tracker, static_cast<std::size_t>(t)));
  }
  return all;
}

std::vector<std::string> marker_names(const Cell& cell, Tracker& tracker,
                                      const std::string& separator) {
  const Markers& markers = tracker.token<Markers>();
  const Assignment& assigned = tracker.token<Assignment>();
  std::vector<std::string> names(
      static_cast<std::size_t>(std::max(0, tracker.token<Blobs>().count)));
  for (int t = 0; t < cell.tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (assigned.reason[i] != Reason::none) continue;
    if (!tracker.output<Estimates>().tracks[i].measured_now) continue;
    const FittedTool& fitted = tracker.parts<FittedTools>(t % k_tool_partitions).tools[i];
    const Labeling& labeling = labeling_of(assigned, fitted, i);
    for (std::size_t m = 0; m < k_markers_per_tool_max; ++m) {
      const int marker = labeling.marker[m];
      if (marker < 0 || marker >= markers.count ||
          static_cast<int>(m) >= cell.tools.items[i].marker_count) {
        continue;
      }
      const std::size_t blob = markers.items[static_cast<std::size_t>(marker)].blob;
      if (blob < names.size())
        names[blob] = name_of_tool(cell, t) + separator + std::to_string(m + 1);
    }
  }
  return names;
}

}  // namespace glint
