// expect: NoWriter<Estimates, Looks
#include "tokens.hpp"

struct Looks {
  void operator()(const Previous<Estimates>&, Blobs&) noexcept {}
};

using Tracker = Graph<Inputs<>, Outputs<Blobs>, Looks>;
static_assert(valid<Tracker>);
