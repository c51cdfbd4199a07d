// The text files of the computer-integrated surgery course's calibration problems: a line of counts
// and a name, then points in millimetres, separated by commas or blanks.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

struct CisFile {
  std::string path;
  std::vector<int> counts;                // of the first line
  std::vector<std::vector<double>> rows;  // of three or more numbers

  [[nodiscard]] Vector3 point_m(std::size_t row) const {
    return 1e-3 * Vector3(rows[row][0], rows[row][1], rows[row][2]);
  }
  // Throws InputError where the file ends before.
  [[nodiscard]] std::vector<Vector3> points_m(std::size_t first, std::size_t count) const;
};

// Throws InputError with path and line for text, a file without counts or without points.
[[nodiscard]] CisFile load_cis(const std::string& path);

// Paths in `folder` whose name ends so, in order; empty where there are none.
[[nodiscard]] std::vector<std::string> cis_paths(const std::string& folder,
                                                 const std::string& ending);

}  // namespace glint
