// Pairs the images of two topics by time stamp: an image waits for the one of the other topic that
// is nearest in time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

enum class ImageKind : std::uint8_t { reflectivity, depth };

// No heap after the constructor, unless moving an Image allocates.
template <class Image>
class StampPairs {
 public:
  // apart_max: largest difference of stamps of a pair. waiting_max: capacity of waiting images per
  // topic.
  StampPairs(Duration apart_max, std::size_t waiting_max)
      : apart_max_(apart_max), waiting_max_(waiting_max) {
    for (auto& waiting : waiting_) waiting.reserve(waiting_max + 1);
  }

  // Removes and returns the waiting image that pairs with one of this kind; empty if none.
  [[nodiscard]] std::optional<Image> partner_of(ImageKind kind, Time stamp) {
    std::vector<Waiting>& others =
        waiting_of(kind == ImageKind::depth ? ImageKind::reflectivity : ImageKind::depth);
    const auto distance = [&](const Waiting& other) {
      const std::int64_t ns = (other.stamp - stamp).nanoseconds;
      return ns < 0 ? -ns : ns;
    };
    const auto nearest = std::min_element(
        others.begin(), others.end(),
        [&](const Waiting& a, const Waiting& b) { return distance(a) < distance(b); });
    if (nearest == others.end() || distance(*nearest) > apart_max_.nanoseconds) return {};
    std::optional<Image> partner(std::move(nearest->image));
    others.erase(nearest);
    return partner;
  }

  // Stores an image; beyond the capacity removes and returns the oldest one.
  [[nodiscard]] std::optional<Image> wait(ImageKind kind, Time stamp, Image image) {
    waiting_of(kind).push_back({stamp, std::move(image)});
    return waiting(kind) > waiting_max_ ? pop(kind) : std::nullopt;
  }

  [[nodiscard]] std::size_t waiting(ImageKind kind) const {
    return waiting_[static_cast<std::size_t>(kind)].size();
  }
  // Removes and returns the oldest one.
  [[nodiscard]] std::optional<Image> pop(ImageKind kind) {
    std::vector<Waiting>& own = waiting_of(kind);
    if (own.empty()) return {};
    std::optional<Image> oldest(std::move(own.front().image));
    own.erase(own.begin());
    return oldest;
  }

 private:
  struct Waiting {
    Time stamp;
    Image image;
  };
  [[nodiscard]] std::vector<Waiting>& waiting_of(ImageKind kind) {
    return waiting_[static_cast<std::size_t>(kind)];
  }

  Duration apart_max_;
  std::size_t waiting_max_;
  std::vector<Waiting> waiting_[2];  // by kind, in the order of arrival
};

}  // namespace glint
