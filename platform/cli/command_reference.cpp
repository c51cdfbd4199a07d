// glint reference: where a robot stands, from depth pictures of it and a rough pose.
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "kernels/angles.hpp"
#include "platform/calibrate/say.hpp"
#include "platform/cli/commands.hpp"
#include "platform/cli/output_file.hpp"
#include "platform/input_error.hpp"
#include "platform/reference/find_reference.hpp"
#include "platform/robot/sample_robot.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

struct ReferenceArguments {
  RobotFiles robot;
  SceneFiles scene;
  std::vector<double> seed;
  std::string json, model;
  int points = k_robot_cloud_points;
  bool visual = false;
};

Json matrix_json(const Pose& T) {
  const Matrix3 rotation = T.rotation.toRotationMatrix();
  Json json = Json::array();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) json.push_back(rotation(r, c));
    json.push_back(T.translation(r));
  }
  for (const double last : {0.0, 0.0, 0.0, 1.0}) json.push_back(last);
  return json;
}

Json candidate_json(const Candidate& c) {
  return {{"T_camera_base", matrix_json(c.alignment.T_world_base)},
          {"median_surface_mm", 1e3 * c.judgement.median_m},
          {"inlier_share", c.judgement.inlier_share()},
          {"seen_through_share", c.judgement.seen_through_share()},
          {"visible_share", c.judgement.visible_share()},
          {"outline_share", c.judgement.outline_share()}};
}

Json reference_json(const Reference& reference, const RobotModel& robot, std::size_t frames) {
  const ModelAlignment& alignment = reference.found.alignment;
  Json json = candidate_json(reference.found);
  json["verdict"] = name_of(reference.verdict);
  json["why"] = reference.why;
  json["residual_mm"] = 1e3 * alignment.residual_m;
  Json covariance = Json::array();
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) covariance.push_back(alignment.covariance(r, c));
  }
  json["covariance"] = covariance;  // shift in metres, turn in radians, the camera's axes
  json["pairs"] = alignment.pairs;
  json["frames"] = frames;
  json["starts"] = reference.starts;
  json["robot"] = robot.name;
  json["triangles_skipped"] = robot.triangles_skipped;
  json["rivals"] = Json::array();
  for (const Candidate& rival : reference.rivals) json["rivals"].push_back(candidate_json(rival));
  return json;
}

void print_pose(const char* what, const Candidate& c) {
  const Vector3& t = c.alignment.T_world_base.translation;
  const Quaternion& q = c.alignment.T_world_base.rotation;
  std::printf("%-9s  [%.4f, %.4f, %.4f] m, quaternion x y z w [%.5f, %.5f, %.5f, %.5f]\n", what,
              t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  std::printf("           median distance %.2f mm, within 20 mm %.1f %%, seen through %.1f %%\n",
              1e3 * c.judgement.median_m, 100 * c.judgement.inlier_share(),
              100 * c.judgement.seen_through_share());
}

void check_given(const ReferenceArguments& arguments) {
  const std::pair<const char*, bool> wanted[] = {{"--depth", arguments.scene.depth.empty()},
                                                 {"--joints", arguments.scene.joints.empty()},
                                                 {"--camera", arguments.scene.camera.empty()},
                                                 {"--seed", arguments.seed.empty()}};
  for (const auto& [option, missing] : wanted) {
    if (missing) {
      throw InputError(std::string(option) +
                       " is missing; expected --depth, --joints, --camera and --seed, or "
                       "--export-model alone");
    }
  }
  for (const double value : arguments.seed) {
    if (!std::isfinite(value) || std::abs(value) > 1e3) {
      throw InputError("--seed: expected x,y,z,roll,pitch,yaw in metres and radians");
    }
  }
}

void export_model(const ReferenceArguments& arguments, const RobotModel& robot) {
  const RobotCloud cloud = sample_robot(robot, arguments.points);
  write_robot_cloud(arguments.model, cloud);
  std::printf("model      %s: %zu points of %zu links, %.1f mm apart\n", arguments.model.c_str(),
              cloud.points.size(), cloud.links.size(), 1e3 * static_cast<double>(cloud.spacing_m));
}

int run_reference(ReferenceArguments arguments) {
  const SceneFiles& scene = arguments.scene;
  const bool only_export = !arguments.model.empty() && scene.depth.empty() &&
                           scene.joints.empty() && scene.camera.empty() && arguments.seed.empty();
  if (!only_export) check_given(arguments);
  if (arguments.visual) arguments.robot.geometry = Geometry::visual;
  const RobotModel robot = load_robot(arguments.robot);
  if (only_export) {
    export_model(arguments, robot);
    return 0;
  }
  const std::vector<SceneFrame> frames = read_scene(arguments.scene, robot);
  const Reference reference = find_reference(frames, pose_of_seed(arguments.seed), {});
  print_pose("base", reference.found);
  const Matrix6& covariance = reference.found.alignment.covariance;
  std::printf("sigma      %.2f mm, %.3f deg an axis, if depth errs by noise alone\n",
              1e3 * std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3),
              k_degrees_per_radian * std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3));
  for (const Candidate& rival : reference.rivals) print_pose("rival", rival);
  if (robot.triangles_skipped > 0) {
    std::printf("meshes     %d triangles without an area skipped\n", robot.triangles_skipped);
  }
  std::printf("verdict    %s%s%s\n", name_of(reference.verdict).c_str(),
              reference.why.empty() ? "" : ": ", reference.why.c_str());
  if (!arguments.model.empty()) export_model(arguments, robot);
  write_json(arguments.json, reference_json(reference, robot, frames.size()));
  return reference.verdict == ReferenceVerdict::accepted ? 0 : 1;
}

}  // namespace

void add_reference(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("reference", "Where a robot stands, from depth pictures of it");
  auto arguments = std::make_shared<ReferenceArguments>();
  command->footer(
      "Example:\n"
      "  glint reference --urdf arm.urdf --package-dir meshes --export-model arm.ply\n"
      "  glint reference --urdf arm.urdf --package-dir meshes --camera camera_info.yaml\n"
      "    --depth a.npy b.npy --joints a.txt b.txt --seed 0.4,0.2,1.2,-1.6,0.1,0.8 --json r.json\n"
      "Exit: 0 accepted, 1 ambiguous or refused, 2 bad use or input.");
  command->add_option("--urdf", arguments->robot.urdf, "the robot's description")->required();
  command->add_option("--package-dir", arguments->robot.package_dirs,
                      "where package:// leads: folders, or NAME=FOLDER");
  command->add_option("--joints", arguments->scene.joints,
                      "joint positions, a file for each depth picture: .npy, or text");
  command->add_option(
      "--depth", arguments->scene.depth,
      "depth: pictures .npy (m), .png (16 bit, mm); clouds .pcd, .ply in the camera's frame");
  command->add_option("--camera", arguments->scene.camera, "ROS camera_info, YAML");
  command->add_option("--mask", arguments->scene.masks,
                      "the robot's pixels, a file for each depth");
  command
      ->add_option("--seed", arguments->seed,
                   "x,y,z,roll,pitch,yaw of T_camera_base: metres, radians, fixed axes")
      ->delimiter(',')
      ->expected(6);
  command->add_option("--export-model", arguments->model,
                      "write joints and points of the links' surfaces here, as PLY: what a board "
                      "reads in place of URDF and meshes");
  command->add_option("--points", arguments->points, "how many points that has")
      ->capture_default_str();
  command->add_flag("--visual", arguments->visual, "visual meshes in place of collision meshes");
  command->add_option("--json", arguments->json, "write the figures here");
  command->callback([arguments, &exit_code] { exit_code = run_reference(*arguments); });
}

}  // namespace glint
