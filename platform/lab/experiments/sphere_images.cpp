#include "platform/lab/experiments/sphere_images.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/elementary.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/reflector.hpp"

namespace glint {
namespace {

constexpr int k_side_px = SphereImages::k_side_px;
constexpr double k_wall_m = 0.95;  // behind the spheres
// Off the axis in a direction along neither rows nor columns.
constexpr double k_azimuth_rad = 0.6;
constexpr double k_turn_rad = 6.28318530717958648;

// Moves the principal point, so that the ray at this angle from the axis meets the centre of the
// small frame.
SphereSetting centred(SphereSetting setting) {
  CameraModel& model = setting.camera.model;
  const SineCosine off = sine_cosine(setting.off_axis_rad), round = sine_cosine(k_azimuth_rad);
  const Vector3 ray(off.sine * round.cosine, off.sine * round.sine, off.cosine);
  const Result<Vector2> pixel = project(model, ray);
  if (!pixel) throw std::invalid_argument("the angle is outside the lens");
  model.cx += k_side_px / 2 - pixel.value.x();
  model.cy += k_side_px / 2 - pixel.value.y();
  model.width = model.height = k_side_px;
  return setting;
}

double uniform(std::uint64_t seed, std::uint64_t number, std::uint64_t which) {
  return sim::uniform({seed, sim::Stream::blob, which}, number);
}

}  // namespace

double range_of_diameter(double diameter_px, double focal_px, double radius_m) {
  const double tangent = 0.5 * diameter_px / focal_px;
  return radius_m * std::sqrt(1 + tangent * tangent) / tangent;
}

SphereImages::SphereImages(const SphereSetting& setting, std::uint64_t seed)
    : setting_(centred(setting)),
      seed_(seed),
      rays_(setting_.camera.model),
      sensor_(setting_.camera, setting_.noise, seed) {
  planes_.resize(k_side_px, k_side_px);
}

void SphereImages::draw_sphere(std::uint64_t number, const Vector2& pixel) {
  const CameraModel& model = setting_.camera.model;
  sim::Reflector sphere;
  sphere.centre = setting_.range_m * unproject(model, pixel).value;
  if (setting_.smear_px > 0) {
    const SineCosine way = sine_cosine(k_turn_rad * uniform(seed_, number, 2));
    const Vector2 half = 0.5 * setting_.smear_px * Vector2(way.cosine, way.sine);
    const Vector3 begin = unproject(model, pixel - half).value;
    const Vector3 end = unproject(model, pixel + half).value;
    sphere.travel = setting_.range_m * (end - begin);
  }
  const double spread = 2 * uniform(seed_, number, 3) - 1;
  sphere.radius_m = setting_.radius_m + setting_.radius_spread_m * spread;
  const double front_m = setting_.range_m - sphere.radius_m;
  sphere.signal = setting_.peak_counts * front_m * front_m / 0.25;  // peak_counts is that at 0.5 m
  sphere.limb = setting_.limb;
  sim::draw(sphere, model, rays_, {}, planes_);
}

SphereImages::Truth SphereImages::render(std::uint64_t number, FrameBuffer& out) {
  Truth truth;
  truth.centre_px =
      setting_.place_px + Vector2(uniform(seed_, number, 0), uniform(seed_, number, 1));
  truth.centre_m = setting_.range_m * unproject(setting_.camera.model, truth.centre_px).value;
  std::fill(planes_.signal.begin(), planes_.signal.end(),
            static_cast<float>(setting_.background_counts));
  std::fill(planes_.range_m.begin(), planes_.range_m.end(), static_cast<float>(k_wall_m));
  draw_sphere(number, truth.centre_px);
  if (setting_.second_offset_px.squaredNorm() > 0) {
    draw_sphere(number, truth.centre_px + setting_.second_offset_px);
  }
  sensor_.expose(planes_, rays_, static_cast<std::uint32_t>(number), out);
  return truth;
}

}  // namespace glint
