// Budget shared by several consumers. Each consumer may spend all that remains except the equal
// shares reserved for the consumers after it.
#pragma once

namespace glint {

class SharedBudget {
 public:
  // Budget: share * consumers_max. `consumers` (at most consumers_max) consumers spend from it.
  SharedBudget(int share, int consumers_max, int consumers)
      : left_(share * consumers_max), share_(share), consumers_left_(consumers) {}

  // Call once per consumer, before it spends.
  [[nodiscard]] int next_max() {
    --consumers_left_;
    return left_ - share_ * consumers_left_;
  }
  void spend(int amount) { left_ -= amount; }
  [[nodiscard]] int left() const { return left_; }

 private:
  int left_, share_, consumers_left_;
};

}  // namespace glint
