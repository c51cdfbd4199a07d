#include "platform/cells/depth_bias_table.hpp"

#include <cstdio>

#include "platform/input_error.hpp"

namespace glint {

DepthBias depth_bias_of(const toml::table& table, const std::string& file,
                        const std::string& section) {
  TomlReader reader(table, file, section);
  DepthBias bias;
  bias.offset_m = 1e-3 * reader.real("offset_mm", 0, -100, 100);
  bias.per_metre = 1e-3 * reader.real("mm_per_m", 0, -200, 200);
  bias.low_signal_m = 1e-3 * reader.real("dim_mm", 0, -100, 100);
  const auto range_mm = reader.reals("range_mm", 2);
  reader.done();
  // A bias is valid only in the ranges of its measurement, so they are required.
  if (!range_mm || !((*range_mm)[0] >= 0 && (*range_mm)[1] > (*range_mm)[0])) {
    const auto line = range_mm ? reader.line_of("range_mm") : table.source().begin.line;
    throw InputError(file + ":" + std::to_string(line) + ": " + section + "range_mm is " +
                     (range_mm ? "not a range" : "missing") +
                     "; expected [from, to], the measured ranges");
  }
  bias.range_min_m = 1e-3 * (*range_mm)[0];
  bias.range_max_m = 1e-3 * (*range_mm)[1];
  return bias;
}

std::string depth_bias_text(const DepthBias& bias) {
  if (!bias.is_measured()) return "";
  char text[200];
  std::snprintf(text, sizeof text,
                "offset_mm = %.4f\nmm_per_m = %.4f\ndim_mm = %.4f\nrange_mm = [%.1f, %.1f]\n",
                1e3 * bias.offset_m, 1e3 * bias.per_metre, 1e3 * bias.low_signal_m,
                1e3 * bias.range_min_m, 1e3 * bias.range_max_m);
  return text;
}

}  // namespace glint
