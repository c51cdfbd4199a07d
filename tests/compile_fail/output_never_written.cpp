// expect: OutputNeverWritten<Estimates
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs, Estimates>, Threshold, FindBlobs>;
static_assert(valid<Tracker>);
