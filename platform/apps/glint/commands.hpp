// Commands of `glint`. Each adds its options to the command line and stores its exit code:
// 0 done, 1 a check failed, 2 bad use or input, 3 a device or peer is missing.
#pragma once

#include <CLI/CLI.hpp>

#include "platform/shards/sharded_work.hpp"

namespace glint {

void add_replay(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_verify(CLI::App& app, int& exit_code);
void add_map(CLI::App& app, int& exit_code);
void add_reference(CLI::App& app, int& exit_code);
void add_path(CLI::App& app, int& exit_code);
void add_inspect(CLI::App& app, int& exit_code);
void add_dds(CLI::App& app, int& exit_code);
void add_can(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_budget(CLI::App& app, int& exit_code, ShardedWork& work);

}  // namespace glint
