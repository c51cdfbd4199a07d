#include "platform/sinks/view/foxglove_server.hpp"

#include <arpa/inet.h>
#include <libwebsockets.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/sinks/view/foxglove_messages.hpp"

namespace glint {
namespace {

constexpr char k_protocol[] = "foxglove.websocket.v1";
constexpr std::size_t k_fragment_bytes = std::size_t{32} << 10;
constexpr std::size_t k_request_bytes_max = std::size_t{256} << 10;
constexpr std::size_t k_kept_bytes_max = std::size_t{4} << 10;  // newest of a channel
constexpr auto k_drain_limit = std::chrono::milliseconds(500);

struct Message {
  std::uint64_t number = 0;  // rises by one in the queue; 0: a channel's newest, sent again
  std::uint16_t channel = 0;
  std::uint64_t unix_ns = 0;
  std::vector<std::uint8_t> cdr;
};
using MessagePointer = std::shared_ptr<const Message>;

struct Channel {
  std::string advertisement;  // JSON of one channel
  std::uint16_t number = 0;
  int subscribers = 0;
  MessagePointer newest;  // of small messages: what a late client starts with
};

// What is being sent to one client.
struct Outgoing {
  std::vector<std::uint8_t> head;  // text, or the head of a binary message
  MessagePointer message;          // its rest; null for text
  std::size_t sent = 0;

  [[nodiscard]] std::size_t size() const {
    return head.size() + (message != nullptr ? message->cdr.size() : 0);
  }
};

struct Client {
  std::set<Subscription> subscriptions;
  std::size_t advertised = 0;  // channels
  std::uint64_t next = 0;      // number of the next message of the queue
  std::deque<Outgoing> waiting;
  std::string request;  // received so far
  lws* connection = nullptr;
};

// A page in a browser states its origin; only pages of this machine and Foxglove's own may connect.
bool is_accepted_origin(std::string_view origin) {
  if (origin.empty()) return true;  // not a page
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.substr(0, scheme.size()) != scheme) continue;
    const std::string_view host = origin.substr(scheme.size());
    for (const std::string_view accepted :
         {"localhost", "127.0.0.1", "[::1]", "app.foxglove.dev"}) {
      if (host == accepted) return true;
      if (host.substr(0, accepted.size()) == accepted && host[accepted.size()] == ':') return true;
    }
    return false;
  }
  return origin != "null";  // a program with a scheme of its own; no page of the web can state it
}

// libwebsockets waits for an address that this machine lacks instead of reporting it, and loses
// memory on a port that is in use.
bool is_free(const std::string& address, int port) {
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

struct FoxgloveServer::Body {
  explicit Body(const FoxgloveSettings& wanted) : settings(wanted) {}

  static int on_event(lws* connection, lws_callback_reasons reason, void* user, void* data,
                      std::size_t size);
  int filter(lws* connection);
  void open(lws* connection, Client** slot);
  void forget(Client** slot);
  bool receive(Client& client, lws* connection, std::string_view part);
  void apply(Client& client, const Request& request);
  std::uint64_t skip_lost(Client& client);
  void enqueue_next(Client& client);
  int send_fragment(Client& client);
  void wake_clients();
  void run();
  [[nodiscard]] bool is_drained();

  FoxgloveSettings settings;
  lws_context* context = nullptr;
  int port = 0;
  std::thread thread;
  std::atomic<bool> ending{false};

  // Of the service thread alone.
  std::vector<Client*> clients;
  std::array<std::uint8_t, LWS_PRE + k_fragment_bytes> fragment{};

  std::mutex mutex;  // protects what follows
  std::vector<Channel> channels;
  std::deque<MessagePointer> queue;
  std::size_t queue_bytes = 0;
  std::uint64_t next_number = 1;
  FoxgloveCounts counts;
};

int FoxgloveServer::Body::on_event(lws* connection, lws_callback_reasons reason, void* user,
                                   void* data, std::size_t size) {
  auto* const body = static_cast<Body*>(lws_context_user(lws_get_context(connection)));
  auto** const slot = static_cast<Client**>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      (void)lws_return_http_status(connection, HTTP_STATUS_BAD_REQUEST,
                                   "A WebSocket of protocol foxglove.websocket.v1");
      return -1;
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
  std::array<char, 256> origin{};
  const bool too_long =
      lws_hdr_total_length(connection, WSI_TOKEN_ORIGIN) >= static_cast<int>(origin.size());
  (void)lws_hdr_copy(connection, origin.data(), static_cast<int>(origin.size()), WSI_TOKEN_ORIGIN);
  const bool has_protocol = lws_hdr_total_length(connection, WSI_TOKEN_PROTOCOL) > 0;
  if (has_protocol && !too_long && is_accepted_origin(origin.data()) &&
      clients.size() < static_cast<std::size_t>(settings.clients_max)) {
    return 0;
  }
  const std::lock_guard lock(mutex);
  ++counts.refused;
  return -1;
}

void FoxgloveServer::Body::open(lws* connection, Client** slot) {
  *slot = new Client;
  Client& client = **slot;
  client.connection = connection;
  clients.push_back(&client);
  client.waiting.push_back({bytes_of(server_info()), nullptr, 0});
  {
    const std::lock_guard lock(mutex);
    ++counts.clients;
    client.next = next_number;
  }
  lws_callback_on_writable(connection);
}

void FoxgloveServer::Body::forget(Client** slot) {
  Client* const client = *slot;
  if (client == nullptr) return;
  clients.erase(std::find(clients.begin(), clients.end(), client));
  {
    const std::lock_guard lock(mutex);
    (void)skip_lost(*client);
    for (const Subscription& subscription : client->subscriptions) {
      --channels[subscription.channel_index].subscribers;
    }
  }
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
  const std::lock_guard lock(mutex);
  const std::optional<Request> request =
      lws_frame_is_binary(connection) != 0 ? std::nullopt : request_of(text);
  if (!request) {
    ++counts.invalid;
    client.waiting.push_back(
        {bytes_of(error_status("expected subscribe or unsubscribe")), nullptr, 0});
  } else {
    apply(client, *request);
  }
  lws_callback_on_writable(connection);
  return client.waiting.size() < k_subscriptions_max;  // else it sends requests without reading
}

// Requires the lock.
void FoxgloveServer::Body::apply(Client& client, const Request& request) {
  for (const std::uint32_t id : request.ended) {
    const auto found = std::find_if(client.subscriptions.begin(), client.subscriptions.end(),
                                    [&](const Subscription& one) { return one.id == id; });
    if (found == client.subscriptions.end()) continue;
    --channels[found->channel_index].subscribers;
    client.subscriptions.erase(found);
  }
  for (const RequestedChannel& wanted : request.begun) {
    const auto channel = std::find_if(channels.begin(), channels.end(), [&](const Channel& one) {
      return one.number == wanted.channel;
    });
    if (channel == channels.end() || client.subscriptions.size() == k_subscriptions_max) {
      ++counts.invalid;
      client.waiting.push_back(
          {bytes_of(error_status("no channel " + std::to_string(wanted.channel))), nullptr, 0});
      continue;
    }
    const auto index = static_cast<std::size_t>(channel - channels.begin());
    if (!client.subscriptions.insert({wanted.id, index}).second) continue;
    ++channel->subscribers;
    if (channel->newest == nullptr || channel->newest->number >= client.next) continue;
    const Message& newest = *channel->newest;
    client.waiting.push_back({message_head(wanted.id, newest.unix_ns), channel->newest, 0});
  }
}

// Counts what left the queue before the client's turn. Returns the number of the queue's first
// message. Requires the lock.
std::uint64_t FoxgloveServer::Body::skip_lost(Client& client) {
  const std::uint64_t first = queue.empty() ? next_number : queue.front()->number;
  if (client.next >= first) return first;
  if (!client.subscriptions.empty()) counts.dropped += first - client.next;
  client.next = first;
  return first;
}

// Puts the client's next message, or the next channels, into `waiting`. Requires the lock.
void FoxgloveServer::Body::enqueue_next(Client& client) {
  if (client.advertised < channels.size()) {
    std::vector<std::string> added;
    for (; client.advertised < channels.size(); ++client.advertised) {
      added.push_back(channels[client.advertised].advertisement);
    }
    client.waiting.push_back({bytes_of(advertise(added)), nullptr, 0});
    return;
  }
  const auto is_subscribed = [&](const Subscription& one, const Message& message) {
    return channels[one.channel_index].number == message.channel;
  };
  const std::uint64_t first = skip_lost(client);
  for (; client.waiting.empty() && client.next < next_number; ++client.next) {
    const MessagePointer& message = queue[static_cast<std::size_t>(client.next - first)];
    for (const Subscription& one : client.subscriptions) {
      if (!is_subscribed(one, *message)) continue;
      client.waiting.push_back({message_head(one.id, message->unix_ns), message, 0});
      ++counts.messages;
    }
  }
}

// Returns 0, or -1 to disconnect.
int FoxgloveServer::Body::send_fragment(Client& client) {
  if (client.waiting.empty()) {
    const std::lock_guard lock(mutex);
    enqueue_next(client);
  }
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
  const std::lock_guard lock(mutex);
  return std::all_of(clients.begin(), clients.end(), [&](const Client* client) {
    return client->waiting.empty() && client->next == next_number;
  });
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
  lws_set_log_level(0, nullptr);
  static const std::array<lws_protocols, 2> protocols = {
      lws_protocols{k_protocol, &Body::on_event, sizeof(Client*), k_fragment_bytes, 0, nullptr, 0},
      lws_protocols{}};
  lws_context_creation_info info{};
  info.port = settings.port;
  info.iface = settings.address.c_str();
  info.protocols = protocols.data();
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  info.user = body_.get();
  // Beside the clients: the listener, the wake-up pipe, and connections that are about to be
  // refused.
  info.fd_limit_per_thread = static_cast<unsigned>(settings.clients_max) + 16;
  info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  if (is_free(settings.address, settings.port)) body_->context = lws_create_context(&info);
  if (body_->context != nullptr) {
    body_->port = lws_get_vhost_listen_port(lws_get_vhost_by_name(body_->context, "default"));
  }
  if (body_->context == nullptr || body_->port <= 0) {
    if (body_->context != nullptr) lws_context_destroy(body_->context);
    throw MissingDevice("--view: cannot listen on " + settings.address + " port " +
                        std::to_string(settings.port) +
                        "; expected an IPv4 address of this machine and a free port");
  }
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);  // the new thread handles no signal
  body_->thread = std::thread([this] { body_->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(body_->thread.native_handle(), "glint_view");
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

FoxgloveCounts FoxgloveServer::counts() const {
  const std::lock_guard lock(body_->mutex);
  return body_->counts;
}

void FoxgloveServer::add_channel(std::uint16_t channel, std::string_view topic,
                                 std::string_view type, std::string_view schema) {
  const std::lock_guard lock(body_->mutex);
  body_->channels.push_back({channel_json(channel, topic, type, schema), channel, 0, nullptr});
  if (body_->context != nullptr) lws_cancel_service(body_->context);
}

void FoxgloveServer::add_message(std::uint16_t channel, std::uint64_t unix_ns,
                                 std::span<const std::uint8_t> cdr) {
  Body& body = *body_;
  {
    const std::lock_guard lock(body.mutex);
    const auto found = std::find_if(body.channels.begin(), body.channels.end(),
                                    [&](const Channel& one) { return one.number == channel; });
    if (found == body.channels.end()) return;
    const bool keeps = cdr.size() <= k_kept_bytes_max, sends = found->subscribers > 0;
    if (!keeps && !sends) return;
    auto message = std::make_shared<Message>();
    message->channel = channel;
    message->unix_ns = unix_ns;
    message->cdr.assign(cdr.begin(), cdr.end());
    if (sends) message->number = body.next_number++;
    if (keeps) found->newest = message;
    if (!sends) return;
    body.queue_bytes += message->cdr.size();
    body.queue.push_back(std::move(message));
    while (body.queue_bytes > body.settings.queue_bytes && body.queue.size() > 1) {
      body.queue_bytes -= body.queue.front()->cdr.size();
      body.queue.pop_front();
    }
  }
  if (body.context != nullptr) lws_cancel_service(body.context);
}

}  // namespace glint
