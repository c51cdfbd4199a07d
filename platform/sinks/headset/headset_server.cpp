#include "platform/sinks/headset/headset_server.hpp"

#include <libwebsockets.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "graph/ring.hpp"
#include "platform/sinks/headset/headset_messages.hpp"
#include "platform/sinks/view/web_server.hpp"

namespace glint {
namespace {

constexpr char k_headset_protocol[] = "glint.headset.v1";
constexpr lws_usec_t k_poll_us = 5000;
constexpr int k_send_buffer_bytes = 4 << 10;  // holds few messages: a slow client gets new ones
constexpr std::size_t k_message_bytes_max = std::size_t{64} << 10;
constexpr auto k_close_limit = std::chrono::milliseconds(500);

// A connection, and the versions of the messages that it was sent.
struct HeadsetClient {
  lws* connection = nullptr;
  std::array<std::uint64_t, HeadsetMessages::k_slots> sent{};
  std::size_t next = 0;  // slot
};

}  // namespace

struct HeadsetServer::Body {
  explicit Body(const HeadsetSettings& wanted) : messages(wanted.tool_names) {}

  // The list is first: the library passes its address.
  struct Timer {
    lws_sorted_usec_list_t list{};
    Body* body = nullptr;
  };

  static int on_event(lws* connection, lws_callback_reasons reason, void* user, void* data,
                      std::size_t size);
  static void on_timer(lws_sorted_usec_list_t* list);
  void take_samples();
  [[nodiscard]] int filter(lws* connection);
  void open(lws* connection, HeadsetClient** slot);
  void forget(HeadsetClient** slot);
  [[nodiscard]] bool is_behind(const HeadsetClient& client) const;
  [[nodiscard]] int send_next(HeadsetClient& client);
  void run();

  graph::Ring<HeadsetSample, k_queue_size> ring;
  std::atomic<std::uint64_t> clients_accepted{0}, refused{0}, sent{0}, not_taken{0};
  lws_context* context = nullptr;
  int port = 0;
  std::thread thread;
  std::atomic<bool> ending{false};

  // Of the service thread alone.
  HeadsetMessages messages;
  std::vector<HeadsetClient*> clients;
  std::array<std::uint8_t, LWS_PRE + k_message_bytes_max> buffer{};
  Timer timer;
};

int HeadsetServer::Body::on_event(lws* connection, lws_callback_reasons reason, void* user,
                                  void* /*data*/, std::size_t /*size*/) {
  auto* const body = static_cast<Body*>(lws_context_user(lws_get_context(connection)));
  auto** const slot = static_cast<HeadsetClient**>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      (void)lws_return_http_status(connection, HTTP_STATUS_BAD_REQUEST,
                                   "A WebSocket of protocol glint.headset.v1");
      return -1;
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return body->filter(connection);
    case LWS_CALLBACK_ESTABLISHED:
      body->open(connection, slot);
      return 0;
    case LWS_CALLBACK_CLOSED:
      body->forget(slot);
      return 0;
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return body->send_next(**slot);
    default:  // what a client sends is ignored
      return 0;
  }
}

void HeadsetServer::Body::on_timer(lws_sorted_usec_list_t* list) {
  Body& body = *reinterpret_cast<Timer*>(list)->body;
  body.take_samples();
  lws_sul_schedule(body.context, 0, list, &Body::on_timer, k_poll_us);
}

void HeadsetServer::Body::take_samples() {
  HeadsetSample sample;
  for (int i = 0; i < k_queue_size && ring.pop(sample); ++i) messages.add(sample);
  messages.publish_due();
  for (const HeadsetClient* client : clients) {
    if (is_behind(*client)) lws_callback_on_writable(client->connection);
  }
}

// Returns 0 to accept. Only a page of a browser states an origin.
int HeadsetServer::Body::filter(lws* connection) {
  if (lws_hdr_total_length(connection, WSI_TOKEN_ORIGIN) == 0 && clients.size() < k_clients_max) {
    return 0;
  }
  ++refused;
  return -1;
}

void HeadsetServer::Body::open(lws* connection, HeadsetClient** slot) {
  const int descriptor = lws_get_socket_fd(connection);
  (void)::setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &k_send_buffer_bytes,
                     sizeof k_send_buffer_bytes);
  *slot = new HeadsetClient;
  (*slot)->connection = connection;
  clients.push_back(*slot);
  ++clients_accepted;
  lws_callback_on_writable(connection);
}

void HeadsetServer::Body::forget(HeadsetClient** slot) {
  HeadsetClient* const client = *slot;
  if (client == nullptr) return;
  for (std::size_t i = 0; i < HeadsetMessages::k_slots; ++i) {
    if (client->sent[i] > 0) not_taken += messages.version(i) - client->sent[i];
  }
  clients.erase(std::find(clients.begin(), clients.end(), client));
  delete client;
  *slot = nullptr;
}

bool HeadsetServer::Body::is_behind(const HeadsetClient& client) const {
  for (std::size_t i = 0; i < HeadsetMessages::k_slots; ++i) {
    if (client.sent[i] < messages.version(i)) return true;
  }
  return false;
}

// Sends one message. Returns 0, or -1 to disconnect.
int HeadsetServer::Body::send_next(HeadsetClient& client) {
  for (std::size_t tried = 0; tried < HeadsetMessages::k_slots; ++tried) {
    const std::size_t slot = client.next;
    client.next = (slot + 1) % HeadsetMessages::k_slots;
    const std::uint64_t version = messages.version(slot);
    if (client.sent[slot] == version) continue;
    const std::string text = messages.text(slot);
    if (text.size() > k_message_bytes_max) return -1;
    std::memcpy(buffer.data() + LWS_PRE, text.data(), text.size());
    const int written =
        lws_write(client.connection, buffer.data() + LWS_PRE, text.size(), LWS_WRITE_TEXT);
    if (written < static_cast<int>(text.size())) return -1;
    if (client.sent[slot] > 0) not_taken += version - client.sent[slot] - 1;
    client.sent[slot] = version;
    ++sent;
    if (is_behind(client)) lws_callback_on_writable(client.connection);
    return 0;
  }
  return 0;
}

void HeadsetServer::Body::run() {
  auto end = std::chrono::steady_clock::time_point::max();
  timer.body = this;
  on_timer(&timer.list);
  for (;;) {
    if (ending.load(std::memory_order_acquire)) {
      const auto now = std::chrono::steady_clock::now();
      end = std::min(end, now + k_close_limit);
      take_samples();
      const bool drained = std::none_of(clients.begin(), clients.end(),
                                        [&](const HeadsetClient* c) { return is_behind(*c); });
      if (now >= end || drained) break;
    }
    if (lws_service(context, 0) < 0) break;  // returns at the timer's events at the latest
  }
  lws_sul_cancel(&timer.list);
}

HeadsetServer::HeadsetServer(const HeadsetSettings& settings)
    : body_(std::make_unique<Body>(settings)) {
  static const std::array<lws_protocols, 2> protocols = {
      lws_protocols{k_headset_protocol, &Body::on_event, sizeof(HeadsetClient*), 1024, 0, nullptr,
                    0},
      lws_protocols{}};
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.user = body_.get();
  const WebServer server =
      open_web_server(info, "--headset", settings.address, settings.port, k_clients_max);
  body_->context = server.context;
  body_->port = server.port;
  body_->thread = web_server_thread("glint_headset", [this] { body_->run(); });
}

HeadsetServer::~HeadsetServer() { close(); }

void HeadsetServer::offer(const HeadsetSample& sample) noexcept { (void)body_->ring.push(sample); }

int HeadsetServer::port() const { return body_->port; }

void HeadsetServer::close() {
  if (body_->context == nullptr) return;
  body_->ending.store(true, std::memory_order_release);
  lws_cancel_service(body_->context);
  body_->thread.join();
  lws_context_destroy(body_->context);  // closes the connections, which deletes the clients
  body_->context = nullptr;
}

HeadsetCounts HeadsetServer::counts() const {
  return {body_->clients_accepted, body_->refused, body_->sent, body_->not_taken,
          body_->ring.dropped()};
}

}  // namespace glint
