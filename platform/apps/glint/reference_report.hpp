// Report of `glint reference`: lines for a terminal, and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "platform/tools/reference/find_reference.hpp"

namespace glint {

struct ReferenceContext {
  std::string robot;
  int triangles_skipped = 0;
  std::size_t frames = 0;
  SearchRange range;
};

void print_reference(const Reference& reference, const ReferenceContext& facts);

[[nodiscard]] nlohmann::ordered_json reference_json(const Reference& reference,
                                                    const ReferenceContext& facts);

}  // namespace glint
