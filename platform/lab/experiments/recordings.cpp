#include "platform/lab/experiments/recordings.hpp"

namespace glint {
namespace {

constexpr Duration k_quick_length = milliseconds(10'000);

}  // namespace

std::vector<Trajectory> load_recordings(const CaseOptions& options) {
  std::vector<Trajectory> trajectories;
  for (const Recording& recording : k_recordings) {
    trajectories.push_back(load_trajectory(options.data + '/' + recording.file));
    if (options.quick)
      std::erase_if(trajectories.back().samples,
                    [](const TimedPose& sample) { return sample.time > Time{} + k_quick_length; });
  }
  return trajectories;
}

}  // namespace glint
