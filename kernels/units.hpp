// Time and duration types: int64 counts of nanoseconds that do not mix with plain numbers. Every
// other quantity inside Glint is SI in double: metres, radians, seconds.
#pragma once

#include <compare>
#include <cstdint>

namespace glint {

struct Duration {
  std::int64_t nanoseconds = 0;
  constexpr auto operator<=>(const Duration&) const = default;
  [[nodiscard]] constexpr double seconds() const { return static_cast<double>(nanoseconds) * 1e-9; }
};

// Time on the companion computer's monotonic clock (in a simulation: since its start).
struct Time {
  std::int64_t nanoseconds = 0;
  constexpr auto operator<=>(const Time&) const = default;
};

constexpr Duration operator-(Time a, Time b) { return {a.nanoseconds - b.nanoseconds}; }
constexpr Time operator+(Time a, Duration b) { return {a.nanoseconds + b.nanoseconds}; }
constexpr Time operator-(Time a, Duration b) { return {a.nanoseconds - b.nanoseconds}; }
constexpr Duration operator+(Duration a, Duration b) { return {a.nanoseconds + b.nanoseconds}; }
constexpr Duration operator-(Duration a, Duration b) { return {a.nanoseconds - b.nanoseconds}; }
constexpr Duration operator*(Duration a, std::int64_t n) { return {a.nanoseconds * n}; }

constexpr Duration milliseconds(std::int64_t n) { return {n * 1'000'000}; }
constexpr Duration microseconds(std::int64_t n) { return {n * 1'000}; }

}  // namespace glint
