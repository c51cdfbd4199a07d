// Random tries of `glint reference` on a real scan: rates of accepted right and wrong poses.
//
// A try is a class, a number and the random seed, which select images, initial pose, joint
// positions and robot. Finished tries are stored in a CSV file and not run again. Right is within
// 25 mm and 5 deg of the pose that fits all images best, wrong beyond 50 mm or 10 deg.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/lab/experiments/case_list.hpp"
#include "platform/lab/experiments/robot_scenes.hpp"

namespace glint {

// Fault in the input of a try; `none`: no fault, and the robot is in the image.
enum class TryFault : std::uint8_t { none, joints, robot, cut_out };

struct TryClass {
  std::string name;
  bool several = false, mask = false;
  bool far = false;  // initial pose within 40 cm and 40 deg, else 10 cm and 10 deg
  TryFault fault = TryFault::none;
  double accepted_min = 0;  // percent; 0: no bar
};
[[nodiscard]] const std::vector<TryClass>& try_classes();

struct TryResult {
  std::uint64_t seed = 0;
  int number = 0;  // index over all tries; its class is number % classes
  std::string verdict;
  double translation_mm = 0, rotation_deg = 0;  // from the best pose
  double sigma_mm = 0;                          // stated, of the position
  double cpu_s = 0;
  std::string reason;  // reason for a verdict other than "accepted"

  [[nodiscard]] bool is_right() const { return translation_mm <= 25 && rotation_deg <= 5; }
  [[nodiscard]] bool is_wrong() const { return translation_mm > 50 || rotation_deg > 10; }
};

// One line per try: seed,number,verdict,shift_mm,turn_deg,sigma_mm,cpu_s,why. A truncated line is
// skipped, so that its try is run again.
[[nodiscard]] std::string try_line(const TryResult& result);
[[nodiscard]] std::vector<TryResult> read_tries(const std::string& path, std::uint64_t seed);

// Returns a case per class, with the bars.
[[nodiscard]] CaseList count_tries(const std::vector<TryResult>& tries);

// Runs those of options.tries that are not in options.out/reference_tries.csv. Throws InputError if
// the scan or the robots are not in options.data.
[[nodiscard]] CaseList run_reference_tries(const CaseOptions& options);

}  // namespace glint
