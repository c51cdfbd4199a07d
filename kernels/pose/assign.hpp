// Which tool gets which markers, when several tools claim the same ones.
//
// What:     in every round the best free labeling of all tools without one is taken: more markers
//           before fewer, then the smaller rms, then the lower tool index. A labeling is free while
//           none of its markers is taken.
// Cost:     tools^2 * k_labelings_max * k_markers_per_tool_max steps: 16 tools at most 16,384.
// Worst:    16 tools that all claim the same markers.
// Accuracy: exact; it is greedy, so the sum over all tools need not be the best possible.
#pragma once

#include <span>

#include "kernels/pose/labeling.hpp"

namespace glint {

// All three spans have one element a tool (k_tools_max at most; the shortest counts). chosen[t]
// becomes the index into per_tool[t].items or -1; reasons[t] none, the labelings' own reason where
// there are none, or taken_by_other.
void assign_markers(std::span<const Labelings> per_tool, std::span<int> chosen,
                    std::span<Reason> reasons) noexcept;

}  // namespace glint
