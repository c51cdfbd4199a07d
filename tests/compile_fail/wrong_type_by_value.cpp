// expect: WrongType<TakesACopy, Blobs
#include "tokens.hpp"

struct TakesACopy {
  void operator()(Blobs, Estimates&) noexcept {}
};

using Tracker = Graph<Inputs<Blobs>, Outputs<Estimates>, TakesACopy>;
static_assert(valid<Tracker>);
