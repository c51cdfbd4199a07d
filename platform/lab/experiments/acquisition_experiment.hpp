// How soon a tool is found, and how steadily it is tracked, among more bright spots than the cell
// has blobs for.
//
// A cell as built in, 64 blobs, tools in moving hands, nothing tracked before the first frame; each
// case with other random seeds. Spots are the simulator's stray balls, or painted into the frames
// (painted_spots.hpp); with data, a real frame of hands and a drill stands behind the tool, which
// is to be found and nothing else. A tool's frame counts with three or more of its markers visible
// by the simulator's rule; fresh: this frame gave an accepted pose; gross: the tip is more than 20
// mm or the orientation more than 15 degrees off. `found_after` is the longest of all tools and
// random seeds from the first frame with four visible markers to the first fresh one; `fresh` is
// the least share from there on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/reason.hpp"
#include "platform/lab/experiments/case_list.hpp"
#include "platform/lab/experiments/painted_spots.hpp"
#include "platform/sim/room.hpp"

namespace glint {

struct AcquisitionCase {
  std::string name;
  int tools = 1;   // of five_tools(), the first ones
  int strays = 0;  // of the simulator
  SpotSettings spots;
  bool judged = true;  // false: shows where the method ends
  int threshold = 0;   // 0: the cell's
  sim::BackgroundFrame background = {};
};

[[nodiscard]] std::vector<AcquisitionCase> acquisition_cases();
// Before a real frame, at thresholds that its hands and drill exceed. Throws InputError.
[[nodiscard]] std::vector<AcquisitionCase> real_frame_cases(const std::string& data);

// Of one tool in one run.
struct Acquisition {
  bool visible = false, found = false;
  double found_s = 0;                                // after it was visible first
  std::int64_t trackable = 0, fresh = 0, gross = 0;  // from the first fresh frame on
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed{};  // by reason
};

[[nodiscard]] std::vector<Acquisition> acquire(const AcquisitionCase& one, int frames,
                                               std::uint64_t seed);

[[nodiscard]] CaseList run_acquisition(const CaseOptions& options);

}  // namespace glint
