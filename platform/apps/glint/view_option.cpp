#include "platform/apps/glint/view_option.hpp"

#include <cstdio>

#include "platform/in_range.hpp"

namespace glint {

CLI::Option* add_view_option(CLI::App& command, ViewArguments& arguments) {
  auto* const view = command.add_option(
      "--view", arguments.settings.port,
      "live view: port of its page for a browser, and of Foxglove's WebSocket; default 8765");
  view->expected(0, 1)->check(in_range(0, 65535));
  command.parse_complete_callback([&arguments, view] { arguments.wanted = view->count() > 0; });
  command
      .add_option("--view-address", arguments.settings.address,
                  "address that the view listens on; default: this machine only")
      ->needs(view);
  return view;
}

std::unique_ptr<FoxgloveServer> start_view(const FoxgloveSettings& settings) {
  auto server = std::make_unique<FoxgloveServer>(settings);
  const char* const address = settings.address.c_str();
  std::printf(
      "view       ws://%s:%d, protocol foxglove.websocket.v1\n"
      "page       http://%s:%d\n",
      address, server->port(), address, server->port());
  std::fflush(stdout);
  return server;
}

void print_view(const FoxgloveCounts& counts) {
  std::printf("view       %llu clients, %llu messages sent, %llu dropped\n",
              static_cast<unsigned long long>(counts.clients),
              static_cast<unsigned long long>(counts.messages),
              static_cast<unsigned long long>(counts.dropped));
}

nlohmann::ordered_json view_json(const FoxgloveCounts& counts) {
  return {{"clients", counts.clients},
          {"refused", counts.refused},
          {"invalid", counts.invalid},
          {"messages", counts.messages},
          {"dropped", counts.dropped}};
}

}  // namespace glint
