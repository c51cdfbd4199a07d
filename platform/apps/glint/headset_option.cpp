#include "platform/apps/glint/headset_option.hpp"

#include <cstdio>

#include "platform/in_range.hpp"

namespace glint {

void add_headset_option(CLI::App& command, HeadsetArguments& arguments) {
  auto* const headset =
      command.add_option("--headset", arguments.settings.port,
                         "pen, strokes and robot for a headset's display: WebSocket port, default "
                         "8766");
  headset->expected(0, 1)->check(in_range(0, 65535));
  command
      .add_option("--headset-address", arguments.settings.address,
                  "address that it listens on; default: this machine only")
      ->needs(headset);
  arguments.option = headset;
}

std::unique_ptr<HeadsetServer> open_headset(const HeadsetArguments& arguments, const Cell& cell) {
  if (arguments.option->count() == 0) return nullptr;
  HeadsetSettings settings = arguments.settings;
  for (int t = 0; t < cell.tools.count; ++t) {
    settings.tool_names.emplace_back(cell.tools.items[static_cast<std::size_t>(t)].name.data());
  }
  auto server = std::make_unique<HeadsetServer>(settings);
  std::printf("headset    ws://%s:%d, protocol glint.headset.v1\n", settings.address.c_str(),
              server->port());
  std::fflush(stdout);
  return server;
}

void print_headset(const HeadsetCounts& counts) {
  std::printf("headset    %llu clients, %llu messages sent, %llu not taken\n",
              static_cast<unsigned long long>(counts.clients),
              static_cast<unsigned long long>(counts.messages),
              static_cast<unsigned long long>(counts.not_taken));
}

nlohmann::ordered_json headset_json(const HeadsetCounts& counts) {
  return {{"clients", counts.clients},
          {"refused", counts.refused},
          {"messages", counts.messages},
          {"not_taken", counts.not_taken},
          {"queue_full", counts.queue_full}};
}

}  // namespace glint
