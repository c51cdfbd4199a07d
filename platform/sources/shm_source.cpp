#include "platform/sources/shm_source.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "platform/descriptor.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"

namespace glint {
namespace {

constexpr std::uint32_t k_slots_max = 64;  // per producer

constexpr Duration k_hello_within = milliseconds(1000);

class Mapping {
 public:
  Mapping(int fd, std::size_t bytes)
      : bytes_(bytes), at_(::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, fd, 0)) {}
  ~Mapping() {
    if (valid()) ::munmap(at_, bytes_);
  }
  Mapping(Mapping&& other) noexcept
      : bytes_(other.bytes_), at_(std::exchange(other.at_, MAP_FAILED)) {}
  Mapping& operator=(Mapping&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    std::swap(at_, other.at_);
    return *this;
  }
  [[nodiscard]] bool valid() const { return at_ != MAP_FAILED; }
  [[nodiscard]] const char* data() const { return static_cast<const char*>(at_); }

 private:
  std::size_t bytes_;
  void* at_;
};

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw InputError(path + ": " + std::to_string(path.size()) +
                     " characters; expected a socket path of at most " +
                     std::to_string(sizeof address.sun_path - 1));
  }
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

Descriptor seqpacket() {
  return Descriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

// Removes the socket of a process that has ended. Throws InputError for the socket of a running
// process and for another kind of file.
void remove_stale(const std::string& path, const sockaddr_un& address) {
  struct stat state {};
  if (::lstat(path.c_str(), &state) != 0) return;
  if (!S_ISSOCK(state.st_mode)) {
    throw InputError(path + ": a file that is not a socket; expected a socket path");
  }
  const Descriptor probe = seqpacket();
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    throw InputError(path + ": another process listens on it; expected another path");
  }
  ::unlink(path.c_str());
}

// Returns the descriptor sent with a message, -1 if none; the caller closes it.
int descriptor_in(msghdr& message) {
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
       head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level != SOL_SOCKET || head->cmsg_type != SCM_RIGHTS) continue;
    if (head->cmsg_len != CMSG_LEN(sizeof(int))) continue;
    int fd = -1;
    std::memcpy(&fd, CMSG_DATA(head), sizeof fd);
    return fd;
  }
  return -1;
}

}  // namespace

struct ShmSource::Producer {
  Descriptor socket;
  std::optional<Mapping> memory;  // empty: before its hello
  Time connected;
  std::uint32_t slots = 0;
  std::uint64_t slot_bytes = 0;
  std::optional<std::uint64_t> sequence;  // of the newest frame
};

ShmSource::ShmSource(const std::string& path, const Camera& camera, LiveSettings settings)
    : LiveSource(camera, settings), path_(path) {
  const sockaddr_un address = address_of(path_);
  remove_stale(path_, address);
  Descriptor listener = seqpacket();
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener.get(), 4) != 0) {
    throw InputError(path_ + ": " + std::strerror(errno) + "; expected a path for a socket");
  }
  listener_ = ::dup(listener.get());
  thread_ = std::thread([this] { run(); });
}

ShmSource::~ShmSource() {
  stop();
  ::close(listener_);
  ::unlink(path_.c_str());
}

void ShmSource::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void ShmSource::run() noexcept {
  std::optional<Producer> producer;
  while (!stop_) {
    pollfd waited[2] = {{listener_, POLLIN, 0},
                        {producer ? producer->socket.get() : -1, POLLIN, 0}};
    (void)::poll(waited, 2, static_cast<int>(k_live_poll.nanoseconds / 1'000'000));
    if (waited[1].revents != 0) read_message(producer);
    if (producer && !producer->memory && monotonic_now() - producer->connected > k_hello_within) {
      refuse_producer("no hello within a second", producer->socket.get());
      producer.reset();
    }
    if (waited[0].revents != 0) accept_producer(producer);
  }
}

void ShmSource::accept_producer(std::optional<Producer>& producer) {
  Descriptor socket(::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (socket.get() < 0) return;
  if (producer) return refuse_producer("another producer is connected", socket.get());
  producer.emplace();
  producer->socket = std::move(socket);
  producer->connected = monotonic_now();
}

void ShmSource::refuse_producer(const std::string& why, int socket) {
  glint_frames_reply reply{};
  std::snprintf(reply.refused, sizeof reply.refused, "%s", why.c_str());
  (void)::send(socket, &reply, sizeof reply, MSG_NOSIGNAL);
  ++refused_;
  if (first_refusal_.empty()) first_refusal_ = reply.refused;
}

// Expects one hello, then frames; any other message ends the connection.
void ShmSource::read_message(std::optional<Producer>& producer) {
  alignas(8) char bytes[256];
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
  iovec data{bytes, sizeof bytes};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t got = ::recvmsg(producer->socket.get(), &message, MSG_CMSG_CLOEXEC);
  const Descriptor memory(got > 0 ? descriptor_in(message) : -1);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    note(SourceFault::connection_lost);
    producer.reset();
    return;
  }
  if (producer->memory) {
    if (got == static_cast<ssize_t>(sizeof(glint_frames_frame)))
      return take_frame(*producer, bytes);
    ++malformed_;
    note(SourceFault::packet_refused);
    producer.reset();
    return;
  }
  glint_frames_hello hello{};
  std::memcpy(&hello, bytes, std::min<std::size_t>(sizeof hello, static_cast<std::size_t>(got)));
  std::string refusal;
  const auto refuse = [&](std::string why) { refusal = std::move(why); };
  const auto width = static_cast<std::uint32_t>(camera().model.width);
  const auto height = static_cast<std::uint32_t>(camera().model.height);
  const auto bits = static_cast<std::uint32_t>(camera().reflectivity_bits);
  const std::uint64_t planes = std::uint64_t{width} * height * (bits == 8 ? 3 : 4);
  struct stat state {};
  if (got != static_cast<ssize_t>(sizeof hello) ||
      std::memcmp(hello.magic, "GLINTFR1", sizeof hello.magic) != 0) {
    refuse("no hello of glint_frames.h, GLINTFR1");
  } else if (hello.width != width || hello.height != height || hello.reflectivity_bits != bits) {
    refuse(std::to_string(hello.width) + " x " + std::to_string(hello.height) + " pixels of " +
           std::to_string(hello.reflectivity_bits) + " bits; expected " + std::to_string(width) +
           " x " + std::to_string(height) + " of " + std::to_string(bits) + " (" + camera().name +
           ")");
  } else if (hello.slots == 0 || hello.slots > k_slots_max || hello.slot_bytes % 8 != 0 ||
             hello.slot_bytes < GLINT_FRAMES_HEAD + planes ||
             hello.slot_bytes > 2 * planes + 4096) {
    refuse("slot size differs from that of glint_frames.h");
  } else if (memory.get() < 0 || ::fstat(memory.get(), &state) != 0 ||
             static_cast<std::uint64_t>(state.st_size) < hello.slots * hello.slot_bytes) {
    refuse("shared memory smaller than its slots");
  } else if (const int seals = ::fcntl(memory.get(), F_GET_SEALS);
             seals < 0 || (seals & F_SEAL_SHRINK) == 0) {
    refuse("shared memory without F_SEAL_SHRINK");
  } else {
    producer->memory.emplace(memory.get(),
                             static_cast<std::size_t>(hello.slots * hello.slot_bytes));
    if (!producer->memory->valid()) refuse("shared memory that cannot be mapped");
  }
  producer->slots = hello.slots;
  producer->slot_bytes = hello.slot_bytes;
  if (!refusal.empty()) {
    refuse_producer(refusal, producer->socket.get());
    producer.reset();
    return;
  }
  const glint_frames_reply welcome{};
  (void)::send(producer->socket.get(), &welcome, sizeof welcome, MSG_NOSIGNAL);
  ++connected_;
  restart_clock();
  newest_stamp_ = {INT64_MIN};
}

// Returns false if the producer wrote during the copy (sequence lock).
bool ShmSource::copy_pixels(const Producer& producer, std::uint32_t slot, Slot& to) const {
  const char* const from = producer.memory->data() + slot * producer.slot_bytes;
  const auto* const writes = reinterpret_cast<const std::uint64_t*>(from);
  const std::uint64_t before = __atomic_load_n(writes, __ATOMIC_SEQ_CST);
  const char* const pixels = from + GLINT_FRAMES_HEAD;
  const std::size_t depth_bytes = 2 * to.pixels.depth.size();
  std::memcpy(to.pixels.depth.data(), pixels, depth_bytes);
  std::memcpy(to.pixels.reflectivity_8.data(), pixels + depth_bytes,
              to.pixels.reflectivity_8.size());
  std::memcpy(to.pixels.reflectivity_16.data(), pixels + depth_bytes,
              2 * to.pixels.reflectivity_16.size());
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
  return before % 2 == 0 && __atomic_load_n(writes, __ATOMIC_SEQ_CST) == before;
}

void ShmSource::take_frame(Producer& producer, const void* message) {
  glint_frames_frame frame;
  std::memcpy(&frame, message, sizeof frame);
  const Time arrival = monotonic_now();
  if (frame.slot >= producer.slots || frame.stamp_ns > k_live_stamp_max_ns ||
      frame.stamp_ns < -k_live_stamp_max_ns) {
    ++malformed_;
    return note(SourceFault::packet_refused);
  }
  copy_frame(producer, frame, arrival);
  (void)::send(producer.socket.get(), &frame.slot, sizeof frame.slot, MSG_NOSIGNAL);
}

void ShmSource::copy_frame(Producer& producer, const glint_frames_frame& frame, Time arrival) {
  if (producer.sequence && frame.sequence > *producer.sequence) {
    skipped_ += frame.sequence - *producer.sequence - 1;
  }
  producer.sequence = frame.sequence;
  const Time stamp{frame.stamp_ns};
  if (!accept_rising(stamp, newest_stamp_)) return;
  const std::optional<Time> exposure = exposure_of(stamp, arrival);
  if (!exposure) return;
  Slot* const slot = slot_for_next();
  if (slot == nullptr) return;
  if (!copy_pixels(producer, frame.slot, *slot)) {
    ++torn_;
    return note(SourceFault::packet_refused);
  }
  HeadPose head;
  head.valid = frame.has_pose != 0;
  const double* const p = frame.pose;
  head.T_world_camera = {Quaternion(p[6], p[3], p[4], p[5]), Vector3(p[0], p[1], p[2])};
  publish(*exposure, arrival, head);
}

SourceReport ShmSource::report() {
  stop();
  SourceReport report;
  report.text = "shm " + path_ + (connected_ == 0 ? ": no producer connected" : "");
  report.counts = {{"producers_connected", connected_},
                   {"producers_refused", refused_},
                   {"messages_malformed", malformed_},
                   {"frames_torn", torn_},
                   {"frames_skipped_by_producer", skipped_}};
  add_to(report);
  const auto add = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) report.failures.push_back(std::to_string(count) + text);
  };
  add(torn_, " frames overwritten during reading");
  add(malformed_, " messages of unknown type");
  add(refused_, " producers refused, the first: " + first_refusal_);
  return report;
}

}  // namespace glint
