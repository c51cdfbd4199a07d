#include "platform/sinks/view/foxglove_server.hpp"

#include <libwebsockets.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/view/accepted_origin.hpp"
#include "platform/sinks/view/page_reply.hpp"
#include "platform/sinks/view/view_queue.hpp"
#include "platform/sinks/view/web_server.hpp"

namespace glint {
namespace {

constexpr char k_protocol[] = "foxglove.websocket.v1";
constexpr std::size_t k_fragment_bytes = std::size_t{32} << 10;
constexpr std::size_t k_request_bytes_max = std::size_t{256} << 10;
constexpr unsigned short k_headers_bytes_max = 4096;  // of a request, or it is refused
constexpr auto k_drain_limit = std::chrono::milliseconds(500);

// One connection.
struct Client : ViewClient {
  std::string request;  // received so far
  lws* connection = nullptr;
};

// Nothing if it is too long; empty if it is absent.
std::optional<std::string> header_of(lws* connection, lws_token_indexes token) {
  std::array<char, 256> text{};
  if (lws_hdr_total_length(connection, token) >= static_cast<int>(text.size())) return std::nullopt;
  (void)lws_hdr_copy(connection, text.data(), static_cast<int>(text.size()), token);
  return text.data();
}

}  // namespace

struct FoxgloveServer::Body {
  explicit Body(const FoxgloveSettings& wanted) : settings(wanted), queue(wanted.queue_bytes) {}

  static int on_request(lws* connection, lws_callback_reasons reason, void* user, void* data,
                        std::size_t size);
  static int on_event(lws* connection, lws_callback_reasons reason, void* user, void* data,
                      std::size_t size);
  int filter(lws* connection);
  void open(lws* connection, Client** slot);
  void forget(Client** slot);
  bool receive(Client& client, lws* connection, std::string_view part);
  int send_fragment(Client& client);
  void wake_clients();
  void run();
  [[nodiscard]] bool is_drained();

  FoxgloveSettings settings;
  ViewQueue queue;
  lws_context* context = nullptr;
  int port = 0;
  std::thread thread;
  std::atomic<bool> ending{false};

  // Of the service thread alone.
  std::vector<Client*> clients;
  static_assert(k_page_part_bytes_max <= k_fragment_bytes);
  std::array<std::uint8_t, LWS_PRE + k_fragment_bytes> fragment{};
};

// Events of connections that are no WebSocket, or none yet.
int FoxgloveServer::Body::on_request(lws* connection, lws_callback_reasons reason, void* user,
                                     void* data, std::size_t size) {
  auto* const body = static_cast<Body*>(lws_context_user(lws_get_context(connection)));
  auto* const reply = static_cast<PageReply*>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP: {
      const unsigned status = page_status(connection, {static_cast<const char*>(data), size});
      if (status == HTTP_STATUS_OK) return begin_page(connection, *reply);
      body->queue.refuse();
      return refuse_request(connection, status);
    }
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return send_page_part(connection, *reply, std::span(body->fragment).subspan(LWS_PRE));
    case LWS_CALLBACK_CLOSED_HTTP:
      // Without a complete request, for example of an oversize one: the library closes on it.
      if (reply == nullptr) body->queue.refuse();
      return 0;
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:  // a WebSocket that names no protocol
      body->queue.refuse();
      return -1;
    default:
      return 0;
  }
}

int FoxgloveServer::Body::on_event(lws* connection, lws_callback_reasons reason, void* user,
                                   void* data, std::size_t size) {
  auto* const body = static_cast<Body*>(lws_context_user(lws_get_context(connection)));
  auto** const slot = static_cast<Client**>(user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return body->filter(connection);
    case LWS_CALLBACK_ESTABLISHED:
      body->open(connection, slot);
      return 0;
    case LWS_CALLBACK_CLOSED:
      body->forget(slot);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return body->receive(**slot, connection, {static_cast<const char*>(data), size}) ? 0 : -1;
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return body->send_fragment(**slot);
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      body->wake_clients();
      return 0;
    default:
      return 0;
  }
}

// Returns 0 to accept.
int FoxgloveServer::Body::filter(lws* connection) {
  const std::optional<std::string> origin = header_of(connection, WSI_TOKEN_ORIGIN);
  const std::optional<std::string> host = header_of(connection, WSI_TOKEN_HOST);
  const bool has_protocol = lws_hdr_total_length(connection, WSI_TOKEN_PROTOCOL) > 0;
  if (has_protocol && origin && host && is_accepted_origin(*origin, *host) &&
      clients.size() < static_cast<std::size_t>(settings.clients_max)) {
    return 0;
  }
  queue.refuse();
  return -1;
}

void FoxgloveServer::Body::open(lws* connection, Client** slot) {
  *slot = new Client;
  Client& client = **slot;
  client.connection = connection;
  clients.push_back(&client);
  queue.enter(client);
  lws_callback_on_writable(connection);
}

void FoxgloveServer::Body::forget(Client** slot) {
  Client* const client = *slot;
  if (client == nullptr) return;
  clients.erase(std::find(clients.begin(), clients.end(), client));
  queue.leave(*client);
  delete client;
  *slot = nullptr;
}

// Returns false to disconnect.
bool FoxgloveServer::Body::receive(Client& client, lws* connection, std::string_view part) {
  if (client.request.size() + part.size() > k_request_bytes_max) return false;
  client.request.append(part);
  if (lws_is_final_fragment(connection) == 0 || lws_remaining_packet_payload(connection) > 0) {
    return true;
  }
  const std::string text = std::move(client.request);
  client.request.clear();
  queue.apply(client, lws_frame_is_binary(connection) != 0 ? std::string() : text);
  lws_callback_on_writable(connection);
  return client.waiting.size() < k_subscriptions_max;  // else it sends requests without reading
}

// Returns 0, or -1 to disconnect.
int FoxgloveServer::Body::send_fragment(Client& client) {
  if (client.waiting.empty()) queue.enqueue_next(client);
  if (client.waiting.empty()) return 0;
  Outgoing& out = client.waiting.front();
  const std::size_t begin = out.sent, end = std::min(out.size(), begin + k_fragment_bytes);
  std::uint8_t* const buffer = fragment.data() + LWS_PRE;
  for (std::size_t at = begin; at < end;) {
    const bool in_head = at < out.head.size();
    const std::uint8_t* const from =
        in_head ? out.head.data() + at : out.message->cdr.data() + (at - out.head.size());
    const std::size_t count = std::min(end, in_head ? out.head.size() : out.size()) - at;
    std::memcpy(buffer + (at - begin), from, count);
    at += count;
  }
  const int kind = out.message != nullptr ? LWS_WRITE_BINARY : LWS_WRITE_TEXT;
  const int flags = lws_write_ws_flags(kind, begin == 0, end == out.size());
  const int written =
      lws_write(client.connection, buffer, end - begin, static_cast<lws_write_protocol>(flags));
  if (written < static_cast<int>(end - begin)) return -1;
  out.sent = end;
  if (out.sent == out.size()) client.waiting.pop_front();
  lws_callback_on_writable(client.connection);
  return 0;
}

void FoxgloveServer::Body::wake_clients() {
  for (const Client* client : clients) lws_callback_on_writable(client->connection);
}

bool FoxgloveServer::Body::is_drained() {
  return std::all_of(clients.begin(), clients.end(),
                     [&](const Client* client) { return queue.is_at_end(*client); });
}

void FoxgloveServer::Body::run() {
  auto end = std::chrono::steady_clock::time_point::max();
  for (;;) {
    if (ending.load(std::memory_order_acquire)) {
      const auto now = std::chrono::steady_clock::now();
      end = std::min(end, now + k_drain_limit);
      if (now >= end || is_drained()) return;
      lws_cancel_service(context);  // else a client that reads nothing blocks the loop
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (lws_service(context, 0) < 0) return;
  }
}

FoxgloveServer::FoxgloveServer(const FoxgloveSettings& settings)
    : body_(std::make_unique<Body>(settings)) {
  static const std::array<lws_protocols, 3> protocols = {
      lws_protocols{"http", &Body::on_request, sizeof(PageReply), 0, 0, nullptr, 0},
      lws_protocols{k_protocol, &Body::on_event, sizeof(Client*), k_fragment_bytes, 0, nullptr, 0},
      lws_protocols{}};
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.user = body_.get();
  info.max_http_header_data = k_headers_bytes_max;
  const WebServer server =
      open_web_server(info, "--view", settings.address, settings.port, settings.clients_max);
  body_->context = server.context;
  body_->port = server.port;
  body_->thread = web_server_thread("glint_view", [this] { body_->run(); });
}

FoxgloveServer::~FoxgloveServer() { close(); }

void FoxgloveServer::close() {
  if (body_->context == nullptr) return;
  body_->ending.store(true, std::memory_order_release);
  lws_cancel_service(body_->context);
  body_->thread.join();
  lws_context_destroy(body_->context);  // closes the connections, which deletes the clients
  body_->context = nullptr;
}

int FoxgloveServer::port() const { return body_->port; }

FoxgloveCounts FoxgloveServer::counts() const { return body_->queue.counts(); }

void FoxgloveServer::add_channel(std::uint16_t channel, std::string_view topic,
                                 std::string_view type, std::string_view schema) {
  body_->queue.add_channel(channel, topic, type, schema);
  if (body_->context != nullptr) lws_cancel_service(body_->context);
}

void FoxgloveServer::add_message(std::uint16_t channel, std::uint64_t unix_ns,
                                 std::span<const std::uint8_t> cdr) {
  const bool is_wanted = body_->queue.add_message(channel, unix_ns, cdr);
  if (is_wanted && body_->context != nullptr) lws_cancel_service(body_->context);
}

}  // namespace glint
