#include "platform/sinks/view/web_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <utility>

#include "platform/input_error.hpp"

namespace glint {
namespace {

// libwebsockets waits for an address that this machine lacks instead of reporting it, and loses
// memory on a port that is in use.
bool is_free_port(const std::string& address, int port) {
  sockaddr_in wanted{};
  wanted.sin_family = AF_INET;
  wanted.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &wanted.sin_addr) != 1) return false;
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return false;
  const int on = 1;  // as libwebsockets: a port is free although old connections wait on it
  (void)::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool bound =
      ::bind(descriptor, reinterpret_cast<const sockaddr*>(&wanted), sizeof wanted) == 0;
  ::close(descriptor);
  return bound;
}

}  // namespace

WebServer open_web_server(lws_context_creation_info info, const std::string& option,
                          const std::string& address, int port, int clients_max) {
  lws_set_log_level(0, nullptr);
  info.port = port;
  info.iface = address.c_str();
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  // Beside the clients: the listener, the wake-up pipe, and connections that are about to be
  // refused.
  info.fd_limit_per_thread = static_cast<unsigned>(clients_max) + 16;
  info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  WebServer server;
  if (is_free_port(address, port)) server.context = lws_create_context(&info);
  if (server.context != nullptr) {
    server.port = lws_get_vhost_listen_port(lws_get_vhost_by_name(server.context, "default"));
  }
  if (server.port > 0) return server;
  if (server.context != nullptr) lws_context_destroy(server.context);
  throw MissingDevice(option + ": cannot listen on " + address + " port " + std::to_string(port) +
                      "; expected an IPv4 address of this machine and a free port");
}

std::thread web_server_thread(const char* name, std::function<void()> run) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  std::thread thread(std::move(run));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread.native_handle(), name);
  return thread;
}

}  // namespace glint
