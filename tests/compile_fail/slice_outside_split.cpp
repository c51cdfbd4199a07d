// expect: PartitionOutsideSplit<ThresholdBand
#include "tokens.hpp"

using Tracker = Graph<Inputs<Frame>, Outputs<Runs>, ThresholdBand>;
static_assert(valid<Tracker>);
