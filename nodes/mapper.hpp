// Background group: map and robot pose from depth images, one slice of bounded work of each per
// activation.
//
//   ShownDepth ─► ExtendMap ─► MapProgress
//              ─► FollowRobot ─► RobotProgress
#pragma once

#include "graph/graph.hpp"
#include "nodes/extend_map.hpp"
#include "nodes/follow_robot.hpp"

namespace glint {

using Background = graph::Graph<graph::Inputs<ShownDepth>,
                                graph::Outputs<MapProgress, RobotProgress>, ExtendMap, FollowRobot>;
static_assert(graph::valid<Background>);

}  // namespace glint
