// Arena allocator and typed array in memory that the caller owns; the core itself allocates
// nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace glint {

// Bump allocator over one buffer. The buffer must outlive everything taken from it.
class Arena {
 public:
  static constexpr std::size_t k_alignment = 64;  // a cache line

  explicit Arena(std::span<std::byte> memory) noexcept : rest_(memory) {
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    skip((k_alignment - address % k_alignment) % k_alignment);
  }
  [[nodiscard]] static constexpr std::size_t rounded(std::size_t bytes) noexcept {
    return (bytes + k_alignment - 1) / k_alignment * k_alignment;
  }
  // Returns zeroed memory, or nullptr if too little is left.
  [[nodiscard]] std::byte* take(std::size_t bytes) noexcept {
    if (rest_.size() < rounded(bytes)) return nullptr;
    std::byte* const taken = rest_.data();
    std::memset(taken, 0, bytes);
    skip(rounded(bytes));
    return taken;
  }

 private:
  void skip(std::size_t bytes) noexcept {
    rest_ = rest_.last(rest_.size() - std::min(bytes, rest_.size()));
  }
  std::span<std::byte> rest_;
};

template <class T>
class Column {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  // Bytes that reserve() takes from an arena.
  [[nodiscard]] static constexpr std::size_t bytes(int count) noexcept {
    return Arena::rounded(static_cast<std::size_t>(count) * sizeof(T));
  }
  // Zeroes the values. Returns false if the arena has too little left.
  [[nodiscard]] bool reserve(int count, Arena& arena) noexcept {
    values_ = reinterpret_cast<T*>(arena.take(static_cast<std::size_t>(count) * sizeof(T)));
    return values_ != nullptr;
  }
  [[nodiscard]] T* data() noexcept { return values_; }
  [[nodiscard]] const T* data() const noexcept { return values_; }
  [[nodiscard]] T& operator[](int i) noexcept { return values_[i]; }
  [[nodiscard]] const T& operator[](int i) const noexcept { return values_[i]; }

 private:
  T* values_ = nullptr;
};

}  // namespace glint
