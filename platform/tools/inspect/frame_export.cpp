#include "platform/tools/inspect/frame_export.hpp"

#include <cstdint>
#include <map>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sinks/record/trajectory_files.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

bool same_position(const HeadPose& one, const HeadPose& other) {
  constexpr double k_rounding_m = 1e-9;
  return one.valid == other.valid &&
         (one.T_world_camera.translation - other.T_world_camera.translation).norm() < k_rounding_m;
}

ExportedRows with_source(ExportedRows rows, TrackedFrames tracked) {
  rows.frames = tracked.frames;
  rows.failures = std::move(tracked.failures);
  return rows;
}

}  // namespace

ExportedRows export_points(RecordedFrames& recorded, std::size_t tool, const LineOut& out) {
  ExportedRows rows;
  const Tool& kind = recorded.cell.tools.items[tool];
  out(k_points_heading);
  TrackedFrames tracked = track_frames(
      recorded, Search::everywhere, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        for (const Vector3& centre : marker_centres(tracker.token<Markers>(), kind)) {
          out(points_line(arrived.frame.mid_exposure, centre));
          ++rows.rows;
        }
      });
  if (rows.rows == 0) {
    throw InputError(
        recorded.path + ": no marker with a range in " + std::to_string(tracked.frames) +
        " frames; expected bright spots of a marker's size: see `glint inspect --recording`");
  }
  return with_source(std::move(rows), std::move(tracked));
}

ExportedRows export_tum(RecordedFrames& recorded, const PoseExport& wanted, const LineOut& out) {
  ExportedRows rows;
  const Tool& tool = recorded.cell.tools.items[wanted.tool];
  const bool world = wanted.frame == ReferenceFrame::world;
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        const Track& track = tracker.output<Estimates>().tracks[wanted.tool];
        if (!track.measured_now) return;
        if (world && track.base != ReferenceFrame::world) {
          ++rows.without_head_pose;
          return;
        }
        const Pose& pose = world ? track.newest.pose : track.T_camera_tool;
        out(tum_line(arrived.frame.mid_exposure, with_origin(pose, tool, wanted.origin)));
        ++rows.rows;
      });
  if (rows.rows == 0 && rows.without_head_pose > 0) {
    throw InputError(recorded.path + ": no head pose in " + std::to_string(rows.without_head_pose) +
                     " tracked frames; expected head poses, or --frame camera");
  }
  if (rows.rows == 0) {
    throw InputError(recorded.path + ": the tool \"" + tool.name.data() +
                     "\" was tracked in none of " + std::to_string(tracked.frames) +
                     " frames; expected it in view: see `glint inspect --recording`");
  }
  return with_source(std::move(rows), std::move(tracked));
}

ExportedRows export_csv(RecordedFrames& recorded, const std::vector<std::size_t>& tools,
                        PoseOrigin origin, const LineOut& out) {
  ExportedRows rows;
  out(frame_pose_heading());
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        for (const std::size_t t : tools) {
          const Tool& tool = recorded.cell.tools.items[t];
          out(frame_pose_line(frame_pose(arrived.frame, tracker, tool, t, origin)));
          ++rows.rows;
        }
      });
  return with_source(std::move(rows), std::move(tracked));
}

ExportedRows export_ground_truth(RecordedFrames& recorded, const PoseExport& wanted,
                                 const LineOut& out) {
  // The duration limits the simulator's frames, not its motion.
  Cell cell = recorded.cell;
  constexpr double k_longest_s = 3600;
  cell.simulator.duration_s = k_longest_s;
  const sim::Simulator simulator(scenario_of(cell));
  std::map<std::uint64_t, int> deliveries;  // index by frame number
  for (int i = 0; i < simulator.frame_count(); ++i) {
    deliveries.emplace(simulator.timing(i).sequence, i);
  }
  ExportedRows rows;
  const Tool& tool = cell.tools.items[wanted.tool];
  int matching = 0;
  sim::SimFrame made;
  FrameSource& source = *recorded.source;
  source.start({});
  ArrivedFrame arrived;
  while (source.wait(arrived)) {
    ++rows.frames;
    const Time time = arrived.frame.mid_exposure;
    const auto delivery = deliveries.find(arrived.frame.sequence);
    source.release_pixels(arrived);
    if (delivery == deliveries.end()) continue;
    simulator.describe(delivery->second, made);
    if (made.mid_exposure != time) continue;
    // A delayed live run has other arrival times.
    matching +=
        made.arrival == arrived.frame.arrival && same_position(made.head, arrived.head) ? 1 : 0;
    Pose pose = simulator.truth_tool(static_cast<int>(wanted.tool), time);
    if (wanted.frame == ReferenceFrame::camera) {
      pose = simulator.truth_camera(time).inverse() * pose;
    }
    out(tum_line(time, with_origin(pose, tool, wanted.origin)));
    ++rows.rows;
  }
  if (2 * matching < rows.frames) {
    throw InputError(recorded.path + ": no ground truth: " + std::to_string(matching) + " of " +
                     std::to_string(rows.frames) +
                     " frames match its cell's simulator; expected a recording of `glint "
                     "simulate`, or of `glint run` with simulated frames");
  }
  rows.failures = source.report().failures;
  return rows;
}

}  // namespace glint
