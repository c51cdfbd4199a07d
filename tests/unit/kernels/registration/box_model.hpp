// Test model for registration: an arm of three boxes, its ground truth pose, and points on it.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "kernels/registration/model_cloud.hpp"

namespace glint::test {

// An arm of three boxes about one corner, each of a different size.
struct BoxArm {
  std::vector<Vector3f> corners;
  std::vector<Face> faces;

  void add(const Vector3f& low, const Vector3f& high) {
    const auto first = static_cast<std::int32_t>(corners.size());
    for (int i = 0; i < 8; ++i) {
      corners.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                           i & 4 ? high.z() : low.z());
    }
    const int quads[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& q : quads) {
      faces.push_back({first + q[0], first + q[1], first + q[2]});
      faces.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }
  BoxArm() {
    add({-0.1f, -0.1f, 0}, {0.1f, 0.1f, 0.5f});
    add({-0.05f, -0.05f, 0.4f}, {0.45f, 0.06f, 0.5f});
    add({0.37f, -0.06f, 0.2f}, {0.45f, 0.06f, 0.5f});
  }
};

// Camera above and aside: three sides of each box are visible. Otherwise a direction would be
// unobservable.
inline const Pose k_truth{Quaternion(Eigen::AngleAxisd(2.094, Vector3::UnitX()) *
                                     Eigen::AngleAxisd(0.6, Vector3::UnitZ())),
                          {-0.1, 0.15, 1.3}};

// Random points on its surface, on average one per spacing_m^2; fixed random seed.
struct SampledModel {
  std::vector<Vector3f> points, normals;
  float spacing_m;

  SampledModel(const BoxArm& model, float spacing) : spacing_m(spacing) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(0, 1);
    const Surface surface{model.corners, model.faces};
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const Triangle t = surface.triangle(f);
      const Vector3f across = (t.b - t.a).cross(t.c - t.a);
      const int count = static_cast<int>(0.5f * across.norm() / (spacing * spacing) + any(random));
      for (int i = 0; i < count; ++i) {
        const float root = std::sqrt(any(random)), along = any(random);
        points.emplace_back((1 - root) * t.a + root * (1 - along) * t.b + root * along * t.c);
        normals.emplace_back(across.normalized());
      }
    }
  }
  [[nodiscard]] ModelCloud cloud() const { return {points, normals, spacing_m}; }
};

}  // namespace glint::test
