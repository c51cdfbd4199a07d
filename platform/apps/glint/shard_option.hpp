// Options --shard and --shard-file of a command whose work is divided, and the command `merge`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "platform/shards/sharded_work.hpp"

namespace glint {

void add_shard_option(CLI::App& command, ShardedWork& work);

// Stores the command that the shards divide in `merged`; the caller parses it next, with
// parse_command(). Shards of glint_lab start it.
void add_merge(CLI::App& app, ShardedWork& work, std::vector<std::string>& merged);

// Parses the command line; for `merge`, then the shards' command.
void parse_command(CLI::App& app, int argc, char** argv, const std::vector<std::string>& merged);

}  // namespace glint
