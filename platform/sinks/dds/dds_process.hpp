// The program's end of its DDS process: writers and readers whose participant lives in
// glint_dds_participant.
//
// A malformed packet that aborts Cyclone, a hang or a flood costs that process only. It is
// restarted, at most once a second, with the same endpoints; every message that it took and did not
// publish is counted. Messages cross in serialised form. What comes back is validated: its record
// here, its contents by the caller.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/dds/child_process.hpp"
#include "platform/sinks/dds/process_memory.hpp"
#include "platform/sinks/dds/serialiser.hpp"

namespace glint {

struct ReceivedMessage {
  RecordKind kind = RecordKind::message;  // or sender_left
  std::uint64_t sender = 0;               // sender_left: 0 is every sender
  std::vector<std::uint8_t> bytes;        // serialised, with encapsulation
};

// Received and lost messages of a reader.
struct ReaderLosses {
  std::uint64_t refused = 0;       // too large
  std::uint64_t overwritten = 0;   // read too late
  std::uint64_t lost = 0;          // in transport
  std::uint32_t incompatible = 0;  // publishers with another quality of service
};

class DdsProcess {
 public:
  static constexpr std::size_t k_outgoing_bytes = std::size_t{4} << 20;  // 3 s of a tool at 250 Hz
  static constexpr std::size_t k_input_bytes = std::size_t{8} << 20;   // the largest description: 4
  static constexpr std::size_t k_image_bytes = std::size_t{32} << 20;  // 2 of the largest images
  static constexpr Duration k_restart_gap = milliseconds(1000);
  // A process that shows no sign of life for this long is killed. Only time counts during which
  // this program runs itself.
  static constexpr Duration k_silence_max = milliseconds(3000);

  // The process of the settings' domain; starts it unless this program has it already. Readers
  // ignore writers of the same process. Throws MissingDevice (network interface, program) or
  // InputError (settings; this program uses the domain on another interface; network error).
  [[nodiscard]] static std::shared_ptr<DdsProcess> of(const DdsSettings& settings,
                                                      std::size_t incoming_bytes = k_input_bytes);
  ~DdsProcess();  // ends the process
  DdsProcess(const DdsProcess&) = delete;
  DdsProcess& operator=(const DdsProcess&) = delete;

  // Each returns the endpoint's number. Throw InputError for too many or a topic's name that is too
  // long. A reader keeps `quality.depth` messages of at most `bytes_max`.
  [[nodiscard]] int writer(const TopicType& type, const std::string& topic, const Quality& quality);
  [[nodiscard]] int reader(const TopicType& type, const std::string& topic, const Quality& quality,
                           std::size_t bytes_max);
  void remove(int endpoint);

  // Thread-safe. Returns false if the process does not run or reads too slowly. A transient_local
  // writer's newest message is published again after a restart, and never refused for that.
  bool write(int writer, const void* message);
  // Messages that the process took and published, or did not.
  [[nodiscard]] std::uint64_t published(int writer) const;
  [[nodiscard]] std::uint64_t lost(int writer) const;
  // Number of matched counterparts.
  [[nodiscard]] int matched(int endpoint) const;
  // Waits until the process publishes at once what these writers write. After a restart it waits
  // for the readers of before.
  [[nodiscard]] bool wait_until_ready(const std::vector<int>& writers, Duration limit) const;
  // Waits until everything is published and acknowledged; the process is killed if it does not
  // answer. After that published() and lost() have every message.
  void flush(Duration limit);

  // Waits until more than `seen` messages arrived; returns their number, for the next call.
  [[nodiscard]] std::uint64_t wait(std::uint64_t seen, Duration limit);
  // Takes a reader's oldest message; false if there is none.
  [[nodiscard]] bool take(int reader, ReceivedMessage& to);
  [[nodiscard]] ReaderLosses losses(int reader) const;

  [[nodiscard]] std::uint64_t restarts() const noexcept { return ends_; }
  // Why the process ended last; empty if it never did.
  [[nodiscard]] std::string last_end() const;
  [[nodiscard]] pid_t id() const noexcept { return id_; }

 private:
  struct Endpoint {
    TopicType type{};
    NewEndpoint created;
    bool removed = false;
    std::vector<std::uint8_t> newest;       // of a transient_local writer
    std::uint64_t pushed = 0;               // to this process
    std::uint64_t published = 0, lost = 0;  // by earlier ones
    ReaderLosses losses;                    // of earlier ones, and of the queue
    std::deque<ReceivedMessage> queue;

    void keep(ReceivedMessage message);
  };

  DdsProcess(const DdsSettings& settings, std::size_t incoming_bytes);
  void start();
  void wait_until_joined();
  void run();
  [[nodiscard]] bool receive();
  [[nodiscard]] bool dispatch(const RingRecord& record);
  void kill(const std::string& why);
  void supervise();
  void note_end(const std::string& how);
  void announce_endpoints();
  int add(const TopicType& type, const std::string& topic, NewEndpoint created);
  bool push(std::size_t endpoint, RecordKind kind, std::span<const std::uint8_t> bytes);
  [[nodiscard]] const EndpointState& state_of(std::size_t endpoint) const {
    return memory_.state().endpoints[endpoint];
  }

  DdsSettings settings_;
  SharedMemory memory_;
  mutable std::mutex mutex_;  // of what follows; the DDS process shares no lock
  std::condition_variable arrived_;
  std::uint64_t arrivals_ = 0;
  std::deque<Endpoint> endpoints_;
  Serialiser serialiser_;
  std::optional<RingProducer> outgoing_;
  std::optional<RingConsumer> incoming_;
  std::vector<std::uint8_t> received_;
  std::optional<ChildProcess> process_;
  std::atomic<pid_t> id_{-1};
  bool joined_ = false;
  std::string last_end_;
  std::uint32_t flushes_ = 0;
  std::uint64_t last_beat_ = 0;
  int silent_checks_ = 0;
  Time started_;  // monotonic
  std::atomic<std::uint64_t> ends_{0};
  std::atomic<bool> killing_{false}, stopping_{false};
  std::thread thread_;
};

}  // namespace glint
