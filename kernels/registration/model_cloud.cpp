#include "kernels/registration/model_cloud.hpp"

namespace glint {

Reason PoseCloudRun::start(const LinkCloud& robot, const LinkPoses& poses,
                           std::span<Vector3f> points, std::span<Vector3f> normals) noexcept {
  const std::size_t count = robot.cloud.points.size();
  const bool fits = count <= k_model_points_max && robot.cloud.normals.size() == count &&
                    robot.links.size() == count && points.size() == count &&
                    normals.size() == count;
  robot_ = fits ? robot : LinkCloud{};
  poses_ = &poses;
  points_ = points;
  normals_ = normals;
  link_ = -1;
  at_ = 0;
  reason_ = fits ? Reason::none : Reason::out_of_range;
  return reason_;
}

bool PoseCloudRun::step(StepBudget& budget) noexcept {
  for (; at_ < robot_.links.size() && !budget.spent(); ++at_) {
    if (robot_.links[at_] != link_) {
      if (robot_.links[at_] >= poses_->count) {
        robot_ = LinkCloud{};
        reason_ = Reason::out_of_range;
        return false;
      }
      select_link(robot_.links[at_]);
      budget.take(k_posed_link_steps);
    }
    points_[at_] = rotation_ * robot_.cloud.points[at_] + translation_;
    normals_[at_] = rotation_ * robot_.cloud.normals[at_];
    budget.take(k_posed_point_steps);
  }
  return at_ < robot_.links.size();
}

void PoseCloudRun::select_link(int link) noexcept {
  const Pose& pose = poses_->T_root_link[static_cast<std::size_t>(link)];
  rotation_ = pose.rotation.toRotationMatrix().cast<float>();
  translation_ = pose.translation.cast<float>();
  link_ = link;
}

Reason pose_cloud(const LinkCloud& robot, const LinkPoses& poses, std::span<Vector3f> points,
                  std::span<Vector3f> normals) noexcept {
  PoseCloudRun run;
  if (run.start(robot, poses, points, normals) != Reason::none) return run.reason();
  for (StepBudget all; run.step(all); all = StepBudget()) {
  }
  return run.reason();
}

}  // namespace glint
