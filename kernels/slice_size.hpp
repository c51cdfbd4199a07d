// Work limit of one call of a kernel that works in slices: a number of items, a number of steps, or
// both.
//
// Items (points, tries) suit a caller that needs no bound on time; steps suit one that does. A step
// is about the cost of one distance between two points, computed four at once; other work counts as
// a multiple of it. No item starts after the steps are used up. The last item may exceed them by at
// most the cost of one item.
#pragma once

namespace glint {

struct SliceSize {
  static constexpr int k_steps_max = 1 << 30;

  // Both are raised to at least 1.
  // NOLINTNEXTLINE(google-explicit-constructor): a number of items is a size.
  constexpr SliceSize(int items_max, int steps_max = k_steps_max) noexcept
      : items(items_max < 1 ? 1 : items_max), steps(steps_max < 1 ? 1 : steps_max) {}

  // Number of items that fit when each takes `steps_each`; at least one.
  [[nodiscard]] constexpr int items_of(int steps_each) const noexcept {
    const int fitting = steps / steps_each;
    return fitting < 1 ? 1 : (fitting < items ? fitting : items);
  }

  int items;
  int steps;
};

// Remaining steps of a slice.
class StepBudget {
 public:
  explicit constexpr StepBudget(int steps = SliceSize::k_steps_max) noexcept : left_(steps) {}
  void take(int steps) noexcept { left_ -= steps; }
  [[nodiscard]] bool spent() const noexcept { return left_ <= 0; }
  // Negative: excess of the last item.
  [[nodiscard]] int left() const noexcept { return left_; }
  // Takes the steps of as many items of [from, end) as fit, at most steps_each per item. Returns
  // the first item that does not fit.
  [[nodiscard]] int take_items(int from, int end, int steps_each) noexcept {
    const int items = SliceSize(SliceSize::k_steps_max, left_).items_of(steps_each);
    const int done = end - from < items ? end - from : items;
    take(done * steps_each);
    return from + done;
  }

 private:
  int left_;
};

}  // namespace glint
