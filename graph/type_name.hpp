// Name of a type as in the source, without its namespaces. Equal on g++ and clang++ for named types
// that are not templates (pretty-printed template arguments differ).
#pragma once

#include <string_view>

namespace glint::graph {

namespace detail {

template <class T>
[[nodiscard]] consteval auto pretty() {
  return std::string_view(__PRETTY_FUNCTION__);
}

// g++:     consteval auto glint::graph::detail::pretty() [with T = glint::Blobs]
// clang++: auto glint::graph::detail::pretty() [T = glint::Blobs]
[[nodiscard]] consteval std::string_view unqualified(std::string_view text) {
  text.remove_prefix(text.find("T = ") + 4);
  text = text.substr(0, text.find_first_of(";]"));
  const std::size_t arguments = text.find('<');
  const std::size_t colons = text.substr(0, arguments).rfind("::");
  return colons == std::string_view::npos ? text : text.substr(colons + 2);
}

}  // namespace detail

template <class T>
[[nodiscard]] consteval std::string_view type_name() {
  return detail::unqualified(detail::pretty<T>());
}

}  // namespace glint::graph
