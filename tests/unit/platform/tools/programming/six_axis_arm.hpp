// A six-axis arm with a spherical wrist for tests: its URDF, and its inverse kinematics in closed
// form, which shares nothing with the solver.
//
// At zero the arm points up: joint 1 about z, joints 2 and 3 about y, wrist z-y-z. Source of the
// closed form: Craig 2005, Introduction to Robotics, section 4.6 (Pieper's solution).
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint::test {

struct SixAxisArm {
  static constexpr double base = 0.4, upper = 0.45, fore = 0.42, hand = 0.1;
  // Joint 2 and 3 reach forward only: no limit of joint 1 is avoided by reaching backward.
  std::array<double, 6> low{-2.8, -0.2, 0.1, -3.0, -2.2, -3.0};
  std::array<double, 6> high{2.8, 1.7, 2.4, 3.0, 2.2, 3.0};

  using Joints = std::array<double, 6>;

  static Quaternion turn(int axis, double angle) {
    return Quaternion(Eigen::AngleAxisd(angle, Vector3::Unit(axis)));
  }

  // `links`: the elements of links l1 to l6, instead of links without shapes.
  [[nodiscard]] std::string urdf(const std::string& links = "") const {
    const double offset[6] = {base, 0, upper, fore, 0, 0};
    const char* axis[6] = {"0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"};
    std::string xml = "<robot name='six_axis'><link name='l0'/>";
    const auto origin = [](double z) { return "<origin xyz='0 0 " + std::to_string(z) + "'/>"; };
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string n = std::to_string(i), m = std::to_string(i + 1);
      if (links.empty()) xml += "<link name='l" + m + "'/>";
      xml += "<joint name='j" + m + "' type='revolute'><parent link='l" + n + "'/><child link='l" +
             m + "'/>" + origin(offset[i]) + "<axis xyz='" + axis[i] +
             "'/><limit effort='1' velocity='1' lower='" + std::to_string(low[i]) + "' upper='" +
             std::to_string(high[i]) + "'/></joint>";
    }
    return xml + links +
           "<link name='tip'/><joint name='hand' type='fixed'><parent link='l6'/>"
           "<child link='tip'/>" +
           origin(hand) + "</joint></robot>";
  }

  static Pose forward(const Joints& q) {
    const Quaternion r1 = turn(2, q[0]), r2 = r1 * turn(1, q[1]), r3 = r2 * turn(1, q[2]);
    const Quaternion r6 = r3 * turn(2, q[3]) * turn(1, q[4]) * turn(2, q[5]);
    const Vector3 z = Vector3::UnitZ();
    return {r6, base * z + r2 * (upper * z) + r3 * (fore * z) + r6 * (hand * z)};
  }

  // Every solution, up to eight, limits aside. Revolute angles are in (-pi, pi].
  static std::vector<Joints> inverse(const Pose& pose) {
    std::vector<Joints> all;
    const Vector3 w = pose.translation - pose.rotation * Vector3(0, 0, hand);
    const double z = w.z() - base;
    const double c3 = (w.squaredNorm() - w.z() * w.z() + z * z - upper * upper - fore * fore) /
                      (2 * upper * fore);
    if (std::abs(c3) > 1 + 1e-9) return all;
    for (const double side : {1.0, -1.0}) {
      const double r = side * std::hypot(w.x(), w.y());
      for (const double elbow : {1.0, -1.0}) {
        const double q3 = elbow * std::acos(std::min(1.0, std::max(-1.0, c3)));
        const double q1 = std::atan2(side * w.y(), side * w.x());
        const double q2 =
            std::atan2(r, z) - std::atan2(fore * std::sin(q3), upper + fore * std::cos(q3));
        const Quaternion arm = turn(2, q1) * turn(1, q2 + q3);
        const Matrix3 m = (arm.conjugate() * pose.rotation).toRotationMatrix();
        for (const double flip : {1.0, -1.0}) {
          all.push_back({q1, std::remainder(q2, 2 * M_PI), q3,
                         std::atan2(flip * m(1, 2), flip * m(0, 2)),
                         flip * std::atan2(std::hypot(m(0, 2), m(1, 2)), m(2, 2)),
                         std::atan2(flip * m(2, 1), -flip * m(2, 0))});
        }
      }
    }
    return all;
  }

  [[nodiscard]] bool within(const Joints& q, double margin) const {
    for (std::size_t i = 0; i < 6; ++i) {
      if (q[i] < low[i] + margin || q[i] > high[i] - margin) return false;
    }
    return true;
  }

  // The factors of the Jacobian's determinant: elbow, wrist, shoulder (lengths in metres).
  static double from_singular(const Joints& q) {
    const double r = upper * std::sin(q[1]) + fore * std::sin(q[1] + q[2]);
    return std::min({std::abs(std::sin(q[2])), std::abs(std::sin(q[4])), std::abs(r)});
  }
};

}  // namespace glint::test
