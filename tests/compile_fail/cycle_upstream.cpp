// expect: Cycle<Estimates, Feeds
#include "tokens.hpp"

// Estimate and its successor only depend on the cycle; the message must name the cycle itself.
struct Feeds {
  void operator()(const Frame&, const Estimates&, Estimates&) noexcept {}
};
struct Shows {
  void operator()(const Estimates&, Blobs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs>, Shows, Feeds>;
static_assert(valid<Tracker>);
