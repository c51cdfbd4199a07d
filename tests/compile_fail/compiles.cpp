// expect: success
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame>, Outputs<Estimates>, Estimate, FindBlobs, Threshold>;
static_assert(valid<Tracker>);
