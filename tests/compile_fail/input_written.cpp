// expect: TwoWriters<Runs
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame, Runs>, Outputs<Blobs>, Threshold, FindBlobs>;
static_assert(valid<Tracker>);
