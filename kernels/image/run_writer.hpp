// Appends runs to a buffer, joining those that touch; what finds it full is counted.
#pragma once

#include "kernels/image/run.hpp"

namespace glint {

class RunWriter {
 public:
  explicit RunWriter(Runs& out) : out_(out) {
    out.count = 0;
    out.dropped = 0;
    out.reason = Reason::none;
  }
  ~RunWriter() { flush(); }
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  // In row order, then from left to right; x0 < x1.
  void add(int y, int x0, int x1) {
    if (open_.x1 == x0 && open_.y == y && open_.x1 > open_.x0) {
      open_.x1 = static_cast<std::uint16_t>(x1);
      return;
    }
    flush();
    open_ = {static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(x0),
             static_cast<std::uint16_t>(x1)};
  }

 private:
  void flush() {
    if (open_.x1 == open_.x0) return;
    if (out_.count < k_runs_per_band_max) {
      out_.items[static_cast<std::size_t>(out_.count++)] = open_;
    } else {
      ++out_.dropped;
      out_.reason = Reason::runs_full;
    }
  }

  Runs& out_;
  Run open_{};  // may still grow
};

}  // namespace glint
