// Reader and writer of [depth_bias] in a cell, a file of `glint calibrate depth`, or a tool.
#pragma once

#include <string>

#include "kernels/pose/depth_bias.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// section: prefix of the keys in messages. Throws InputError: file:line: key, found, expected; also
// if the ranges of the measurement are missing.
[[nodiscard]] DepthBias depth_bias_of(const toml::table& table, const std::string& file,
                                      const std::string& section);

// Returns the table without its header; "" for a bias that is not measured.
[[nodiscard]] std::string depth_bias_text(const DepthBias& bias);

}  // namespace glint
