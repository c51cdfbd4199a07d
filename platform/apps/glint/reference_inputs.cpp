#include "platform/apps/glint/reference_inputs.hpp"

#include <cstdio>

#include "kernels/angles.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "platform/tools/reference/camera_info.hpp"

namespace glint {
namespace {

// Returns the pose if it is finite and within 1 km per axis; else throws InputError with `what`.
Pose checked(const Pose& pose, const std::string& what) {
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite() ||
      pose.translation.cwiseAbs().maxCoeff() > 1e3) {
    throw InputError(what + ": expected x,y,z,roll,pitch,yaw in metres and radians");
  }
  return pose;
}

// Requires a guess in the camera's frame, if both the guess and the calibration name a frame.
void check_frame(const ReceivedInitialPose& guess, const std::string& camera_file) {
  const std::string found = guess.frame.data(), expected = read_camera_frame(camera_file);
  if (found.empty() || expected.empty() || found == expected) return;
  throw InputError(std::string(k_initial_pose_topic) + ": an initial pose in frame \"" + found +
                   "\"; expected T_camera_base in \"" + expected + "\", the frame_id of " +
                   camera_file);
}

}  // namespace

void require_inputs(const ReferenceArguments& arguments) {
  const bool listens = arguments.listen_s > 0, exports = arguments.only_exports();
  const std::pair<const char*, bool> wanted[] = {
      {"--depth", !exports && arguments.scene.depth.empty()},
      {"--camera", !exports && arguments.scene.camera.empty()},
      {"--urdf", !listens && !arguments.has_robot()},
      {"--joints", !listens && !exports && arguments.scene.joints.empty()},
      {"--initial-pose", !listens && !exports && arguments.initial_guess.empty()}};
  for (const auto& [option, missing] : wanted) {
    if (missing) {
      throw InputError(std::string(option) +
                       " is missing; expected --urdf or --model, --depth, --joints, --camera and "
                       "--initial-pose (with "
                       "--listen only --depth and --camera), or --urdf and --export-model alone");
    }
  }
  if (!arguments.export_file.empty() && !arguments.model.empty()) {
    throw InputError("--export-model: expected --urdf, not --model: a cloud has no surface");
  }
}

FindReferenceSettings settings_of(const ReferenceArguments& arguments) {
  FindReferenceSettings settings;
  settings.shared_errors.depth_sigma_m = 1e-3 * arguments.depth_bias_mm;
  if (arguments.range.empty()) return settings;
  settings.range = {arguments.range[0], arguments.range[1] / k_degrees_per_radian};
  if (!(settings.range.translation_m > 0 && settings.range.translation_m <= 2) ||
      !(settings.range.rotation_rad > 0 && arguments.range[1] <= 180)) {
    throw InputError("--search-range: expected metres of (0, 2] and degrees of (0, 180]");
  }
  return settings;
}

std::unique_ptr<ReferenceListener> listener_of(const ReferenceArguments& arguments) {
  const bool exports = arguments.only_exports();
  const ReferenceNeeds needs{!arguments.has_robot(), !exports && arguments.scene.joints.empty(),
                             !exports && arguments.initial_guess.empty()};
  const bool nothing = !needs.description && !needs.joints && !needs.guess;
  if (nothing || !(arguments.listen_s > 0)) return nullptr;
  auto progress = std::make_shared<Progress>("listens");
  return std::make_unique<ReferenceListener>(
      arguments.network, needs, Duration{static_cast<std::int64_t>(1e9 * arguments.listen_s)},
      [progress](double seconds, const std::string& topics) {
        progress->show(seconds, 0, "for " + topics);
      });
}

AnyRobot robot_of(ReferenceArguments& arguments, ReferenceListener* listener) {
  if (!arguments.model.empty()) return read_robot_cloud(arguments.model);
  if (arguments.visual) arguments.robot.geometry = Geometry::visual;
  if (arguments.robot.urdf.empty()) {
    arguments.robot.urdf = k_robot_description_topic;
    arguments.robot.text = listener->description();
  }
  return load_robot(arguments.robot);
}

Pose initial_pose_of(ReferenceArguments& arguments, const AnyRobot& robot,
                     ReferenceListener* listener) {
  ReceivedInputs received;
  if (listener != nullptr) {
    received =
        listener->wait_for_inputs(std::visit([](const auto& any) { return any.inputs; }, robot));
  }
  if (arguments.scene.joints.empty()) {
    arguments.scene.positions = received.positions;
    arguments.scene.positions_from = k_joint_states_topic;
    std::printf("joints     %zu of %s\n", received.positions.size(), k_joint_states_topic);
  }
  if (!arguments.initial_guess.empty())
    return checked(pose_from_xyz_rpy(arguments.initial_guess), "--initial-pose");
  const Vector3& t = received.guess.pose.translation;
  std::printf("guess      [%.3f, %.3f, %.3f] m of %s, in frame \"%s\"\n", t.x(), t.y(), t.z(),
              k_initial_pose_topic, printable(received.guess.frame.data()).c_str());
  check_frame(received.guess, arguments.scene.camera);
  return checked(received.guess.pose, k_initial_pose_topic);
}

}  // namespace glint
