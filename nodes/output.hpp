// Tick group: predicted tool poses and CAN frames from the newest estimates, at a fixed rate.
//
//   Now, Latest<Estimates>, Latest<RobotFrame>, Latest<PenButtons> ─► PredictTools ─► PoseSamples
//   ─► PackCan ─► CanFrames
#pragma once

#include "graph/graph.hpp"
#include "nodes/pack_can.hpp"
#include "nodes/predict_tools.hpp"

namespace glint {

using Output = graph::Graph<graph::Inputs<Now, graph::Latest<Estimates>, graph::Latest<RobotFrame>,
                                          graph::Latest<PenButtons>>,
                            graph::Outputs<PoseSamples, CanFrames>, PredictTools, PackCan>;
static_assert(graph::valid<Output>);

}  // namespace glint
