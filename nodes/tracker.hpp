// The frame group: tool poses from camera frames.
//
//   Frame ─► StampFrame ─► CheckFrame ─► PredictTracks ─► LocateRois ─► RoiThreshold x4 ─►
//   FindBlobs
//     ─► BackProject ─► Correspond x4 ─► AssignMarkers ─► RefinePose x4, NameFew ─►
//   AnchorHead ─► FollowMotion x4 ─► TrackTools ─► Estimates
//                           ▲ PredictTracks and TrackTools read Previous<Estimates>
//
// MarkerTracker is the same graph from BackProject's output on, for recordings without images.
#pragma once

#include "graph/graph.hpp"
#include "nodes/anchor_head.hpp"
#include "nodes/check_frame.hpp"
#include "nodes/follow_motion.hpp"
#include "nodes/image_nodes.hpp"
#include "nodes/locate_rois.hpp"
#include "nodes/name_few.hpp"
#include "nodes/pose_nodes.hpp"
#include "nodes/predict_tracks.hpp"
#include "nodes/refine_pose.hpp"
#include "nodes/track_tools.hpp"

namespace glint {

using Tracker = graph::Graph<graph::Inputs<Frame, HeadPose, graph::Latest<ToolSet>>,
                             graph::Outputs<Estimates>, StampFrame, CheckFrame, PredictTracks,
                             LocateRois, graph::Split<RoiThreshold, k_row_bands>, FindBlobs,
                             BackProject, graph::Split<Correspond, k_tool_partitions>,
                             AssignMarkers, NameFew, graph::Split<RefinePose, k_tool_partitions>,
                             AnchorHead, graph::Split<FollowMotion, k_tool_partitions>, TrackTools>;
static_assert(graph::valid<Tracker>);

using MarkerTracker =
    graph::Graph<graph::Inputs<FrameStamp, Markers, HeadPose, graph::Latest<ToolSet>>,
                 graph::Outputs<Estimates>, CheckFrame, PredictTracks,
                 graph::Split<Correspond, k_tool_partitions>, AssignMarkers, NameFew,
                 graph::Split<RefinePose, k_tool_partitions>, AnchorHead,
                 graph::Split<FollowMotion, k_tool_partitions>, TrackTools>;
static_assert(graph::valid<MarkerTracker>);

}  // namespace glint
