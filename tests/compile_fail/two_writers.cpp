// expect: TwoWriters<Runs
#include "tokens.hpp"

struct ThresholdToo {
  void operator()(const Frame&, Runs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs>, Threshold, ThresholdToo, FindBlobs>;
static_assert(valid<Tracker>);
