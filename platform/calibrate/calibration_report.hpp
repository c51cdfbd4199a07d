// What a calibration says at its end: a table, the same figures as TOML, and a plot of residuals.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

using Figures = nlohmann::ordered_json;

// One line each; what is inside of an object stands below its name.
[[nodiscard]] std::string figures_table(const Figures& figures);

// The same as a TOML file: objects become tables. Every line of `comment` stands behind a # above.
[[nodiscard]] std::string figures_toml(const Figures& figures, std::string_view comment);

[[nodiscard]] Figures figures_of(const Vector3& vector, double scale);
[[nodiscard]] Figures figures_of(const Matrix3& matrix, double scale);

// Values over their number; those not kept as spikes of their own colour, which the axis need not
// hold whole.
struct ResidualPlot {
  std::string title, y_label;
  std::span<const double> values;
  const std::vector<bool>* kept = nullptr;  // null: all
};
[[nodiscard]] std::string residual_plot(const ResidualPlot& plot);

}  // namespace glint
