// Test graph with two splits of different width and a feedback edge. Its sums depend on every node.
#pragma once

#include <array>

#include "graph/graph.hpp"

namespace glint::test {

using namespace glint::graph;

struct Wide {
  std::array<double, 64> values{};
};
struct Narrow {
  std::array<double, 64> values{};
};
struct Partial {
  double sum = 0;
};
struct Result {
  double sum = 0.1;
  std::array<double, 64> values{};
};
struct Spread {
  void operator()(const Narrow& in, const Previous<Result>& last, Partition s, Wide& out) noexcept {
    for (std::size_t i = static_cast<std::size_t>(s.index); i < 64; i += 5) {
      out.values[i] = in.values[i] * (1.0 + last.value().sum) / (3.0 + s.index);
    }
  }
};
struct SumUp {
  void operator()(const Parts<Wide, 5>& in, Partition s, Partial& out) noexcept {
    out.sum = 0;
    for (int part = 0; part < 5; ++part) {
      for (std::size_t i = static_cast<std::size_t>(s.index); i < 64; i += 3) {
        out.sum += in[part].values[i];
      }
    }
  }
};
struct Make {
  int n = 0;
  void operator()(Narrow& out) noexcept {
    ++n;
    for (std::size_t i = 0; i < 64; ++i) {
      out.values[i] = 1.0 / (1.0 + static_cast<double>(i) * n);
    }
  }
};
struct Merge {
  void operator()(const Parts<Partial, 3>& sums, const Narrow& in, Result& out) noexcept {
    out.values = in.values;
    out.sum = 0;
    for (int i = 0; i < 3; ++i) out.sum += sums[i].sum;
  }
};
using WideGraph = Graph<Inputs<>, Outputs<Result>, Merge, Split<SumUp, 3>, Split<Spread, 5>, Make>;
static_assert(valid<WideGraph>);

}  // namespace glint::test
