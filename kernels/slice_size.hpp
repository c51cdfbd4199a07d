// How much a kernel that works in slices may do in one call.
//
// Items (points, tries) are what a caller counts by who wants no bound. Steps are for one who does:
// a step is about the work of one distance between two points, four of them computed at once, and
// other work is charged as many. No item is begun once the steps are used up; the last one may go
// beyond them by what one item takes at most.
#pragma once

namespace glint {

struct SliceSize {
  static constexpr int k_steps_max = 1 << 30;

  // At least one of both. NOLINTNEXTLINE(google-explicit-constructor): a number of items is a size.
  constexpr SliceSize(int most_items, int most_steps = k_steps_max) noexcept
      : items(most_items < 1 ? 1 : most_items), steps(most_steps < 1 ? 1 : most_steps) {}

  // At most so many items that take so many steps each; at least one.
  [[nodiscard]] constexpr int items_of(int steps_each) const noexcept {
    const int whole = steps / steps_each;
    return whole < 1 ? 1 : (whole < items ? whole : items);
  }

  int items;
  int steps;
};

// The steps of a slice, as they are used up.
class StepBudget {
 public:
  explicit constexpr StepBudget(int steps = SliceSize::k_steps_max) noexcept : left_(steps) {}
  void take(int steps) noexcept { left_ -= steps; }
  [[nodiscard]] bool spent() const noexcept { return left_ <= 0; }
  // Below 0 by what the last item took beyond it.
  [[nodiscard]] int left() const noexcept { return left_; }
  // The first of [from, end) that is not to be done now, where each takes so many steps or fewer;
  // takes them.
  [[nodiscard]] int end_of(int from, int end, int steps_each) noexcept {
    const int items = SliceSize(SliceSize::k_steps_max, left_).items_of(steps_each);
    const int done = end - from < items ? end - from : items;
    take(done * steps_each);
    return from + done;
  }

 private:
  int left_;
};

}  // namespace glint
