// expect: Cycle<Runs, FindBlobs
#include "tokens.hpp"

struct NeedsBlobs {
  void operator()(const Frame&, const Blobs&, Runs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Estimates>, Estimate, NeedsBlobs, FindBlobs>;
static_assert(valid<Tracker>);
