// Report of a calibration: a table, the same figures as TOML, and a residual plot.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

using Figures = nlohmann::ordered_json;

// One line per figure; the members of an object follow below its name.
[[nodiscard]] std::string figures_table(const Figures& figures);

// The same as a TOML file: objects become tables. Each line of `comment` comes first, after a #.
[[nodiscard]] std::string figures_toml(const Figures& figures, std::string_view comment);

[[nodiscard]] Figures figures_of(const Vector3& vector, double scale);
[[nodiscard]] Figures figures_of(const Matrix3& matrix, double scale);

// Values over their index; those not kept are spikes of another colour, clipped at the axis limit.
struct ResidualPlot {
  std::string title, y_label;
  std::span<const double> values;
  const std::vector<bool>* kept = nullptr;  // null: all
};
[[nodiscard]] std::string residual_plot(const ResidualPlot& plot);

}  // namespace glint
