// expect: WrongType<WritesLatest, (glint::graph::)?Latest<ToolSet> ?&
#include "tokens.hpp"

struct WritesLatest {
  void operator()(Latest<ToolSet>&, Estimates&) noexcept {}
};

using Tracker = Graph<Inputs<Latest<ToolSet>>, Outputs<Estimates>, WritesLatest>;
static_assert(valid<Tracker>);
