// Warnings about tools of a cell that the sensor may confuse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/cells/tool_distinction.hpp"

namespace glint {

// Within one sigma a frame cannot distinguish the labelings: such a cell is refused.
inline constexpr double k_refused_sigmas = 1.0;

// Shortest displacement of one marker of the later tool that moves this labeling beyond the limit.
// In whole millimetres along an axis of its frame. Another labeling may then be the nearest.
struct MarkerMove {
  int tool = 0, marker = 0, axis = 0;
  int mm = 0;  // negative: against the axis
};
[[nodiscard]] std::optional<MarkerMove> separating_move(const ToolSet& tools,
                                                        const WrongLabeling& labeling,
                                                        const DistinctionSettings& settings);

// Returns one line per pair of confusable tools, or per tool with its own exchange; none if all are
// at least limit_sigmas apart. files: as the cell names them. place: file:line of the cell. Throws
// InputError if a wrong labeling is within k_refused_sigmas.
[[nodiscard]] std::vector<std::string> tool_warnings(const ToolSet& tools,
                                                     const std::vector<std::string>& files,
                                                     const std::string& place,
                                                     const DistinctionSettings& settings = {});

}  // namespace glint
