#include "platform/session/background_scene.hpp"

namespace glint {

BackgroundScene read_background_scene(const Cell& cell, DepthPngReader png) {
  BackgroundScene scene;
  if (!cell.mapping) return scene;
  const MappingSettings& mapping = *cell.mapping;
  scene.pictures = {read_depth_sequence(mapping.source, png), mapping.period};
  if (mapping.model.empty()) return scene;
  scene.model = read_robot_cloud(mapping.model);
  scene.poses = link_poses(scene.model, mapping.joints, cell.file + ": mapping.joints");
  return scene;
}

}  // namespace glint
