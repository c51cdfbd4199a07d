// Opening of a libwebsockets server and of its thread, for the live view and the headset's display.
#pragma once

#include <libwebsockets.h>

#include <functional>
#include <string>
#include <thread>

namespace glint {

struct WebServer {
  lws_context* context = nullptr;  // the caller destroys it
  int port = 0;
};

// `info` has the protocols and the user's pointer; address, port and limits are added. option: the
// command line's, for errors. port 0: any free one. Throws MissingDevice if the address, IPv4,
// cannot be listened on.
[[nodiscard]] WebServer open_web_server(lws_context_creation_info info, const std::string& option,
                                        const std::string& address, int port, int clients_max);

// A named thread that handles no signal.
[[nodiscard]] std::thread web_server_thread(const char* name, std::function<void()> run);

}  // namespace glint
