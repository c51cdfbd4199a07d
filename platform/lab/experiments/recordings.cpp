#include "platform/lab/experiments/recordings.hpp"

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr Duration k_quick_length = milliseconds(10'000);
constexpr int k_frame_side = 512;
constexpr float k_frame_range_m = 0.6f;

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

sim::BackgroundFrame load_hands_and_drill(const std::string& data) {
  const std::string path = data + "/hl2_real/ahat_ab_hands_drill.png";
  const Image picture = read_png(path, "a HoloLens 2's frame of hands and a drill");
  if (picture.width != k_frame_side || picture.height != k_frame_side || picture.channels != 1) {
    throw InputError(path + ": " + std::to_string(picture.width) + " x " +
                     std::to_string(picture.height) + " pixels of " +
                     std::to_string(picture.channels) + "; expected 512 x 512 of one grey value");
  }
  sim::BackgroundFrame frame;
  frame.reflectivity.assign(picture.values.begin(), picture.values.end());
  frame.range_m.assign(picture.values.size(), k_frame_range_m);
  return frame;
}

}  // namespace glint
