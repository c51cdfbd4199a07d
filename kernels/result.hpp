// A value or the reason why there is none.
#pragma once

#include "kernels/reason.hpp"

namespace glint {

template <class T>
struct Result {
  T value{};
  Reason reason = Reason::none;
  [[nodiscard]] explicit operator bool() const { return reason == Reason::none; }
};

}  // namespace glint
