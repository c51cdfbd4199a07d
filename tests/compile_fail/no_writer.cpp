// expect: NoWriter<Runs, FindBlobs
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame>, Outputs<Estimates>, FindBlobs, Estimate>;
static_assert(valid<Tracker>);
