#include "kernels/motion/singer.hpp"

#include "kernels/elementary.hpp"

namespace glint {
namespace {

// Below this x the closed form loses digits; the series' next term is 3e-15 of the sum there.
constexpr double k_small = 0.1;

struct Response {
  double place;         // position, s^2, by a unit acceleration at the start of the step
  double speed;         // velocity, s
  double acceleration;  // remaining fraction
};

Response response(double damping, double seconds) {
  const double x = damping * seconds;
  double second = 0;  // (x - 1 + exp(-x)) / x^2
  if (x < k_small) {
    second = 1.0 / 3628800.0;
    second = 1.0 / 362880.0 - x * second;
    second = 1.0 / 40320.0 - x * second;
    second = 1.0 / 5040.0 - x * second;
    second = 1.0 / 720.0 - x * second;
    second = 1.0 / 120.0 - x * second;
    second = 1.0 / 24.0 - x * second;
    second = 1.0 / 6.0 - x * second;
    second = 0.5 - x * second;
  } else {
    second = (x - 1.0 + exponential(-x)) / (x * x);
  }
  const double first = 1.0 - x * second;  // (1 - exp(-x)) / x
  return {seconds * seconds * second, seconds * first, 1.0 - x * first};
}

constexpr double k_nodes[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                               0.93056815579702629};
constexpr double k_weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};

}  // namespace

SingerStep singer_step(double damping_1_s, double seconds) noexcept {
  const Response whole = response(damping_1_s, seconds);
  SingerStep step{seconds, whole.place, whole.speed, whole.acceleration, Matrix3::Zero()};
  for (int i = 0; i < 4; ++i) {
    const Response part = response(damping_1_s, k_nodes[i] * seconds);
    const Vector3 g(part.place, part.speed, part.acceleration);
    step.noise += (k_weights[i] * seconds) * (g * g.transpose());
  }
  return step;
}

}  // namespace glint
