// expect: WrongPartsCount<glint::graph::Parts<Runs, 3>, MergeThree
#include "tokens.hpp"

struct MergeThree {
  void operator()(const Parts<Runs, 3>&, Blobs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs>, Split<ThresholdBand, 2>, MergeThree>;
static_assert(valid<Tracker>);
