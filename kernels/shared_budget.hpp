// Budget shared by several consumers. Each consumer may spend all that remains except the equal
// shares reserved for the consumers after it.
#pragma once

namespace glint {

class SharedBudget {
 public:
  // Budget: share * takers_max. `takers` (at most takers_max) consumers spend from it.
  SharedBudget(int share, int takers_max, int takers)
      : left_(share * takers_max), share_(share), takers_left_(takers) {}

  // Call once per consumer, before it spends.
  [[nodiscard]] int most_for_next() {
    --takers_left_;
    return left_ - share_ * takers_left_;
  }
  void spend(int amount) { left_ -= amount; }
  [[nodiscard]] int left() const { return left_; }

 private:
  int left_, share_, takers_left_;
};

}  // namespace glint
