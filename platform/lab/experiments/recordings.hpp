// Recorded motions that experiments predict: public benchmarks, by file name.
#pragma once

#include <array>
#include <vector>

#include "platform/formats/trajectory.hpp"
#include "platform/lab/experiments/case_list.hpp"

namespace glint {

struct Recording {
  const char* name;
  const char* file;
};
inline constexpr std::array<Recording, 4> k_recordings = {
    {{"fr1_xyz", "tum_fr1_xyz_groundtruth.txt"},
     {"EuRoC V1_03", "euroc_V1_03_difficult.csv"},
     {"rpng table_01", "rpng_table_01.csv"},
     {"TUM-VI room1", "tumvi_room1.csv"}}};

// From options.data, in that order; --quick: their first ten seconds. Throws InputError with the
// first file that is missing or bad.
[[nodiscard]] std::vector<Trajectory> load_recordings(const CaseOptions& options);

}  // namespace glint
