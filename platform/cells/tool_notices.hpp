// What a user is told of tools that this sensor may confuse, in the words of a cell file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/cells/tool_distinction.hpp"

namespace glint {

// Within one sigma a frame cannot tell: no cell with such tools is taken.
inline constexpr double k_refused_sigmas = 1.0;

// The shortest way, in whole millimetres along an axis of its frame, to move one marker of the
// later tool so that this labeling lies beyond the limit; another one may then be the nearest.
struct MarkerMove {
  int tool = 0, marker = 0, axis = 0;
  int mm = 0;  // negative: against the axis
};
[[nodiscard]] std::optional<MarkerMove> move_apart(const ToolSet& tools, const Likeness& likeness,
                                                   const DistinctionSettings& settings);

// A line for each two tools that are confused, or each tool with its own exchange; none where all
// are at least limit_sigmas apart. `files` as the cell names them; `place` is the cell's file:line.
// Throws InputError where a wrong labeling lies within k_refused_sigmas.
[[nodiscard]] std::vector<std::string> tool_notices(const ToolSet& tools,
                                                    const std::vector<std::string>& files,
                                                    const std::string& place,
                                                    const DistinctionSettings& settings = {});

}  // namespace glint
