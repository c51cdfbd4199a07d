// `glint run` and `glint track`, which glint_lab has as well, with the baseline method.
#pragma once

#include <CLI/CLI.hpp>

#include "platform/runtime/session/session.hpp"
#include "platform/shards/sharded_work.hpp"

namespace glint {

// Creates the method that replaces the tracker. Empty: `--method baseline` starts glint_lab.
using BaselineFactory = decltype(SessionOptions::method);

void add_run(CLI::App& app, int& exit_code, const BaselineFactory& baseline = {});
void add_track(CLI::App& app, int& exit_code, ShardedWork& work,
               const BaselineFactory& baseline = {});

}  // namespace glint
