// Reader for the calibration problems of the computer-integrated surgery course. Text files: a line
// of counts and a name, then points in millimetres, separated by commas or blanks.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

struct CisFile {
  std::string path;
  std::vector<int> counts;                // of the first line
  std::vector<std::vector<double>> rows;  // three or more numbers each

  [[nodiscard]] Vector3 point_m(std::size_t row) const {
    return 1e-3 * Vector3(rows[row][0], rows[row][1], rows[row][2]);
  }
  // Throws InputError if the file has fewer points.
  [[nodiscard]] std::vector<Vector3> points_m(std::size_t first, std::size_t count) const;
};

// Throws InputError with path and line for text, or for a file without counts or points.
[[nodiscard]] CisFile load_cis(const std::string& path);

// Returns the sorted paths in `folder` whose names end in `ending`; empty if there are none.
[[nodiscard]] std::vector<std::string> cis_paths(const std::string& folder,
                                                 const std::string& ending);

}  // namespace glint
