// Built-in configuration of the estimator in every experiment, and its hash.
#pragma once

#include <string>

#include "kernels/image/pixel_noise.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "kernels/pose/correspond_settings.hpp"
#include "kernels/pose/refine_pose.hpp"

namespace glint {

// Default-constructed, it is the configuration. A new part of the estimator adds its settings here
// and their fields to estimator_text().
struct EstimatorSettings {
  // Wider than where the residual alone decides: here the chi-square test decides.
  CorrespondSettings correspond{.gate_sigmas = 8};
  PixelNoise pixel_noise;
  ToolMotionSettings motion;
  RefineSettings refine;
};

// Every field by name, as JSON.
[[nodiscard]] std::string estimator_text();

// FNV-1a of that text, 16 hexadecimal digits: experiments with equal hashes ran the same estimator.
[[nodiscard]] std::string estimator_hash();

}  // namespace glint
