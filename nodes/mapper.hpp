// The background group: from depth pictures to a map, a slice of bounded work at each activation.
//
//   ShownDepth ─► ExtendMap ─► MapProgress
#pragma once

#include "graph/graph.hpp"
#include "nodes/extend_map.hpp"

namespace glint {

using Background = graph::Graph<graph::Inputs<ShownDepth>, graph::Outputs<MapProgress>, ExtendMap>;
static_assert(graph::valid<Background>);

}  // namespace glint
