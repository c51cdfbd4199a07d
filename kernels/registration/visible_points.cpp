#include "kernels/registration/visible_points.hpp"

namespace glint {

int visible_points(const SceneView& view, const Pose& T_camera_base, int step,
                   const DepthBuffer& buffer, std::span<VisiblePoint> points) noexcept {
  const Pinhole& camera = view.camera;
  const Reason reason = render_depth(view.model, T_camera_base, camera, buffer);
  if (reason == Reason::out_of_range || step < 1) return 0;
  const Eigen::Matrix3f rotation = T_camera_base.rotation.toRotationMatrix().cast<float>();
  std::size_t count = 0;
  for (int y = step / 2; y < camera.height; y += step) {
    for (int x = step / 2; x < camera.width; x += step) {
      const int pixel = y * camera.width + x;
      const std::int32_t number = buffer.triangle[static_cast<std::size_t>(pixel)];
      if (number < 0) continue;
      if (count == points.size()) return static_cast<int>(count);
      const Triangle t = view.model.triangle(static_cast<std::size_t>(number));
      VisiblePoint& seen = points[count];
      seen.point = pixel_point(camera, x, y, buffer.z_m[static_cast<std::size_t>(pixel)]);
      const Vector3f across = rotation * (t.b - t.a).cross(t.c - t.a);
      const float length = across.norm();
      if (!(length > 0)) continue;
      seen.normal = across * ((across.dot(seen.point) > 0 ? -1.0f : 1.0f) / length);
      seen.pixel = pixel;
      ++count;
    }
  }
  return static_cast<int>(count);
}

}  // namespace glint
