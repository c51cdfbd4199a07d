#include "alignment_race.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "alignment_glint.hpp"
#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"

namespace glint::bench {
namespace {

constexpr double k_shift_m = 0.09, k_turn_deg = 5;
constexpr float k_reach_m = 0.15f;
constexpr double k_speedup_min = 5;
constexpr int k_source_every = 4;

struct Clouds {
  std::vector<float> source, normals, target;
  Pose T_target_source;  // ground truth
};

// Every fourth point is a source point, displaced; the others are target points.
Clouds part(const PointCloud& surface) {
  Clouds clouds;
  Vector3 middle = Vector3::Zero();
  for (int i = 0; i < surface.count; ++i)
    middle += Vector3(surface.x[i], surface.y[i], surface.z[i]) / surface.count;
  const Vector3 axis = Vector3(1, 2, -1).normalized(), way = Vector3(2, -1, 2).normalized();
  const Quaternion turn = from_rotation_vector(k_turn_deg / k_degrees_per_radian * axis);
  const Pose away{turn, middle + k_shift_m * way - turn * middle};
  clouds.T_target_source = away.inverse();
  for (int i = 0; i < surface.count; ++i) {
    const Vector3 p(surface.x[i], surface.y[i], surface.z[i]);
    if (i % k_source_every != 0) {
      for (int k = 0; k < 3; ++k) clouds.target.push_back(static_cast<float>(p[k]));
      continue;
    }
    const Vector3 n(surface.normal_x[i], surface.normal_y[i], surface.normal_z[i]);
    const Vector3 moved = away * p, turned = away.rotation * n;
    for (int k = 0; k < 3; ++k) {
      clouds.source.push_back(static_cast<float>(moved[k]));
      clouds.normals.push_back(static_cast<float>(turned[k]));
    }
  }
  return clouds;
}

// Rms distance of the aligned source points from their true positions.
double error_m(const Clouds& clouds, const AlignmentAnswer& answer) {
  double squares = 0;
  const std::size_t count = clouds.source.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 p(clouds.source[3 * i], clouds.source[3 * i + 1], clouds.source[3 * i + 2]);
    Vector3 end;
    for (int r = 0; r < 3; ++r) {
      const double* const row = answer.matrix + 4 * r;
      end[r] = row[0] * p.x() + row[1] * p.y() + row[2] * p.z() + row[3];
    }
    squares += (end - clouds.T_target_source * p).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(count));
}

struct Row {
  std::vector<double> seconds;
  double error_m = 0;
  [[nodiscard]] double median_ms() {
    std::sort(seconds.begin(), seconds.end());
    return 1e3 * seconds[seconds.size() / 2];
  }
};

}  // namespace

bool benchmark_alignments(const PointCloud& surface, RunAlignment rival, int rounds) {
  const Clouds clouds = part(surface);
  const AlignmentTask task{clouds.source.data(),
                           clouds.normals.data(),
                           static_cast<int>(clouds.source.size() / 3),
                           clouds.target.data(),
                           static_cast<int>(clouds.target.size() / 3),
                           k_reach_m};
  CloudAlignment glint(task.target_count);
  Row pcl, plane, point;
  const auto once = [&](Row& row, const auto& run, bool keep) {
    AlignmentAnswer answer{};
    run(answer);
    if (keep) row.seconds.push_back(answer.seconds);
    row.error_m = error_m(clouds, answer);
  };
  for (int round = 0; round <= rounds; ++round) {  // round 0 is the warm-up
    const bool keep = round > 0;
    once(
        plane, [&](AlignmentAnswer& a) { glint.run(task, Matching::plane, a); }, keep);
    once(
        point, [&](AlignmentAnswer& a) { glint.run(task, Matching::point, a); }, keep);
    if (rival != nullptr)
      once(
          pcl, [&](AlignmentAnswer& a) { rival(task, a); }, keep);
  }
  std::printf("%d points to %d others, %.0f mm and %.0f degrees away\n", task.source_count,
              task.target_count, 1e3 * k_shift_m, k_turn_deg);
  const auto print = [](const char* name, Row& row) {
    std::printf("  %-36s %10.2f ms   ends %.3f mm off\n", name, row.median_ms(), 1e3 * row.error_m);
  };
  if (rival != nullptr) print("PCL, point to point", pcl);
  print("Glint, point to point", point);
  print("Glint, point to plane", plane);
  if (rival == nullptr) return true;
  const double ratio = pcl.median_ms() / plane.median_ms();
  const bool met = ratio >= k_speedup_min && plane.error_m <= pcl.error_m;
  std::printf("  PCL / Glint, at an error no larger %17.1f x   bar: >= 5         %s\n", ratio,
              met ? "met" : "MISSED");
  return met;
}

}  // namespace glint::bench
