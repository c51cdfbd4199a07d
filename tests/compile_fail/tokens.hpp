// Tokens and correct nodes that the cases share.
#pragma once

#include "graph/graph.hpp"

using namespace glint::graph;

struct Frame {};
struct Runs {};
struct Blobs {};
struct Estimates {};
struct ToolSet {};

struct Threshold {
  void operator()(const Frame&, Runs&) noexcept {}
};
struct ThresholdBand {
  void operator()(const Frame&, Partition, Runs&) noexcept {}
};
struct FindBlobs {
  void operator()(const Runs&, Blobs&) noexcept {}
};
struct Estimate {
  void operator()(const Blobs&, Estimates&) noexcept {}
};
