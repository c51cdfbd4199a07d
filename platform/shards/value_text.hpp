// Text of any value made of numbers, enumerations, strings, fixed Eigen matrices, vectors, arrays
// and plain structs of these. Reading it back gives equal bits (a NaN stays a NaN).
//
// A struct needs no declaration: its fields are counted by aggregate initialisation and visited by
// structured bindings, at most k_fields_max of them. A struct with a constructor, a private field
// or an optional does not compile.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "platform/input_error.hpp"

namespace glint {

inline constexpr std::size_t k_fields_max = 14;

namespace value_text {

// Converts to the type of any field.
struct AnyField {
  template <class T>
  constexpr operator T() const noexcept;
};

template <class T, class... Fields>
consteval std::size_t field_count() {
  if constexpr (requires { T{Fields{}..., AnyField{}}; }) {
    return field_count<T, Fields..., AnyField>();
  } else {
    return sizeof...(Fields);
  }
}

template <class T>
concept FixedMatrix = requires(T& value) {
  T::SizeAtCompileTime;
  value.data();
};

template <class T>
concept Resizable = requires(T& value) {
  value.resize(std::size_t{});
  value.begin();
};

template <class T>
concept FixedArray = !Resizable<T> && requires(T & value) {
  value.begin();
};

// Calls visit(field) for each field, in order.
template <class T, class Visit>
void visit_fields(T& value, const Visit& visit) {
  constexpr std::size_t count = field_count<std::remove_const_t<T>>();
  static_assert(count > 0 && count <= k_fields_max, "a plain struct of 1 to 14 fields");
  const auto all = [&](auto&... fields) { (visit(fields), ...); };
  if constexpr (count == 1) {
    auto& [a] = value;
    all(a);
  } else if constexpr (count == 2) {
    auto& [a, b] = value;
    all(a, b);
  } else if constexpr (count == 3) {
    auto& [a, b, c] = value;
    all(a, b, c);
  } else if constexpr (count == 4) {
    auto& [a, b, c, d] = value;
    all(a, b, c, d);
  } else if constexpr (count == 5) {
    auto& [a, b, c, d, e] = value;
    all(a, b, c, d, e);
  } else if constexpr (count == 6) {
    auto& [a, b, c, d, e, f] = value;
    all(a, b, c, d, e, f);
  } else if constexpr (count == 7) {
    auto& [a, b, c, d, e, f, g] = value;
    all(a, b, c, d, e, f, g);
  } else if constexpr (count == 8) {
    auto& [a, b, c, d, e, f, g, h] = value;
    all(a, b, c, d, e, f, g, h);
  } else if constexpr (count == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = value;
    all(a, b, c, d, e, f, g, h, i);
  } else if constexpr (count == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = value;
    all(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (count == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
    all(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (count == 12) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l);
  } else if constexpr (count == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  }
}

}  // namespace value_text

// Appends the value's text: words, each followed by a space. A string is its length and its bytes.
template <class T>
void append_value(const T& value, std::string& text) {
  if constexpr (std::is_same_v<T, bool>) {
    text += value ? "1 " : "0 ";
  } else if constexpr (std::is_enum_v<T>) {
    append_value(static_cast<std::int64_t>(value), text);
  } else if constexpr (std::is_arithmetic_v<T>) {
    std::array<char, 32> word;  // the shortest text that reads back as this number
    const auto end = std::to_chars(word.data(), word.data() + word.size(), value);
    text.append(word.data(), end.ptr);
    text += ' ';
  } else if constexpr (std::is_same_v<T, std::string>) {
    append_value(value.size(), text);
    text += value;
    text += ' ';
  } else if constexpr (value_text::FixedMatrix<T>) {
    static_assert(T::SizeAtCompileTime > 0);
    for (int i = 0; i < T::SizeAtCompileTime; ++i) append_value(value.data()[i], text);
  } else if constexpr (value_text::Resizable<T>) {
    append_value(value.size(), text);
    for (const auto& item : value) append_value(item, text);
  } else if constexpr (value_text::FixedArray<T>) {
    for (const auto& item : value) append_value(item, text);
  } else {
    value_text::visit_fields(value, [&](const auto& field) { append_value(field, text); });
  }
}

// Reads values in the order in which they were appended. `place` begins each error message.
class ValueReader {
 public:
  ValueReader(std::string_view text, std::string place) : rest_(text), place_(std::move(place)) {}

  // Throws InputError if the text holds another value.
  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = next<int>() != 0;
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(next<std::int64_t>());
    } else if constexpr (std::is_arithmetic_v<T>) {
      const auto end = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
      if (end.ec != std::errc{}) fail();
      rest_.remove_prefix(static_cast<std::size_t>(end.ptr - rest_.data()));
      skip_space();
    } else if constexpr (std::is_same_v<T, std::string>) {
      const auto size = next<std::size_t>();
      if (size > rest_.size()) fail();
      value = rest_.substr(0, size);
      rest_.remove_prefix(size);
      skip_space();
    } else if constexpr (value_text::FixedMatrix<T>) {
      for (int i = 0; i < T::SizeAtCompileTime; ++i) read(value.data()[i]);
    } else if constexpr (value_text::Resizable<T>) {
      const auto size = next<std::size_t>();
      if (size > rest_.size()) fail();  // an item has one byte or more
      value.resize(size);
      for (auto& item : value) read(item);
    } else if constexpr (value_text::FixedArray<T>) {
      for (auto& item : value) read(item);
    } else {
      value_text::visit_fields(value, [&](auto& field) { read(field); });
    }
  }
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }
  // Throws InputError if text is left.
  void end() const {
    if (!rest_.empty()) fail();
  }

 private:
  template <class T>
  T next() {
    T value{};
    read(value);
    return value;
  }
  void skip_space() {
    if (rest_.empty() || rest_.front() != ' ') fail();
    rest_.remove_prefix(1);
  }
  [[noreturn]] void fail() const {
    throw InputError(place_ + ": other values; expected those that this command writes");
  }

  std::string_view rest_;
  std::string place_;
};

}  // namespace glint
