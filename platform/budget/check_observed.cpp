// Compares a run's observations with the bounds of a check.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "platform/budget/check.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

double in_us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

void compare(const nlohmann::json& summary, const std::string& summary_file, CheckResult& result) {
  if (summary.is_discarded() || !summary.contains("frame_to_can_us") ||
      !summary["frame_to_can_us"].contains("max")) {
    throw InputError(summary_file +
                     ":1: no frame_to_can_us.max; expected a summary.json of `glint run`");
  }
  if (summary.value("frame_to_can_kind", "observed") != "observed") {
    throw InputError(summary_file +
                     ":1: frame_to_can_us was computed, not measured; expected the summary of a "
                     "run in real time, without --fast");
  }
  const auto judge = [&](const char* what, const nlohmann::json& seen, double bound_us) {
    const double seen_us = seen.value("max", 0.0);
    if (seen_us <= bound_us) return;
    char text[120];
    std::snprintf(text, sizeof text, "%s: observed %.1f us, bound %.1f us", what, seen_us,
                  bound_us);
    result.fails.emplace_back(text);
  };
  const nlohmann::json& seen = summary["frame_to_can_us"];
  for (const Chain& chain : result.assessment.chains) {
    if (chain.name == "frame_to_can") judge("frame to CAN", seen, in_us(chain.total_ns));
  }
  const GroupResponse& frame = result.assessment.groups[k_frame_group_index];
  if (frame.response_ns && seen.contains("computing")) {
    judge("frame group", seen["computing"], in_us(*frame.response_ns - frame.jitter_ns));
  }
  if (summary.contains("background") &&
      result.assessment.groups.size() > k_background_group_index) {
    const auto& bound = result.assessment.groups[k_background_group_index].response_ns;
    const auto& slices = summary["background"];
    if (bound && slices.contains("response_us")) {
      judge("background group", slices["response_us"], in_us(*bound));
    }
  }
}

}  // namespace

void compare_observed(const std::string& summary_file, CheckResult& result) {
  const std::string text =
      read_file(summary_file, k_text_bytes_max, "a summary.json of `glint run`");
  try {
    compare(nlohmann::json::parse(text, nullptr, false), summary_file, result);
  } catch (const nlohmann::json::exception& error) {  // a value of another type
    throw InputError(summary_file + ":1: " + error.what() +
                     "; expected a summary.json of `glint run`");
  }
}

}  // namespace glint
