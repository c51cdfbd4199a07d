// `glint experiment`, a command of glint_lab.
#pragma once

#include <CLI/CLI.hpp>

#include "platform/shards/sharded_work.hpp"

namespace glint {

// Exit code: 0 every bar is met, 1 one is missed, 2 bad use.
void add_experiment(CLI::App& app, int& exit_code, ShardedWork& work);

}  // namespace glint
