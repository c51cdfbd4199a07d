#include "platform/lab/experiments/cis_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

std::vector<double> numbers_of(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value)) break;  // the file's name ends the first line
    numbers.push_back(value);
  }
  return numbers;
}

}  // namespace

std::vector<Vector3> CisFile::points_m(std::size_t first, std::size_t count) const {
  if (first + count > rows.size()) {
    throw InputError(path + ": " + std::to_string(rows.size()) + " points; expected " +
                     std::to_string(first + count) + " by its first line");
  }
  std::vector<Vector3> points;
  for (std::size_t i = first; i < first + count; ++i) points.push_back(point_m(i));
  return points;
}

CisFile load_cis(const std::string& path) {
  std::istringstream in(read_file(path, k_text_bytes_max, "points of a calibration problem"));
  CisFile file;
  file.path = path;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::vector<double> numbers = numbers_of(line);
    if (number == 1) {
      for (const double value : numbers) {
        if (!(value >= 0 && value <= 1e6)) break;
        file.counts.push_back(static_cast<int>(value));
      }
      continue;
    }
    if (numbers.size() < 3) {
      throw InputError(path + ":" + std::to_string(number) + ": \"" + line.substr(0, 40) +
                       "\"; expected three numbers or more");
    }
    file.rows.push_back(numbers);
  }
  if (file.counts.empty() || file.rows.empty()) {
    throw InputError(path + ":1: no counts or no points; expected counts, then points");
  }
  return file;
}

std::vector<std::string> cis_paths(const std::string& folder, const std::string& ending) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > ending.size() && name.ends_with(ending))
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace glint
