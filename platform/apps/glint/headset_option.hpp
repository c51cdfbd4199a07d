// Options --headset and --headset-address: the return path to a headset's display.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "platform/cells/cell.hpp"
#include "platform/sinks/headset/headset_server.hpp"

namespace glint {

struct HeadsetArguments {
  const CLI::Option* option = nullptr;  // --headset
  HeadsetSettings settings;
};

// The arguments outlive the command.
void add_headset_option(CLI::App& command, HeadsetArguments& arguments);

// Starts the server and prints its address; null without --headset.
[[nodiscard]] std::unique_ptr<HeadsetServer> open_headset(const HeadsetArguments& arguments,
                                                          const Cell& cell);

void print_headset(const HeadsetCounts& counts);
[[nodiscard]] nlohmann::ordered_json headset_json(const HeadsetCounts& counts);

}  // namespace glint
