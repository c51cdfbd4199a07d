// The words of the dataflow language: what a graph takes and gives, and how a node's parameters say
// what it reads and writes.
//
//   const T&            this activation's token
//   T&                  the token that this node writes, whole, at every activation
//   const Previous<T>&  the last activation's token (T{} before the first)
//   const Latest<T>&    the newest version from another rate group (graph/latest.hpp)
//   const Parts<T, N>&  what the N copies of a Split wrote, in index order
//   Slice               which copy this is; only under Split
#pragma once

#include <cassert>
#include <cstddef>

namespace glint::graph {

// Keeps what two cores write on separate lines; 64 bytes on x86-64 and on the arm64 boards' cores.
inline constexpr std::size_t k_cache_line = 64;

// What is handed in before an activation, and what may be taken out after it.
template <class... T>
struct Inputs {};
template <class... T>
struct Outputs {};

// The last activation's token: feedback that is visible in the type.
template <class T>
class Previous {
 public:
  explicit Previous(const T& value) noexcept : value_(&value) {}
  explicit Previous(const T&& value) = delete;
  [[nodiscard]] const T& value() const noexcept { return *value_; }

 private:
  const T* value_;
};

// Which part of the data a copy works on: 0 <= index < count.
struct Slice {
  int index = 0;
  int count = 1;
};

// N copies of a node that may run side by side. Copy i writes part i of each of its outputs. N
// belongs to the graph and never depends on the number of workers: the result would change with it.
template <class Node, int N>
struct Split {
  static_assert(N >= 1, "a split needs at least one copy");
};

// The parts of a token, in index order.
template <class T, int N>
class Parts {
 public:
  static_assert(N >= 1, "a split has at least one part");
  [[nodiscard]] const T& operator[](int index) const noexcept {
    assert(index >= 0 && index < N);
    return cells_[index].value;
  }
  [[nodiscard]] T& operator[](int index) noexcept {
    assert(index >= 0 && index < N);
    return cells_[index].value;
  }
  [[nodiscard]] static constexpr int size() noexcept { return N; }

 private:
  struct alignas(k_cache_line) Cell {
    T value{};
  };
  Cell cells_[N]{};
};

}  // namespace glint::graph
