#include "platform/runtime/session/background_json.hpp"

#include <nlohmann/json.hpp>

namespace glint {

nlohmann::ordered_json as_json(const BackgroundCounts& counts) {
  return {{"slices", counts.slices},
          {"late", counts.late},
          {"skipped", counts.skipped},
          {"response_us", {{"max", counts.longest_response.seconds() * 1e6}}},
          {"longest_steps", counts.longest_steps},
          {"pictures", counts.map.pictures},
          {"pictures_missed", counts.images_missed},
          {"points", counts.map.measured},
          {"points_left_out", counts.map.left_out},
          {"points_dropped", counts.map.dropped},
          {"maps", counts.map.maps},
          {"voxels", counts.map.voxels},
          {"map_points", counts.map.smoothed},
          {"planes", counts.map.planes},
          {"references",
           {{"followed", counts.robot.followed},
            {"jumps_refused", counts.robot.jumps},
            {"unsure", counts.robot.inconclusive},
            {"last", name_of(counts.robot.last)},
            {"joint_states_used", counts.joints_used},
            {"joint_states_passed_over", counts.joints_skipped},
            {"pictures_without_joints", counts.images_without_joints}}}};
}

}  // namespace glint
