// expect: WrongType<TakesAPointer, const Blobs ?\*
#include "tokens.hpp"

struct TakesAPointer {
  void operator()(const Blobs*, Estimates&) noexcept {}
};

using Tracker = Graph<Inputs<Blobs>, Outputs<Estimates>, TakesAPointer>;
static_assert(valid<Tracker>);
