#include "cloud_agreement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace glint::bench {
namespace {

using Cell = std::array<int, 3>;

Cell cell_of(const float* point, float size) {
  Cell cell;
  for (std::size_t i = 0; i < 3; ++i) {
    cell[i] = static_cast<int>(std::floor(point[i] * (1 / size)));
  }
  return cell;
}

double distance(const float* a, const float* b) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    square += d * d;
  }
  return std::sqrt(square);
}

Agreement summary(std::vector<double> distances, std::size_t of) {
  Agreement out;
  if (distances.empty() || of == 0) return out;
  std::sort(distances.begin(), distances.end());
  out.share = static_cast<double>(distances.size()) / static_cast<double>(of);
  out.p99_m = distances[distances.size() * 99 / 100];
  out.max_m = distances.back();
  return out;
}

constexpr float k_search_m = 0.01f;

// Index of the nearest point of `to` within k_search_m for each point of `from`, or -1.
std::vector<int> nearest(const std::vector<float>& from, const std::vector<float>& to) {
  std::map<Cell, std::vector<int>> cells;
  for (std::size_t i = 0; 3 * i < to.size(); ++i) {
    cells[cell_of(&to[3 * i], k_search_m)].push_back(static_cast<int>(i));
  }
  std::vector<int> out;
  for (std::size_t i = 0; 3 * i < from.size(); ++i) {
    const float* const point = &from[3 * i];
    const Cell middle = cell_of(point, k_search_m);
    int best = -1;
    double least = static_cast<double>(k_search_m);
    for (int step = 0; step < 27; ++step) {
      const auto found = cells.find(
          {middle[0] + step % 3 - 1, middle[1] + step / 3 % 3 - 1, middle[2] + step / 9 - 1});
      if (found == cells.end()) continue;
      for (const int j : found->second) {
        const double d = distance(point, &to[3 * static_cast<std::size_t>(j)]);
        if (d < least) {
          least = d;
          best = j;
        }
      }
    }
    out.push_back(best);
  }
  return out;
}

}  // namespace

Agreement agreement_of(const std::vector<float>& a, const std::vector<float>& b, double within_m) {
  const std::vector<int> forth = nearest(a, b), back = nearest(b, a);
  std::vector<double> distances;
  for (std::size_t i = 0; i < forth.size(); ++i) {
    if (forth[i] < 0) continue;
    const auto j = static_cast<std::size_t>(forth[i]);
    const double d = distance(&a[3 * i], &b[3 * j]);
    if (back[j] == static_cast<int>(i) && d <= within_m) distances.push_back(d);
  }
  return summary(std::move(distances), std::max(a.size(), b.size()) / 3);
}

}  // namespace glint::bench
