// Compile-time lists of types: the operations that a graph's wiring needs.
#pragma once

#include <type_traits>
#include <utility>

namespace glint::graph {

template <class... T>
struct TypeList {
  static constexpr int size = sizeof...(T);
};

// Index of T in the list; -1 if absent.
template <class T, class... U>
[[nodiscard]] consteval int index_of(TypeList<U...> /*list*/) {
  int index = -1;
  int i = 0;
  ((index = (index < 0 && std::is_same_v<T, U>) ? i : index, ++i), ...);
  return index;
}

namespace detail {

template <int index, class T>
struct Indexed {};

template <class Sequence, class... T>
struct IndexedList;
template <int... index, class... T>
struct IndexedList<std::integer_sequence<int, index...>, T...> : Indexed<index, T>... {};

template <int index, class T>
std::type_identity<T> pick(const Indexed<index, T>*);

template <class List>
struct Pick;
template <class... T>
struct Pick<TypeList<T...>> {
  using Table = IndexedList<std::make_integer_sequence<int, sizeof...(T)>, T...>;
};

template <class Result, class... T>
struct UniqueStep {
  using Type = Result;
};
template <class... Kept, class First, class... Rest>
struct UniqueStep<TypeList<Kept...>, First, Rest...>
    : UniqueStep<std::conditional_t<(std::is_same_v<Kept, First> || ...), TypeList<Kept...>,
                                    TypeList<Kept..., First>>,
                 Rest...> {};

template <class... Lists>
struct JoinStep {
  using Type = TypeList<>;
};
template <class... T>
struct JoinStep<TypeList<T...>> {
  using Type = TypeList<T...>;
};
template <class... T, class... U, class... Rest>
struct JoinStep<TypeList<T...>, TypeList<U...>, Rest...> : JoinStep<TypeList<T..., U...>, Rest...> {
};

template <class List>
struct UniqueOf;
template <class... T>
struct UniqueOf<TypeList<T...>> : UniqueStep<TypeList<>, T...> {};

}  // namespace detail

// The type at an index, 0 <= index < size.
template <int index, class List>
using At = typename decltype(detail::pick<index>(
    static_cast<typename detail::Pick<List>::Table*>(nullptr)))::type;

// Concatenation of all lists.
template <class... Lists>
using Join = typename detail::JoinStep<Lists...>::Type;

// The list without repetitions; keeps the first of equal types.
template <class List>
using Unique = typename detail::UniqueOf<List>::Type;

// Calls f.operator()<0>() to f.operator()<n - 1>(), in this order.
template <int n, class F>
constexpr void for_each_index(F&& f) {
  const auto call = [&]<int... i>(std::integer_sequence<int, i...>) {
    (f.template operator()<i>(), ...);
  };
  call(std::make_integer_sequence<int, n>{});
}

}  // namespace glint::graph
