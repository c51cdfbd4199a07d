#include "platform/tools/programming/sampled_path.hpp"

#include <cmath>
#include <numbers>

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

// The circle from `from` through `via` to `to`, and its angle from the first to the last.
struct MoveCircle {
  Vector3 centre, axis;
  double angle = 0;
};

MoveCircle circle_of(const Vector3& from, const Vector3& via, const Vector3& to) {
  const Vector3 a = via - from, b = to - from, normal = a.cross(b);
  const Vector3 out = (b.squaredNorm() * normal.cross(a) + a.squaredNorm() * b.cross(normal)) /
                      (2 * normal.squaredNorm());
  const Vector3 axis = normal.normalized();
  const Vector3 first = -out, last = b - out;
  const double angle = std::atan2(axis.dot(first.cross(last)), first.dot(last));
  return {from + out, axis, angle > 0 ? angle : angle + 2 * std::numbers::pi};
}

void add_samples(const Pose& from, const StrokeMove& move, const MotionSteps& steps,
                 std::vector<UncertainPose>& points) {
  const double turn = rotation_vector(from.rotation.conjugate() * move.pose.rotation).norm();
  const auto add = [&](double length_m, auto position_at) {
    const int count = step_count(length_m, turn, steps);
    for (int i = 1; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      points.push_back({Time{},
                        {slerp(from.rotation, move.pose.rotation, share), position_at(share)},
                        Matrix6::Zero()});
    }
  };
  if (move.via) {
    const MoveCircle circle =
        circle_of(from.translation, move.via->translation, move.pose.translation);
    const Vector3 first = from.translation - circle.centre;
    add(circle.angle * first.norm(), [&](double share) {
      return Vector3(circle.centre + Eigen::AngleAxisd(share * circle.angle, circle.axis) * first);
    });
  } else {
    add((move.pose.translation - from.translation).norm(), [&](double share) {
      return constant_velocity(from.translation, move.pose.translation, share);
    });
  }
}

}  // namespace

DrawnPath sampled_path(const DrawnPath& path, const SegmentSettings& shapes,
                       const MotionSteps& steps) {
  DrawnPath sampled;
  for (const PathElement& element : path) {
    sampled.push_back({element.kind, {}, element.name});
    std::vector<UncertainPose>& points = sampled.back().points;
    const std::vector<StrokeMove> moves = stroke_moves(element.points, shapes);
    points.push_back({Time{}, moves.front().pose, Matrix6::Zero()});
    for (std::size_t i = 1; i < moves.size(); ++i)
      add_samples(moves[i - 1].pose, moves[i], steps, points);
  }
  return sampled;
}

}  // namespace glint
