// OpenIGTLink server of a run: TRANSFORM, TDATA and STATUS messages for 3D Slicer, PLUS and others.
//
// The tick thread copies a sample into a ring and never waits. The sink's thread builds messages
// and sends them to at most k_clients_max clients without blocking. A client that reads too slowly
// misses whole messages; each is counted.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "graph/ring.hpp"
#include "kernels/limits.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/cells/cell.hpp"
#include "platform/descriptor.hpp"
#include "platform/sinks/dds/pose_output.hpp"
#include "platform/sinks/openigtlink/openigtlink_messages.hpp"

namespace glint {

struct OpenIgtLinkOptions {
  OpenIgtLinkSettings server;
  std::vector<std::string> tool_names;  // element i names PoseSample::tool i
  Duration unix_minus_session;          // offset from a sample's times to Unix time
  Duration actuation_delay;             // from a tick to the time for which its pose is valid
};

struct OpenIgtLinkCounts {
  std::uint64_t offered = 0;               // samples
  std::uint64_t ring_dropped = 0;          // samples that the full ring rejected
  std::uint64_t messages = 0;              // built
  std::uint64_t sent = 0;                  // accepted for a client
  std::uint64_t missed = 0;                // not accepted: the client reads too slowly
  std::uint64_t clients = 0, refused = 0;  // connections accepted; above k_clients_max
  [[nodiscard]] std::uint64_t lost() const { return ring_dropped + missed; }
};

class OpenIgtLinkSink final : public PoseOutput {
 public:
  static constexpr int k_ring_capacity = 1024;
  static constexpr std::size_t k_clients_max = 4;
  static constexpr std::size_t k_waiting_bytes_max = std::size_t{64} << 10;  // of a client

  // Listens at once. Throws InputError (address, two tools with one name), MissingDevice (the
  // address is not this machine's, the port is in use).
  explicit OpenIgtLinkSink(const OpenIgtLinkOptions& options);
  ~OpenIgtLinkSink() override;  // stop()
  OpenIgtLinkSink(const OpenIgtLinkSink&) = delete;
  OpenIgtLinkSink& operator=(const OpenIgtLinkSink&) = delete;

  void start();
  bool offer(const PoseSample& sample) noexcept override;
  bool offer_frame(const FrameTransforms& /*frame*/) noexcept override { return true; }

  // Sends the contents of the ring and the status `shutdown`; waits at most 500 ms for clients.
  // Call after the offering thread has ended.
  void stop();

  // Thread-safe.
  [[nodiscard]] OpenIgtLinkCounts counts() const noexcept;
  [[nodiscard]] std::uint64_t lost() const noexcept override { return counts().lost(); }
  // The port that it listens on: the settings' one, or a free one for 0.
  [[nodiscard]] int port() const noexcept { return port_; }

 private:
  struct Client {
    Descriptor socket;
    std::vector<std::uint8_t> waiting;  // never more than k_waiting_bytes_max
  };
  struct Tool {
    std::string name;
    PoseSample newest;
    bool of_this_tick = false;
    bool stated = false;  // a status was sent
    TrackState state = TrackState::none;
    Reason reason = Reason::none;
    Time transform_due, status_due;
  };

  void run();
  void serve_clients();
  void accept_clients();
  void build_queued();
  void send_tick();
  void send_status(Tool& tool);
  void send(const OpenIgtLinkMessage& message);
  [[nodiscard]] bool flush(Client& client);
  [[nodiscard]] Time unix_time(Time time) const { return time + options_.unix_minus_session; }

  using Counter = std::atomic<std::uint64_t>;
  OpenIgtLinkOptions options_;
  int port_ = 0;
  Descriptor listener_;
  graph::Ring<PoseSample, k_ring_capacity> ring_;
  std::vector<Client> clients_;
  std::vector<Tool> tools_;
  std::uint64_t tick_number_ = 0;
  bool any_of_tick_ = false;
  Time tracking_due_;
  Counter offered_{0}, messages_{0}, sent_{0}, missed_{0}, accepted_{0}, refused_{0};
  std::atomic<bool> stopping_{false};
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace glint
