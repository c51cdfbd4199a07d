// Test graph with one of each kind of edge, listed out of execution order: sums a row of numbers in
// two bands and keeps a running total.
#pragma once

#include <array>

#include "graph/graph.hpp"

namespace glint::test {

using namespace glint::graph;

struct Row {
  std::array<int, 8> numbers{};
};
struct Scale {
  int factor = 1;
};
struct Scaled {
  std::array<int, 8> numbers{};
};
struct Sum {
  int value = 0;
};
struct Total {
  int value = 0;
  int activations = 0;
};
enum class Ready { yes = 0, no_offset = 7 };

struct ScaleRow {
  int offset = 0;
  Ready prepare() const { return offset < 0 ? Ready::no_offset : Ready::yes; }
  void operator()(const Row& row, const Latest<Scale>& scale, Scaled& scaled) const noexcept {
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
      scaled.numbers[i] = row.numbers[i] * scale.value().factor + offset;
    }
  }
};

struct SumBand {
  int calls = 0;
  void operator()(const Scaled& scaled, Partition partition, Sum& sum) noexcept {
    ++calls;
    const int size = static_cast<int>(scaled.numbers.size());
    sum.value = 0;
    for (int i = partition.index * size / partition.count;
         i < (partition.index + 1) * size / partition.count; ++i) {
      sum.value += scaled.numbers[static_cast<std::size_t>(i)];
    }
  }
};

struct AddUp {
  void operator()(const Parts<Sum, 2>& sums, const Previous<Total>& last,
                  Total& total) const noexcept {
    total = last.value();
    for (int i = 0; i < Parts<Sum, 2>::size(); ++i) total.value += sums[i].value;
    ++total.activations;
  }
};

using SmallGraph =
    Graph<Inputs<Row, Latest<Scale>>, Outputs<Total>, AddUp, Split<SumBand, 2>, ScaleRow>;
static_assert(valid<SmallGraph>);

}  // namespace glint::test
