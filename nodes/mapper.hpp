// The background group: from depth pictures to a map and to where the robot stands, a slice of
// bounded work of each at each activation.
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
