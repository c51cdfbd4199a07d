// expect: ListedTwice<Threshold
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame>, Outputs<Runs>, Threshold, Threshold>;
static_assert(valid<Tracker>);
