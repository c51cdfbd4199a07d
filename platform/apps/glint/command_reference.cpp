// glint reference: pose of a robot, from depth images of it and a rough pose, or from touches.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/publishing.hpp"
#include "platform/apps/glint/reference_inputs.hpp"
#include "platform/apps/glint/reference_report.hpp"
#include "platform/apps/glint/reference_touch.hpp"
#include "platform/in_range.hpp"
#include "platform/tools/robot/sample_robot.hpp"

namespace glint {
namespace {

void export_model(const ReferenceArguments& arguments, const RobotModel& robot) {
  const RobotCloud cloud = sample_robot(robot, arguments.points);
  write_robot_cloud(arguments.export_file, cloud);
  std::printf("model      %s: %zu points of %zu links, %.1f mm apart\n",
              arguments.export_file.c_str(), cloud.points.size(), cloud.links.size(),
              1e3 * static_cast<double>(cloud.spacing_m));
}

int run_reference(ReferenceArguments arguments) {
  if (!arguments.touch.points.empty()) return run_touch(arguments.touch, arguments.json);
  require_inputs(arguments);
  std::unique_ptr<ReferenceListener> listener = listener_of(arguments);
  const AnyRobot robot = robot_of(arguments, listener.get());
  const auto* const meshes = std::get_if<RobotModel>(&robot);
  if (arguments.only_exports()) {
    export_model(arguments, *meshes);
    return 0;
  }
  const Pose start = initial_pose_of(arguments, robot, listener.get());
  listener.reset();
  const std::vector<SceneFrame> frames =
      std::visit([&](const auto& any) { return read_scene(arguments.scene, any); }, robot);
  const FindReferenceSettings settings = settings_of(arguments);
  const Reference reference = find_reference(frames, start, settings);
  const ReferenceContext facts{std::visit([](const auto& any) { return any.name; }, robot),
                               meshes != nullptr ? meshes->triangles_skipped : 0, frames.size(),
                               settings.range};
  print_reference(reference, facts);
  if (!arguments.export_file.empty()) export_model(arguments, *meshes);
  write_json(arguments.json, reference_json(reference, facts));
  return reference.verdict == ReferenceVerdict::accepted ? 0 : 1;
}

}  // namespace

void add_reference(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "reference", "Find the robot's base in depth images, or by touches of the pen");
  auto arguments = std::make_shared<ReferenceArguments>();
  RobotFiles& robot = arguments->robot;
  SceneFiles& scene = arguments->scene;
  command->footer(
      "Example:\n"
      "  glint reference --urdf arm.urdf --package-dir meshes --export-model arm.ply\n"
      "  glint reference --urdf arm.urdf --package-dir meshes --camera camera_info.yaml\n"
      "    --depth a.npy b.npy --joints a.txt b.txt --initial-pose 0.4,0.2,1.2,-1.6,0.1,0.8 --json "
      "r.json\n"
      "  glint reference --listen 60 --package-dir meshes --camera camera_info.yaml --depth a.npy\n"
      "  glint reference --touch points.toml --tips out/run.mcap\n"
      "Exit: 0 accepted, 1 ambiguous or refused, 2 bad use or input, 3 no such interface.");
  auto* const urdf = command->add_option("--urdf", robot.urdf, "URDF file of the robot");
  command
      ->add_option("--model", arguments->model, "file written by --export-model, instead of --urdf")
      ->excludes(urdf);
  command->add_option("--package-dir", robot.package_dirs,
                      "folders of package:// paths: FOLDER or NAME=FOLDER");
  command->add_option("--joints", scene.joints,
                      "joint positions, one file for each depth image: .npy or text");
  command->add_option(
      "--depth", scene.depth,
      "depth images .npy (m), .png (16 bit, mm), or clouds .pcd, .ply in the camera's frame");
  command->add_option("--camera", scene.camera, "ROS camera_info, YAML");
  command->add_option("--mask", scene.masks,
                      "masks of the robot's pixels, one file for each depth image");
  command
      ->add_option("--initial-pose,--seed", arguments->initial_guess,
                   "initial T_camera_base: x,y,z,roll,pitch,yaw in metres and radians, fixed axes")
      ->delimiter(',')
      ->expected(6);
  command
      ->add_option("--search-range", arguments->range,
                   "M,DEG  largest error of each coordinate and angle of the initial pose (0.4,40)")
      ->delimiter(',')
      ->expected(2);
  command
      ->add_option("--depth-bias-mm", arguments->depth_bias_mm,
                   "standard deviation of the depth error common to one image")
      ->check(in_range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--listen", arguments->listen_s,
                   "seconds to wait for missing inputs over DDS: /robot_description, /joint_states "
                   "(for every image), /initialpose (T_camera_base)")
      ->check(in_range(0.1, 86400.0));
  add_network_options(*command, arguments->network);
  command->add_option(
      "--export-model", arguments->export_file,
      "PLY file of joints and surface points; a board reads it instead of URDF and meshes");
  command->add_option("--points", arguments->points, "number of points of --export-model")
      ->capture_default_str();
  add_touch_options(*command, arguments->touch);
  command->add_flag("--visual", arguments->visual, "visual meshes instead of collision meshes");
  command->add_option("--json", arguments->json, "file of the figures");
  command->callback([arguments, &exit_code] { exit_code = run_reference(*arguments); });
}

}  // namespace glint
