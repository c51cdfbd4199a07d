// expect: Cycle<Estimates, Feeds
#include "tokens.hpp"

// Estimate and the node behind it only wait for the cycle; the message must name the cycle itself.
struct Feeds {
  void operator()(const Frame&, const Estimates&, Estimates&) noexcept {}
};
struct Shows {
  void operator()(const Estimates&, Blobs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs>, Shows, Feeds>;
static_assert(valid<Tracker>);
