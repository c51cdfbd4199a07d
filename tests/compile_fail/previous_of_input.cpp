// expect: PreviousOfInput<Frame
#include "tokens.hpp"

struct Compares {
  void operator()(const Frame&, const Previous<Frame>&, Blobs&) noexcept {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Blobs>, Compares>;
static_assert(valid<Tracker>);
