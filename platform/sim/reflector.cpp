#include "platform/sim/reflector.hpp"

#include <array>
#include <cmath>

#include "platform/sim/capsule.hpp"
#include "platform/sim/pixel_box.hpp"

namespace glint::sim {
namespace {

constexpr int k_occluders_max = 32;
constexpr int k_hidden_samples = 4;  // inside, if an occluder may hide it

// Sums over the rays of one pixel.
struct Light {
  double rays = 0;    // hit the reflector, without occlusion
  double open = 0;    // of these, not occluded
  double signal = 0;  // sum over open
  double range = 0;   // sum over open, weighted by signal
};

struct Traced {
  double range = 0, signal = 0;  // range 0: no hit
};

// inside: distance in metres of the ray's point nearest to the reflector from its edge, positive
// inside. footprint: size of a pixel at that point, metres.
struct Rim {
  double inside = 0, footprint = 0;
};

class Shape {
 public:
  Shape(const Reflector& reflector, const Vector3& centre) : r_(reflector), centre_(centre) {}

  [[nodiscard]] Rim rim(const Vector3& unit, double pixel_rad) const {
    const double range = unit.dot(centre_);
    const double size = 0.75 * pixel_rad * range;
    if (!r_.is_disc()) {
      const double across2 = centre_.squaredNorm() - range * range;
      return {r_.radius_m - std::sqrt(across2 > 0 ? across2 : 0), size};
    }
    const double slant = unit.dot(r_.normal);
    if (std::abs(slant) < 1e-3) return {-1, 0};
    const double hit = r_.normal.dot(centre_) / slant;
    return {r_.radius_m - (hit * unit - centre_).norm(), size / std::abs(slant)};
  }

  // `ray` need not have unit length.
  [[nodiscard]] Traced trace(const Vector3& ray) const {
    const double length2 = ray.squaredNorm();
    if (!r_.is_disc()) {
      const double along = ray.dot(centre_);
      const double square =
          along * along - length2 * (centre_.squaredNorm() - r_.radius_m * r_.radius_m);
      if (square < 0 || along <= 0) return {};
      const double root = std::sqrt(square);
      const double length = std::sqrt(length2);
      const double cosine = root / (length * r_.radius_m);
      return at_range((along - root) / length, r_.limb + (1 - r_.limb) * cosine);
    }
    const double slant = ray.dot(r_.normal);
    if (std::abs(slant) < 1e-6) return {};
    const double hit = r_.normal.dot(centre_) / slant;
    if (hit <= 0) return {};
    if ((hit * ray - centre_).squaredNorm() > r_.radius_m * r_.radius_m) return {};
    const double length = std::sqrt(length2);
    return at_range(hit * length, std::abs(slant) / length);
  }

 private:
  [[nodiscard]] Traced at_range(double range, double share) const {
    if (range < 0.02) return {};
    return {range, r_.signal * share * (0.25 / (range * range))};
  }

  const Reflector& r_;
  Vector3 centre_;
};

class Occluders {
 public:
  Occluders(std::span<const Capsule> all, const Reflector& reflector) {
    for (const Capsule& capsule : all) {
      const double reach = capsule.radius_m + reflector.radius_m + 0.5 * reflector.travel.norm();
      if (axis_distance(capsule, reflector.centre) > reach + 0.002) continue;
      if (count_ < k_occluders_max) near_[static_cast<std::size_t>(count_++)] = &capsule;
    }
  }
  [[nodiscard]] bool any() const { return count_ > 0; }
  [[nodiscard]] bool hide(const Vector3& ray, double range) const {
    if (count_ == 0) return false;
    const Vector3 unit = ray.normalized();
    for (int i = 0; i < count_; ++i) {
      const Hit hit = TracedCapsule(*near_[static_cast<std::size_t>(i)]).trace(unit);
      if (hit && hit.range_m < range) return true;
    }
    return false;
  }

 private:
  std::array<const Capsule*, k_occluders_max> near_{};
  int count_ = 0;
};

void add_rays(const Shape& shape, const Occluders& occluders, const Vector3& middle,
              const LensRays::Slopes& slopes, int samples, Light& light) {
  const double weight = 1.0 / (samples * samples);
  for (int j = 0; j < samples; ++j) {
    const double down = (j + 0.5) / samples - 0.5;
    for (int i = 0; i < samples; ++i) {
      const double right = (i + 0.5) / samples - 0.5;
      const Vector3 ray = middle + right * slopes.right + down * slopes.down;
      const Traced traced = shape.trace(ray);
      if (traced.range <= 0) continue;
      light.rays += weight;
      if (occluders.hide(ray, traced.range)) continue;
      light.open += weight;
      light.signal += weight * traced.signal;
      light.range += weight * traced.signal * traced.range;
    }
  }
}

Light light_of_pixel(const Reflector& reflector, const Occluders& occluders, const LensRays& rays,
                     int x, int y, int exposures) {
  Light light;
  const Vector3 middle = rays.ray(x, y);
  const LensRays::Slopes slopes = rays.slopes(x, y);
  const double pixel_rad = slopes.coarsest_rad();
  for (int e = 0; e < exposures; ++e) {
    const double when = (e + 0.5) / exposures - 0.5;
    const Shape shape(reflector, reflector.centre + when * reflector.travel);
    const Rim rim = shape.rim(middle, pixel_rad);
    if (rim.inside < -rim.footprint) continue;
    const bool edge = rim.inside < rim.footprint;
    const int samples = edge ? k_edge_samples : occluders.any() ? k_hidden_samples : 1;
    add_rays(shape, occluders, middle, slopes, samples, light);
  }
  light.rays /= exposures;
  light.open /= exposures;
  light.signal /= exposures;
  light.range /= exposures;
  return light;
}

void mix(const Light& light, double range_error, float& signal, float& range) {
  const double behind = (1 - light.open) * double{signal};
  const double sum = light.signal + behind;
  const double own = light.range + light.signal * range_error;
  const double mixed_range = range > 0 ? (own + behind * double{range}) / sum : own / light.signal;
  signal = static_cast<float>(sum);
  range = static_cast<float>(mixed_range);
}

}  // namespace

RenderedReflector draw(const Reflector& reflector, const CameraModel& model, const LensRays& rays,
                       std::span<const Capsule> occluders, Planes& planes) {
  RenderedReflector drawn;
  const double range = reflector.centre.norm();
  if (reflector.centre.z() < 0.02 || range < 2 * reflector.radius_m) return drawn;
  const Result<Vector2> centre = project(model, reflector.centre);
  if (!centre) return drawn;
  drawn.pixel = centre.value;
  const double pixel_rad = finest_pixel_rad(rays, drawn.pixel);
  drawn.radius_px = reflector.radius_m / (range * pixel_rad);
  const double blur_px = reflector.travel.norm() / (range * pixel_rad);
  PixelBox box;
  box.add(drawn.pixel,
          1.2 * drawn.radius_px * range / (range - reflector.radius_m) + 0.5 * blur_px + 1.5);
  box.clip(rays.width(), rays.height());
  const double steps = blur_px / k_blur_step_px;
  const int exposures = steps < k_exposures_max - 1 ? static_cast<int>(steps) + 1 : k_exposures_max;
  const Occluders near(occluders, reflector);
  double total = 0, open = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (!rays.has_ray(x, y)) {
        const Vector2 middle(x + 0.5, y + 0.5);
        if ((middle - drawn.pixel).squaredNorm() < drawn.radius_px * drawn.radius_px) total += 1;
        continue;
      }
      const Light light = light_of_pixel(reflector, near, rays, x, y, exposures);
      total += light.rays;
      open += light.open;
      if (light.signal <= 0) continue;
      const std::size_t i = planes.at(x, y);
      mix(light, reflector.range_error_m, planes.signal[i], planes.range_m[i]);
      if (double{planes.signal[i]} > drawn.peak_signal) {
        drawn.peak_signal = double{planes.signal[i]};
      }
    }
  }
  const double rim_px = drawn.radius_px;
  const bool inside = drawn.pixel.x() >= rim_px && drawn.pixel.x() <= rays.width() - rim_px &&
                      drawn.pixel.y() >= rim_px && drawn.pixel.y() <= rays.height() - rim_px;
  drawn.visible_fraction = inside && total > 0 ? open / total : 0;
  return drawn;
}

void draw(const Capsule& capsule, const CameraModel& model, const LensRays& rays, Planes& planes) {
  constexpr int k_places = 8;
  PixelBox box;
  for (int i = 0; i <= k_places; ++i) {
    const Vector3 place = capsule.a + (capsule.b - capsule.a) * (double{1} * i / k_places);
    const double range = place.norm();
    if (place.z() < 0.02 || range <= 1.05 * capsule.radius_m) continue;
    const Result<Vector2> pixel = project(model, place);
    if (!pixel) continue;
    const double reach = capsule.radius_m + (capsule.b - capsule.a).norm() / (2 * k_places);
    box.add(pixel.value,
            1.3 * reach / ((range - capsule.radius_m) * finest_pixel_rad(rays, pixel.value)) + 2);
  }
  box.clip(rays.width(), rays.height());
  const TracedCapsule traced(capsule);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (!rays.has_ray(x, y)) continue;
      const Hit hit = traced.trace(rays.ray(x, y));
      const std::size_t i = planes.at(x, y);
      if (!hit || hit.range_m < 0.02) continue;
      if (planes.range_m[i] > 0 && hit.range_m >= double{planes.range_m[i]}) continue;
      const double share = (0.3 + 0.7 * hit.cosine) * (0.25 / (hit.range_m * hit.range_m));
      planes.signal[i] = static_cast<float>(capsule.signal * share);
      planes.range_m[i] = static_cast<float>(hit.range_m);
    }
  }
}

}  // namespace glint::sim
