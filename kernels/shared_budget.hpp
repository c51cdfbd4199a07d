// What several takers share: each may have its equal part, and more where enough is left over when
// those that come after have theirs.
#pragma once

namespace glint {

class SharedBudget {
 public:
  // A share for each of `takers_max`, of which `takers` come.
  SharedBudget(int share, int takers_max, int takers)
      : left_(share * takers_max), share_(share), takers_left_(takers) {}

  // To be called once for each taker, before it spends.
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
