// expect: NotANode<MayThrow
#include "tokens.hpp"

struct MayThrow {
  void operator()(const Frame&, Runs&) {}
};

using Tracker = Graph<Inputs<Frame>, Outputs<Runs>, MayThrow>;
static_assert(valid<Tracker>);
