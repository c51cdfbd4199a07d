#include "platform/sinks/openigtlink/openigtlink_sink.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr const char* k_device = "Glint";  // of TDATA
constexpr auto k_poll_period = std::chrono::milliseconds(2);
constexpr Duration k_status_period = milliseconds(1000);
constexpr auto k_last_sending_max = std::chrono::milliseconds(500);
constexpr int k_samples_per_round_max = 256;
constexpr int k_connections_per_round_max = 8;
constexpr std::size_t k_received_per_round_max = 4096;  // of a client; Glint ignores it

Descriptor listener_of(const OpenIgtLinkSettings& server, int& port) {
  const std::string where =
      "openigtlink: " + server.address + ":" + std::to_string(server.port) + ": ";
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server.port));
  if (inet_pton(AF_INET, server.address.c_str(), &address.sin_addr) != 1) {
    throw InputError(where + "no IPv4 address; expected one of this machine, 0.0.0.0 for all");
  }
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  (void)setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  socklen_t size = sizeof address;
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (bind(socket.get(), plain, size) != 0 ||
      listen(socket.get(), static_cast<int>(OpenIgtLinkSink::k_clients_max)) != 0 ||
      getsockname(socket.get(), plain, &size) != 0) {
    throw MissingDevice(where + std::generic_category().message(errno) +
                        "; expected a free port of this machine");
  }
  port = ntohs(address.sin_port);
  return socket;
}

std::string_view name_of(TrackState state) {
  switch (state) {
    case TrackState::none:
      return "none";
    case TrackState::predicted:
      return "predicted";
    case TrackState::measured:
      return "measured";
    case TrackState::lost:
      return "lost";
  }
  return "";
}

// Only one thread writes each counter.
void add_one(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

OpenIgtLinkSink::OpenIgtLinkSink(const OpenIgtLinkOptions& options)
    : options_(options), listener_(listener_of(options.server, port_)) {
  clients_.reserve(k_clients_max);
  for (const std::string& name : options.tool_names) {
    const std::string cut = name.substr(0, k_openigtlink_name_bytes - 1);
    for (const Tool& other : tools_) {
      if (other.name != cut) continue;
      throw InputError("openigtlink: two tools have the name \"" + cut +
                       "\"; expected names that differ in their first 19 characters");
    }
    tools_.emplace_back().name = cut;
  }
}

OpenIgtLinkSink::~OpenIgtLinkSink() { stop(); }

void OpenIgtLinkSink::start() {
  if (!thread_.joinable() && !stopped_) thread_ = std::thread([this] { run(); });
}

bool OpenIgtLinkSink::offer(const PoseSample& sample) noexcept {
  add_one(offered_);
  return ring_.push(sample);
}

void OpenIgtLinkSink::run() {
  while (!stopping_.load(std::memory_order_acquire)) {
    accept_clients();
    build_queued();
    serve_clients();
    std::this_thread::sleep_for(k_poll_period);
  }
}

void OpenIgtLinkSink::accept_clients() {
  for (int i = 0; i < k_connections_per_round_max; ++i) {
    Descriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.get() < 0) return;
    if (clients_.size() == k_clients_max) {
      add_one(refused_);
      continue;
    }
    const int on = 1;
    (void)setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    add_one(accepted_);
    Client& client = clients_.emplace_back();
    client.socket = std::move(socket);
    client.waiting.reserve(k_waiting_bytes_max);
    for (Tool& tool : tools_) tool.stated = false;  // the new client gets every status
  }
}

// A client may send requests; none changes what Glint sends.
void OpenIgtLinkSink::serve_clients() {
  std::erase_if(clients_, [&](Client& client) {
    std::array<std::uint8_t, k_received_per_round_max> ignored;
    const ssize_t received =
        ::recv(client.socket.get(), ignored.data(), ignored.size(), MSG_DONTWAIT);
    const bool ended = received == 0 || (received < 0 && errno != EAGAIN && errno != EINTR);
    return ended || !flush(client);
  });
}

// Returns false if the client has left.
bool OpenIgtLinkSink::flush(Client& client) {
  if (client.waiting.empty()) return true;
  const ssize_t sent = ::send(client.socket.get(), client.waiting.data(), client.waiting.size(),
                              MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0) return errno == EAGAIN || errno == EINTR;
  client.waiting.erase(client.waiting.begin(), client.waiting.begin() + sent);
  return true;
}

void OpenIgtLinkSink::build_queued() {
  PoseSample sample;
  for (int i = 0; i < k_samples_per_round_max && ring_.pop(sample); ++i) {
    if (sample.tool >= tools_.size()) continue;
    if (any_of_tick_ && sample.tick_number != tick_number_) send_tick();
    tick_number_ = sample.tick_number;
    any_of_tick_ = true;
    tools_[sample.tool].newest = sample;
    tools_[sample.tool].of_this_tick = true;
    if (sample.tool + 1U == tools_.size()) send_tick();
  }
}

// All tools of one tick.
void OpenIgtLinkSink::send_tick() {
  std::array<OpenIgtLinkTool, k_tools_max> tracked;
  std::size_t count = 0;
  Time tick;
  for (Tool& tool : tools_) {
    if (!tool.of_this_tick) continue;
    tool.of_this_tick = false;
    const PoseSample& sample = tool.newest;
    tick = sample.tick;
    if (!tool.stated || sample.state != tool.state || sample.reason != tool.reason ||
        tick >= tool.status_due) {
      send_status(tool);
    }
    if (!sample.has_pose()) continue;
    tracked[count++] = {tool.name, sample.pose};
    if (tick < tool.transform_due) continue;
    tool.transform_due = tick + options_.server.period;
    send(OpenIgtLinkMessage::transform(tool.name, unix_time(tick + options_.actuation_delay),
                                       sample.pose));
  }
  any_of_tick_ = false;
  if (count == 0 || tick < tracking_due_) return;
  tracking_due_ = tick + options_.server.period;
  send(OpenIgtLinkMessage::tracking(k_device, unix_time(tick + options_.actuation_delay),
                                    std::span(tracked).first(count)));
}

void OpenIgtLinkSink::send_status(Tool& tool) {
  const PoseSample& sample = tool.newest;
  tool.stated = true;
  tool.state = sample.state;
  tool.reason = sample.reason;
  tool.status_due = sample.tick + k_status_period;
  send(OpenIgtLinkMessage::status(
      tool.name, unix_time(sample.tick),
      sample.has_pose() ? OpenIgtLinkStatus::ok : OpenIgtLinkStatus::not_ready,
      name_of(sample.state), name_of(sample.reason)));
}

void OpenIgtLinkSink::send(const OpenIgtLinkMessage& message) {
  add_one(messages_);
  const auto bytes = message.bytes();
  for (Client& client : clients_) {
    if (client.waiting.size() + bytes.size() > k_waiting_bytes_max) {
      add_one(missed_);
      continue;
    }
    client.waiting.insert(client.waiting.end(), bytes.begin(), bytes.end());
    add_one(sent_);
  }
}

void OpenIgtLinkSink::stop() {
  if (stopped_) return;
  stopped_ = true;
  stopping_.store(true);
  if (thread_.joinable()) thread_.join();
  const auto end = std::chrono::steady_clock::now() + k_last_sending_max;
  for (int i = 0; i * k_samples_per_round_max < k_ring_capacity; ++i) build_queued();
  if (any_of_tick_) send_tick();
  for (const Tool& tool : tools_) {
    send(OpenIgtLinkMessage::status(tool.name, unix_time(tool.newest.tick),
                                    OpenIgtLinkStatus::shutdown, "shutdown", "the run ends"));
  }
  const auto waiting = [](const Client& client) { return !client.waiting.empty(); };
  while (std::any_of(clients_.begin(), clients_.end(), waiting) &&
         std::chrono::steady_clock::now() < end) {
    serve_clients();
    std::this_thread::sleep_for(k_poll_period);
  }
  for (const Client& client : clients_) {
    if (waiting(client)) add_one(missed_);  // at least one message
  }
  clients_.clear();
}

OpenIgtLinkCounts OpenIgtLinkSink::counts() const noexcept {
  OpenIgtLinkCounts counts;
  counts.offered = offered_.load(std::memory_order_relaxed);
  counts.ring_dropped = ring_.dropped();
  counts.messages = messages_.load(std::memory_order_relaxed);
  counts.sent = sent_.load(std::memory_order_relaxed);
  counts.missed = missed_.load(std::memory_order_relaxed);
  counts.clients = accepted_.load(std::memory_order_relaxed);
  counts.refused = refused_.load(std::memory_order_relaxed);
  return counts;
}

}  // namespace glint
