#include "platform/tools/robot/sample_robot.hpp"

#include <cmath>

#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

double area_of(const Triangle& t) {
  const Vector3 a = t.a.cast<double>();
  return 0.5 * (t.b.cast<double>() - a).cross(t.c.cast<double>() - a).norm();
}

}  // namespace

// Cumulative area over the triangles: point i is at (i + u) / n of it. Within its triangle a point
// is uniform by the square root of one number (Osada et al. 2002, section 4.1).
RobotCloud sample_robot(const RobotModel& robot, int points) {
  if (points < 1 || points > k_model_points_max) {
    throw InputError(std::to_string(points) + " points of a robot; expected 1 to " +
                     std::to_string(k_model_points_max));
  }
  RobotCloud out{robot.name, robot.tree, robot.links, robot.inputs, {}, {}, {}, 0};
  double total = 0;
  for (const LinkSurface& link : robot.surfaces) {
    const Surface surface{link.corners, link.faces};
    for (std::size_t f = 0; f < link.faces.size(); ++f) total += area_of(surface.triangle(f));
  }
  out.spacing_m = static_cast<float>(std::sqrt(total / points));
  const sim::RandomKey key{0, sim::Stream::points, 0};
  double cumulative_area = 0;
  std::uint64_t next = 0;
  const auto area_position = [&](std::uint64_t i) {
    return (static_cast<double>(i) + sim::uniform(key, 3 * i)) * total / points;
  };
  for (const LinkSurface& link : robot.surfaces) {
    const Surface surface{link.corners, link.faces};
    for (std::size_t f = 0; f < link.faces.size(); ++f) {
      const Triangle t = surface.triangle(f);
      cumulative_area += area_of(t);
      const Vector3f normal = (t.b - t.a).cross(t.c - t.a).normalized();
      for (; next < static_cast<std::uint64_t>(points) && area_position(next) < cumulative_area;
           ++next) {
        const auto root = static_cast<float>(std::sqrt(sim::uniform(key, 3 * next + 1)));
        const auto along = static_cast<float>(sim::uniform(key, 3 * next + 2));
        out.points.emplace_back((1 - root) * t.a + root * (1 - along) * t.b + root * along * t.c);
        out.normals.push_back(normal);
        out.point_links.push_back(static_cast<std::uint16_t>(link.link));
      }
    }
  }
  return out;
}

}  // namespace glint
