// The table [depth_bias] of a cell, of a file of `glint calibrate depth`, or of a tool.
#pragma once

#include <string>

#include "kernels/pose/depth_bias.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// section: the keys' prefix in messages. Throws InputError: file:line: key, what was found, what
// was expected; also where the ranges that it was measured at are missing.
[[nodiscard]] DepthBias depth_bias_of(const toml::table& table, const std::string& file,
                                      const std::string& section);

// As such a table, without its header; "" for a bias that was not measured.
[[nodiscard]] std::string depth_bias_text(const DepthBias& bias);

}  // namespace glint
