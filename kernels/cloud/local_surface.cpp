#include "kernels/cloud/local_surface.hpp"

#include <array>
#include <cmath>

#include "kernels/cloud/plane_sums.hpp"

namespace glint {
namespace {

// Relative pivot limit: a smaller pivot is rounding error of the float sums.
constexpr double k_pivot_min = 1e-6;

// exp(-t) for t in [0, 4]: eighth power of exp(-t / 8), by its Taylor series about t = 2.
FourFloats exp_negative(const FourFloats& t) {
  const FourFloats h = 0.25f - 0.125f * t;
  const FourFloats series =
      1 + h * (1 + h * (0.5f + h * (1.0f / 6 + h * (1.0f / 24 + h * (1.0f / 120)))));
  const FourFloats root = 0.7788007831f * series;  // exp(-1/4)
  const FourFloats two = root * root, four = two * two;
  return four * four;
}

PlaneSums plane_sums(const Neighbours& near) {
  FourFloats n{}, x{}, y{}, z{}, xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
  for (int i = 0; i < near.count; i += 4) {
    const FourFloats px = load_four(near.x + i), py = load_four(near.y + i),
                     pz = load_four(near.z + i);
    const FourFloats w = load_four(near.weight + i);
    const FourFloats wx = w * px, wy = w * py, wz = w * pz;
    n += w, x += wx, y += wy, z += wz;
    xx += wx * px, yy += wy * py, zz += wz * pz;
    xy += wx * py, xz += wx * pz, yz += wy * pz;
  }
  return {sum_of(n),  sum_of(x),  sum_of(y),  sum_of(z),  sum_of(xx),
          sum_of(yy), sum_of(zz), sum_of(xy), sum_of(xz), sum_of(yz)};
}

// Frame of the plane at the foot of the point. The unit of length along the plane is the radius.
struct LocalFrame {
  Vector3 u, v, normal;
  double height = 0;  // of the plane above the point, metres
};

// Upper triangle of the weighted normal equations, row by row, and their right side last. Order of
// the terms: uu, uv, vv, u, v, 1, so that back substitution starts with the required terms.
constexpr int k_terms = 6;
using Equations = std::array<std::array<double, k_terms + 1>, k_terms>;

Equations quadratic_equations(const Neighbours& near, const LocalFrame& frame, float radius_m) {
  const float scale = 1 / radius_m;
  const auto part = [scale](double axis) { return static_cast<float>(axis) * scale; };
  const FourFloats ux = broadcast_four(part(frame.u.x())), uy = broadcast_four(part(frame.u.y())),
                   uz = broadcast_four(part(frame.u.z())), vx = broadcast_four(part(frame.v.x())),
                   vy = broadcast_four(part(frame.v.y())), vz = broadcast_four(part(frame.v.z())),
                   nx = broadcast_four(part(frame.normal.x())),
                   ny = broadcast_four(part(frame.normal.y())),
                   nz = broadcast_four(part(frame.normal.z())),
                   height = broadcast_four(part(frame.height));
  FourFloats s00{}, s10{}, s01{}, s20{}, s11{}, s02{}, s30{}, s21{}, s12{}, s03{}, s40{}, s31{},
      s22{}, s13{}, s04{}, f00{}, f10{}, f01{}, f20{}, f11{}, f02{};
  for (int i = 0; i < near.count; i += 4) {
    const FourFloats x = load_four(near.x + i), y = load_four(near.y + i),
                     z = load_four(near.z + i);
    const FourFloats u = (x * ux + y * uy) + z * uz, v = (x * vx + y * vy) + z * vz;
    const FourFloats f = ((x * nx + y * ny) + z * nz) - height;
    const FourFloats uu = u * u, vv = v * v, uv = u * v;
    const FourFloats w = load_four(near.weight + i) * exp_negative((uu + vv) + f * f);
    const FourFloats wu = w * u, wv = w * v, wuu = w * uu, wuv = w * uv, wvv = w * vv;
    s00 += w, s10 += wu, s01 += wv, s20 += wuu, s11 += wuv, s02 += wvv;
    s30 += wuu * u, s21 += wuu * v, s12 += wvv * u, s03 += wvv * v;
    s40 += wuu * uu, s31 += wuu * uv, s22 += wuu * vv, s13 += wvv * uv, s04 += wvv * vv;
    f00 += w * f, f10 += wu * f, f01 += wv * f, f20 += wuu * f, f11 += wuv * f, f02 += wvv * f;
  }
  const double uu = sum_of(s20), uv = sum_of(s11), vv = sum_of(s02), uuv = sum_of(s21),
               uvv = sum_of(s12), uuvv = sum_of(s22), uuuv = sum_of(s31), uvvv = sum_of(s13);
  return {{{sum_of(s40), uuuv, uuvv, sum_of(s30), uuv, uu, sum_of(f20)},
           {0, uuvv, uvvv, uuv, uvv, uv, sum_of(f11)},
           {0, 0, sum_of(s04), uvv, sum_of(s03), vv, sum_of(f02)},
           {0, 0, 0, uu, uv, sum_of(s10), sum_of(f10)},
           {0, 0, 0, 0, vv, sum_of(s01), sum_of(f01)},
           {0, 0, 0, 0, 0, sum_of(s00), sum_of(f00)}}};
}

// Height of the quadratic surface and its slopes along u and v at the foot of the point, in radii.
struct QuadraticSurface {
  double height = 0, along_u = 0, along_v = 0;
  bool found = false;
};

// LDL' factorisation applied to the right side (Golub and Van Loan 2013, algorithm 4.1.2).
QuadraticSurface solve(Equations& rows) {
  for (std::size_t k = 0; k < k_terms; ++k) {
    const double first = rows[k][k];
    if (k + 1 == k_terms) break;
    const double inverse = 1 / first;
    for (std::size_t r = k + 1; r < k_terms; ++r) {
      const double part = rows[k][r] * inverse;
      const double least = k_pivot_min * rows[r][r];
      for (std::size_t c = r; c <= k_terms; ++c) rows[r][c] -= part * rows[k][c];
      if (!(rows[r][r] > least)) return {};
    }
  }
  QuadraticSurface out;
  out.height = rows[5][6] / rows[5][5];
  out.along_v = (rows[4][6] - rows[4][5] * out.height) / rows[4][4];
  out.along_u = (rows[3][6] - rows[3][5] * out.height - rows[3][4] * out.along_v) / rows[3][3];
  out.found = std::isfinite(out.height) && std::isfinite(out.along_u + out.along_v);
  return out;
}

Vector3 oriented_up(const Vector3& n) {
  const double first = n.z() != 0 ? n.z() : (n.y() != 0 ? n.y() : n.x());
  return first < 0 ? Vector3(-n) : n;
}

}  // namespace

SurfacePoint local_surface(const Neighbours& near, float radius_m) noexcept {
  for (int i = near.count; i < near.count + k_four_padding; ++i)
    near.x[i] = near.y[i] = near.z[i] = near.weight[i] = 0;
  const FittedPlane plane = fit_plane(plane_sums(near));
  const auto [u, v] = orthonormal_basis(plane.normal);
  const LocalFrame frame{u, v, plane.normal, plane.mean.dot(plane.normal)};
  SurfacePoint out;
  out.offset_m = frame.height * frame.normal;
  out.normal = oriented_up(frame.normal);
  if (near.count < k_quadratic_neighbours_min) return out;
  Equations equations = quadratic_equations(near, frame, radius_m);
  const QuadraticSurface quadratic = solve(equations);
  const double radius = static_cast<double>(radius_m);
  const double height = frame.height + quadratic.height * radius;
  if (!quadratic.found || !(std::abs(height) <= radius)) return out;
  out.offset_m = height * frame.normal;
  const Vector3 across = frame.normal - quadratic.along_u * u - quadratic.along_v * v;
  out.normal = oriented_up(across / std::sqrt(across.squaredNorm()));
  out.on_polynomial = true;
  return out;
}

}  // namespace glint
