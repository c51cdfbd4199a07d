// Configures the graphs from a cell: the only place that converts user settings to node settings.
#pragma once

#include "graph/graph.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// Settings of one node from a validated cell, beside its limits. A node that takes none has no
// overload.
void set_up(const Cell& cell, StampFrame& node);
void set_up(const Cell& cell, PredictTracks& node);
void set_up(const Cell& cell, LocateRois& node);
void set_up(const Cell& cell, RoiThreshold& node);
void set_up(const Cell& cell, FindBlobs& node);
void set_up(const Cell& cell, BackProject& node);
void set_up(const Cell& cell, Correspond& node);
void set_up(const Cell& cell, NameFew& node);
void set_up(const Cell& cell, RefinePose& node);
void set_up(const Cell& cell, AnchorHead& node);
void set_up(const Cell& cell, FollowMotion& node);
void set_up(const Cell& cell, TrackTools& node);
void set_up(const Cell& cell, PredictTools& node);
void set_up(const Cell& cell, PackCan& node);

// Throws std::logic_error, with the node's name and reason, if its prepare() failed.
void require_prepared(const graph::Prepared& prepared);

// Any graph of these nodes and of others, for example the tracker with one node more. A node with a
// member `limits` gets the cell's; other settings of another project's node stay as they are.
// Throws as require_prepared().
template <class G>
void configure(const Cell& cell, G& target) {
  [&]<class... Listed>(graph::TypeList<Listed...> /*units*/) {
    const auto set = [&](auto& node) {
      if constexpr (requires { node.limits = limits_of(cell); }) node.limits = limits_of(cell);
      if constexpr (requires { set_up(cell, node); }) set_up(cell, node);
    };
    (target.template for_each<typename graph::Unit<Listed>::Node>(set), ...);
  }(typename G::Wires::Listed{});
  require_prepared(target.prepare());
}

// The graphs of a run.
void configure(const Cell& cell, Tracker& tracker);
void configure(const Cell& cell, MarkerTracker& tracker);
void configure(const Cell& cell, Output& output);

// The cell's declared marker noise and its lens.
[[nodiscard]] MarkerNoise declared_noise(const Camera& camera) noexcept;
// The cell's declared pose of the robot.
[[nodiscard]] RobotFrame declared_robot_frame(const Cell& cell);

}  // namespace glint
