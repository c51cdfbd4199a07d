#include "platform/sim/room.hpp"

#include <string>

#include "platform/input_error.hpp"

namespace glint::sim {

Room furnished_room() {
  Room room;
  room.furniture.push_back({{0.15, -0.7, -1.3}, {1.1, 0.9, -0.52}, 0.45});    // table
  room.furniture.push_back({{0.75, 0.25, -0.52}, {1.0, 0.8, -0.1}, 0.7});     // cabinet on it
  room.furniture.push_back({{0.8, -0.6, -0.52}, {0.86, -0.05, -0.15}, 0.3});  // screen
  return room;
}

BackgroundFrame background_from_frame(const FrameBuffer& frame, const Camera& camera) {
  const std::string want =
      std::to_string(camera.model.width) + "x" + std::to_string(camera.model.height);
  if (frame.width != camera.model.width || frame.height != camera.model.height) {
    throw InputError("background frame:size: " + std::to_string(frame.width) + "x" +
                     std::to_string(frame.height) + "; expected " + want + " of " + camera.name);
  }
  if (frame.depth.empty()) throw InputError("background frame:depth: none; expected " + want);
  BackgroundFrame background;
  background.reflectivity.resize(frame.depth.size());
  background.range_m.resize(frame.depth.size());
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    background.reflectivity[i] = frame.reflectivity_16.empty()
                                     ? static_cast<float>(frame.reflectivity_8[i])
                                     : static_cast<float>(frame.reflectivity_16[i]);
    const bool valid = frame.depth[i] < camera.depth.invalid_from;
    background.range_m[i] = valid ? static_cast<float>(frame.depth[i] * camera.depth.unit_m) : 0.0f;
  }
  return background;
}

}  // namespace glint::sim
