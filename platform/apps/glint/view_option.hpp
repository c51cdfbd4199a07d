// Options --view and --view-address: the live view of a run or of a recording.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "platform/sinks/view/foxglove_server.hpp"

namespace glint {

struct ViewArguments {
  bool wanted = false;
  FoxgloveSettings settings;
};

// The arguments outlive the command. Uses its parse_complete_callback. Returns --view.
CLI::Option* add_view_option(CLI::App& command, ViewArguments& arguments);

// Starts the server and prints its addresses.
[[nodiscard]] std::unique_ptr<FoxgloveServer> start_view(const FoxgloveSettings& settings);

void print_view(const FoxgloveCounts& counts);
[[nodiscard]] nlohmann::ordered_json view_json(const FoxgloveCounts& counts);

}  // namespace glint
