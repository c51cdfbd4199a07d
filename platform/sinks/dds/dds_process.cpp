#include "platform/sinks/dds/dds_process.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <stdexcept>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/futex.hpp"
#include "platform/sinks/dds/network.hpp"
#include "platform/sinks/dds/security_files.hpp"

namespace glint {
namespace {

constexpr Duration k_join_limit = milliseconds(10'000);
constexpr Duration k_end_wait = milliseconds(5000);  // for an answer of the process at its end
constexpr Duration k_check_period = milliseconds(20);
constexpr auto k_silent_checks_max =
    static_cast<int>(DdsProcess::k_silence_max.nanoseconds / k_check_period.nanoseconds);
constexpr int k_records_per_round_max = 256;

template <class Value>
std::span<const std::uint8_t> object_bytes(const Value& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof value};
}

template <std::size_t N>
void copy_text(const std::string& text, std::array<char, N>& to) {
  if (text.size() >= N) {
    throw InputError("dds: \"" + text + "\": " + std::to_string(text.size()) +
                     " characters; expected at most " + std::to_string(N - 1));
  }
  std::copy(text.begin(), text.end(), to.begin());
}

// Polls at a period that no run path waits for.
template <class Done>
bool poll_until(Done done, Duration limit) {
  const Time deadline = monotonic_now() + limit;
  while (!done()) {
    if (monotonic_now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace

std::shared_ptr<DdsProcess> DdsProcess::of(const DdsSettings& settings,
                                           std::size_t incoming_bytes) {
  static std::mutex open_mutex;
  static std::map<int, std::weak_ptr<DdsProcess>> open;
  require_network_interface(settings.interface);
  require_security(settings.security);
  const std::lock_guard lock(open_mutex);
  if (const auto process = open[settings.domain].lock()) {
    const DdsSettings& known = process->settings_;
    const bool same_node = known.name == settings.name && known.ros_graph == settings.ros_graph;
    if (same_node && cyclone_configuration(known) == cyclone_configuration(settings)) {
      return process;
    }
    throw InputError("dds.domain: this program uses domain " + std::to_string(settings.domain) +
                     " with another interface, name, other peers or keys; expected the same");
  }
  std::shared_ptr<DdsProcess> process(new DdsProcess(settings, incoming_bytes));
  open[settings.domain] = process;
  return process;
}

DdsProcess::DdsProcess(const DdsSettings& settings, std::size_t incoming_bytes)
    : settings_(settings), memory_(k_outgoing_bytes, incoming_bytes) {
  (void)cyclone_configuration(settings);  // rejects names with markup
  start();
  wait_until_joined();
  thread_ = std::thread([this] { run(); });
}

DdsProcess::~DdsProcess() {
  stopping_ = true;
  thread_.join();
  if (!process_) return;
  (void)push(0, RecordKind::end, {});
  (void)process_->wait(k_end_wait);
}

void DdsProcess::start() {
  memory_.reset();
  outgoing_.emplace(memory_.state().outgoing, memory_.outgoing());
  incoming_.emplace(memory_.state().incoming, memory_.incoming());
  std::vector<std::string> arguments = {"glint_dds_participant",
                                        "--interface",
                                        settings_.interface,
                                        "--domain",
                                        std::to_string(settings_.domain),
                                        "--ros-graph",
                                        std::to_string(static_cast<int>(settings_.ros_graph))};
  for (const std::string& peer : settings_.peers) {
    arguments.insert(arguments.end(), {"--peer", peer});
  }
  if (!settings_.name.empty()) arguments.insert(arguments.end(), {"--name", settings_.name});
  if (!settings_.security.empty()) {
    arguments.insert(arguments.end(), {"--security", settings_.security});
  }
  started_ = monotonic_now();
  silent_checks_ = 0;
  process_.emplace(std::move(arguments), memory_.descriptor(), k_memory_descriptor);
  id_ = process_->id();
}

void DdsProcess::wait_until_joined() {
  ProcessMemory& state = memory_.state();
  bool ended = false;
  const bool in_time = poll_until(
      [&] {
        ended = process_->wait({});
        return ended || state.joined != 0;
      },
      k_join_limit);
  joined_ = in_time && !ended;
  if (joined_) return;
  state.error.back() = '\0';
  const std::string why = state.error.data();
  if (!why.empty()) throw InputError(why);
  throw MissingDevice("dds: the DDS process " +
                      (ended ? process_->how_it_ended() : "did not start within 10 s"));
}

int DdsProcess::writer(const TopicType& type, const std::string& topic, const Quality& quality) {
  NewEndpoint created;
  created.is_writer = true;
  created.quality = quality;
  return add(type, topic, created);
}

int DdsProcess::reader(const TopicType& type, const std::string& topic, const Quality& quality,
                       std::size_t bytes_max) {
  NewEndpoint created;
  created.quality = quality;
  created.bytes_max = static_cast<std::uint32_t>(bytes_max);
  return add(type, topic, created);
}

int DdsProcess::add(const TopicType& type, const std::string& topic, NewEndpoint created) {
  copy_text(type.descriptor->m_typename, created.type);
  copy_text(topic, created.topic);
  const std::lock_guard lock(mutex_);
  const std::size_t number = endpoints_.size();
  if (number == k_endpoints_max) {
    throw InputError("dds: too many topics; expected at most " + std::to_string(k_endpoints_max));
  }
  Endpoint& endpoint = endpoints_.emplace_back();
  endpoint.type = type;
  endpoint.created = created;
  if (joined_) (void)push(number, RecordKind::create, object_bytes(created));
  return static_cast<int>(number);
}

void DdsProcess::remove(int endpoint) {
  const std::lock_guard lock(mutex_);
  const auto number = static_cast<std::size_t>(endpoint);
  endpoints_[number].removed = true;
  if (joined_) (void)push(number, RecordKind::remove, {});
}

bool DdsProcess::push(std::size_t endpoint, RecordKind kind, std::span<const std::uint8_t> bytes) {
  if (!outgoing_->push({0, 0, static_cast<std::uint16_t>(endpoint), kind}, bytes)) return false;
  memory_.state().to_process.fetch_add(1, std::memory_order_release);
  futex_wake(memory_.state().to_process, 1, FutexUse::processes);
  return true;
}

bool DdsProcess::write(int writer, const void* message) {
  const std::lock_guard lock(mutex_);
  const auto number = static_cast<std::size_t>(writer);
  Endpoint& endpoint = endpoints_[number];
  const auto bytes = serialiser_.bytes_of(endpoint.type, message);
  const bool retained = endpoint.created.quality.durability == Durability::transient_local;
  if (retained) endpoint.newest.assign(bytes.begin(), bytes.end());
  if (!joined_) return retained;
  if (!push(number, RecordKind::message, bytes)) return false;
  ++endpoint.pushed;
  return true;
}

std::uint64_t DdsProcess::published(int writer) const {
  const std::lock_guard lock(mutex_);
  const auto number = static_cast<std::size_t>(writer);
  const Endpoint& endpoint = endpoints_[number];
  return endpoint.published + std::min(state_of(number).published.load(), endpoint.pushed);
}

std::uint64_t DdsProcess::lost(int writer) const {
  const std::lock_guard lock(mutex_);
  const auto number = static_cast<std::size_t>(writer);
  const Endpoint& endpoint = endpoints_[number];
  return endpoint.lost + std::min(state_of(number).failed.load(), endpoint.pushed);
}

int DdsProcess::matched(int endpoint) const {
  return static_cast<int>(state_of(static_cast<std::size_t>(endpoint)).matched);
}

bool DdsProcess::wait_until_ready(const std::vector<int>& writers, Duration limit) const {
  const auto ready = [this](int writer) {
    return state_of(static_cast<std::size_t>(writer)).ready != 0;
  };
  return poll_until([&] { return std::all_of(writers.begin(), writers.end(), ready); }, limit);
}

void DdsProcess::flush(Duration limit) {
  std::uint64_t ends_before = 0;
  std::uint32_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!joined_) return;
    ends_before = ends_;
    number = ++flushes_;
    if (!push(0, RecordKind::flush, object_bytes(Flush{number, limit.nanoseconds}))) {
      killing_ = true;
    }
  }
  const auto answered = [&] { return memory_.state().flushed == number || ends_ != ends_before; };
  if (!killing_ && poll_until(answered, limit + k_end_wait)) return;
  killing_ = true;
  (void)poll_until([&] { return ends_ != ends_before; }, k_end_wait);
}

std::uint64_t DdsProcess::wait(std::uint64_t seen, Duration limit) {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, std::chrono::nanoseconds(limit.nanoseconds),
                    [&] { return arrivals_ != seen; });
  return arrivals_;
}

bool DdsProcess::take(int reader, ReceivedMessage& to) {
  const std::lock_guard lock(mutex_);
  auto& queue = endpoints_[static_cast<std::size_t>(reader)].queue;
  if (queue.empty()) return false;
  to = std::move(queue.front());
  queue.pop_front();
  return true;
}

ReaderLosses DdsProcess::losses(int reader) const {
  const std::lock_guard lock(mutex_);
  const auto number = static_cast<std::size_t>(reader);
  const EndpointState& state = state_of(number);
  ReaderLosses losses = endpoints_[number].losses;
  losses.refused += state.refused;
  losses.overwritten += state.overwritten;
  losses.lost += state.lost;
  losses.incompatible += state.incompatible;
  return losses;
}

std::string DdsProcess::last_end() const {
  const std::lock_guard lock(mutex_);
  return last_end_;
}

// Receives, and watches the process; a thread with default scheduling.
void DdsProcess::run() {
  while (!stopping_) {
    const std::uint32_t seen = memory_.state().to_program.load(std::memory_order_acquire);
    if (process_ && receive()) continue;
    supervise();
    const Time deadline = monotonic_now() + k_check_period;
    if (!futex_sleep(memory_.state().to_program, seen, &deadline, FutexUse::processes)) {
      ++silent_checks_;
    }
  }
}

// Returns whether records may be left.
bool DdsProcess::receive() {
  for (int i = 0; i < k_records_per_round_max; ++i) {
    RingRecord record;
    switch (incoming_->pop(record, received_)) {
      case RingResult::empty:
        return false;
      case RingResult::broken:
        kill("broke its memory");
        return false;
      case RingResult::taken:
        if (dispatch(record)) break;
        kill("sent a record of an unknown topic");
        return false;
    }
  }
  return true;
}

void DdsProcess::Endpoint::keep(ReceivedMessage message) {
  if (queue.size() >= static_cast<std::size_t>(created.quality.depth)) {
    queue.pop_front();
    ++losses.overwritten;
  }
  queue.push_back(std::move(message));
}

bool DdsProcess::dispatch(const RingRecord& record) {
  const std::lock_guard lock(mutex_);
  if (record.endpoint >= endpoints_.size()) return false;
  Endpoint& endpoint = endpoints_[record.endpoint];
  const bool is_message = record.kind == RecordKind::message;
  if (endpoint.created.is_writer || !(is_message || record.kind == RecordKind::sender_left)) {
    return false;
  }
  if (endpoint.removed) return true;
  if (received_.size() > endpoint.created.bytes_max) {
    ++endpoint.losses.refused;
    return true;
  }
  endpoint.keep({record.kind, record.sender, std::move(received_)});
  received_.clear();
  ++arrivals_;
  arrived_.notify_all();
  return true;
}

void DdsProcess::supervise() {
  if (!process_) {
    if (monotonic_now() - started_ < k_restart_gap) return;
    const std::lock_guard lock(mutex_);
    try {
      start();
    } catch (const MissingDevice& error) {
      last_end_ = error.what();
    }
    return;
  }
  if (process_->wait({})) return note_end(process_->how_it_ended());
  const std::uint64_t beat = memory_.state().beat.load(std::memory_order_relaxed);
  if (beat != last_beat_) silent_checks_ = 0;
  last_beat_ = beat;
  if (killing_) return kill("did not answer at its end");
  if (silent_checks_ > k_silent_checks_max) return kill("showed no sign of life for 3 s");
  if (!joined_ && memory_.state().joined != 0) announce_endpoints();
}

void DdsProcess::kill(const std::string& why) {
  process_->kill();
  note_end(why);
}

// Counts what the ended process took and did not publish. Its counts are no more than a claim.
void DdsProcess::note_end(const std::string& how) {
  const std::lock_guard lock(mutex_);
  for (std::size_t number = 0; number < endpoints_.size(); ++number) {
    Endpoint& endpoint = endpoints_[number];
    const EndpointState& state = state_of(number);
    if (endpoint.created.is_writer) {
      const bool retained = !endpoint.newest.empty();
      const std::uint64_t published = std::min(state.published.load(), endpoint.pushed);
      endpoint.published += published;
      if (!retained) endpoint.lost += endpoint.pushed - published;
      endpoint.pushed = 0;
      const std::uint32_t matched = state.matched;
      std::uint32_t& readers = endpoint.created.readers_before;
      readers = state.ready != 0 ? matched : std::max(matched, readers);
      continue;
    }
    endpoint.losses.refused += state.refused;
    endpoint.losses.overwritten += state.overwritten;
    endpoint.losses.lost += state.lost;
    endpoint.losses.incompatible += state.incompatible;
    if (!endpoint.removed) endpoint.keep({RecordKind::sender_left, 0, {}});
  }
  ++arrivals_;
  arrived_.notify_all();
  joined_ = false;
  process_.reset();
  id_ = -1;
  last_end_ = how;
  memory_.reset();
  killing_ = false;
  ++ends_;
}

void DdsProcess::announce_endpoints() {
  const std::lock_guard lock(mutex_);
  for (std::size_t number = 0; number < endpoints_.size(); ++number) {
    Endpoint& endpoint = endpoints_[number];
    if (endpoint.removed) continue;
    (void)push(number, RecordKind::create, object_bytes(endpoint.created));
    if (endpoint.newest.empty()) continue;
    if (push(number, RecordKind::message, endpoint.newest)) ++endpoint.pushed;
  }
  joined_ = true;
}

}  // namespace glint
