#include "platform/tools/calibrate/calibration_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

constexpr int k_table_digits = 5;
constexpr int k_file_digits = 12;
constexpr double k_spike_limit = 1.3;  // of the largest kept value

std::string number(const Figures& value, int digits) {
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value.get<double>());
  std::string result = text;
  // TOML distinguishes a float from an integer by its point or exponent.
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result;
}

std::string value_text(const Figures& value, int digits) {
  if (value.is_number()) return number(value, digits);
  if (!value.is_array()) return value.dump();
  std::string text = "[";
  for (std::size_t i = 0; i < value.size(); ++i) {
    text += (i == 0 ? "" : ", ") + value_text(value[i], digits);
  }
  return text + "]";
}

}  // namespace

std::string figures_table(const Figures& figures) {
  std::string text;
  for (const auto& [key, value] : figures.items()) {
    if (value.is_object()) {
      text += key + "\n" + figures_table(value);
      continue;
    }
    char name[40];
    std::snprintf(name, sizeof name, "  %-26s ", key.c_str());
    text += name +
            (value.is_string() ? value.get<std::string>() : value_text(value, k_table_digits)) +
            "\n";
  }
  return text;
}

std::string figures_toml(const Figures& figures, std::string_view comment) {
  std::string text, tables;
  std::istringstream lines{std::string(comment)};
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  for (const auto& [key, value] : figures.items()) {
    if (value.is_null()) continue;
    if (value.is_object()) {
      tables += "\n[" + key + "]\n" + figures_toml(value, "");
    } else {
      text += key + " = " + value_text(value, k_file_digits) + "\n";
    }
  }
  return text + tables;
}

Figures figures_of(const Vector3& vector, double scale) {
  return {scale * vector.x(), scale * vector.y(), scale * vector.z()};
}

Figures figures_of(const Matrix3& matrix, double scale) {
  Figures rows = Figures::array();
  for (int i = 0; i < 3; ++i) rows.push_back(figures_of(Vector3(matrix.row(i)), scale));
  return rows;
}

std::string residual_plot(const ResidualPlot& plot) {
  double most = 0;
  for (std::size_t i = 0; i < plot.values.size(); ++i) {
    if (plot.kept == nullptr || (*plot.kept)[i]) most = std::max(most, plot.values[i]);
  }
  LineSeries used{"kept", {}}, dropped{"left out", {}};
  const double gap = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < plot.values.size(); ++i) {
    const auto x = static_cast<double>(i);
    if (plot.kept == nullptr || (*plot.kept)[i]) {
      used.points.emplace_back(x, plot.values[i]);
      continue;
    }
    dropped.points.emplace_back(x, 0);
    dropped.points.emplace_back(x, std::min(plot.values[i], k_spike_limit * most));
    dropped.points.emplace_back(gap, gap);
  }
  std::vector<LineSeries> series{used};
  if (!dropped.points.empty()) series.push_back(dropped);
  return line_plot({plot.title, "number", plot.y_label}, series);
}

}  // namespace glint
