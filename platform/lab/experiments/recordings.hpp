// Recorded motions (public benchmarks) and a real frame that experiments read, by file name.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "platform/formats/trajectory.hpp"
#include "platform/lab/experiments/case_list.hpp"
#include "platform/sim/room.hpp"

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

// A HoloLens 2's frame of two hands, a chromed drill and a table, 512 x 512, no tool in it:
// hl2_real/ahat_ab_hands_drill.png. It was published without depth: 0.6 m in each pixel. Throws
// InputError.
[[nodiscard]] sim::BackgroundFrame load_hands_and_drill(const std::string& data);

}  // namespace glint
