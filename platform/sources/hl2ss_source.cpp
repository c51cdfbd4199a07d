#include "platform/sources/hl2ss_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/sources/file_time.hpp"
#include "platform/sources/hl2ss_wire.hpp"

namespace glint {
namespace {

constexpr Duration k_peer_wait = milliseconds(5000);  // for the server at the start
constexpr Duration k_connect_limit = milliseconds(1000);
constexpr Duration k_attempt_gap = milliseconds(500);   // between two attempts to connect
constexpr Duration k_silence_max = milliseconds(2000);  // without a byte; then connect again
constexpr TcpLimits k_answer_limits{k_connect_limit, k_silence_max};
constexpr Duration k_gap_max = milliseconds(60'000);  // longer gaps are of another clock
constexpr int k_stall_gaps = 12;                      // nominal gaps without a packet
constexpr int k_receptions_max = 64;                  // per reading of the clock
constexpr std::size_t k_png_bytes_more = 64 << 10;    // of an image that does not compress
constexpr std::array<std::uint8_t, 1> k_calibration_request = {2}, k_clock_request = {1};

std::size_t pixels_of(const Camera& camera) {
  return static_cast<std::size_t>(camera.model.width) *
         static_cast<std::size_t>(camera.model.height);
}

bool same_pixels(const Camera& a, const Camera& b) {
  return a.model.width == b.model.width && a.model.height == b.model.height &&
         a.reflectivity_bits == b.reflectivity_bits && a.depth.kind == b.depth.kind;
}

// Repeats `attempt`, which returns an optional and takes the reason of a failure.
template <class Attempt>
auto repeated(const TcpPeer& peer, const std::atomic<bool>* stop, const std::string& expected,
              Attempt attempt) {
  const Time end = monotonic_now() + k_peer_wait;
  std::string why = "no answer";
  for (;;) {
    auto result = attempt(why);
    if (result) return std::move(*result);
    const Time next = monotonic_now() + k_attempt_gap;
    if (next > end || (stop != nullptr && *stop)) break;
    (void)sleep_until(next);
  }
  throw MissingDevice(peer.name + ": " + why + ", for " +
                      std::to_string(k_peer_wait.nanoseconds / 1'000'000'000) + " s; expected " +
                      expected);
}

// Unix time minus the counter that stamps the frames, by the headset's clock. Empty: the remote
// configuration does not answer.
std::optional<Duration> clock_offset(const SourceSettings& source) {
  if (source.clock_port == 0) return std::nullopt;
  std::string why;
  const auto answer = tcp_answer(tcp_peer(source.host, source.clock_port), k_answer_limits,
                                 k_clock_request, 8, why);
  if (!answer) return std::nullopt;
  const auto file_time_minus_counter = ByteReader(*answer).number<std::uint64_t>();
  if (!is_file_time(file_time_minus_counter)) return std::nullopt;
  return time_of_file_time(file_time_minus_counter) - Time{};
}

}  // namespace

Hl2ssSource::Stream Hl2ssSource::stream_of(const Cell& cell) {
  const Camera ahat = hololens2_ahat(), long_throw = *camera_named("hololens2_long_throw");
  const auto divisor = static_cast<std::uint8_t>(cell.source.divisor);
  if (same_pixels(cell.camera, ahat)) {
    // mode 1 (with pose), divisor, profiles, level (default), u32 bit rate, no options
    return {"AHAT",
            k_hl2ss_port_ahat,
            ahat.period,
            true,
            hl2ss_ahat_bytes(pixels_of(ahat)),
            {1, divisor, k_hl2ss_profile_z_same, k_hl2ss_profile_raw, 255, 0, 0, 0, 0, 0}};
  }
  if (same_pixels(cell.camera, long_throw)) {
    // mode, divisor, u32 PNG filter
    return {"long throw",
            k_hl2ss_port_long_throw,
            long_throw.period,
            false,
            4 * pixels_of(long_throw) + k_png_bytes_more,
            {1, divisor, 0, 0, 0, 0}};
  }
  throw InputError(cell.source.position + ".kind: hl2ss sends frames of " + ahat.name + " or " +
                   long_throw.name + "; the camera is " + cell.camera.name);
}

std::size_t Hl2ssSource::packet_bytes_max(const Stream& stream) {
  return k_hl2ss_heading_bytes + stream.payload_bytes_max + k_hl2ss_pose_bytes;
}

std::string Hl2ssSource::rate_text(const Stream& stream, int divisor) {
  char text[96];
  const double bits = 8.0 * static_cast<double>(packet_bytes_max(stream));
  std::snprintf(text, sizeof text, "%s, divisor %d, %s%.1f Mbit/s expected", stream.name, divisor,
                stream.is_ahat ? "" : "at most ", 1e-6 * bits / stream.period.seconds() / divisor);
  return text;
}

std::unique_ptr<Hl2ssSource> Hl2ssSource::open(Cell& cell, LiveSettings live) {
  const SourceSettings& source = cell.source;
  if (source.host.empty()) {
    throw InputError(source.position + ".host: missing; expected the address of a headset");
  }
  const Stream stream = stream_of(cell);
  if (!stream.is_ahat && live.long_throw_planes == nullptr) {
    throw InputError(source.position +
                     ".kind: this program cannot decode PNG; expected the AHAT stream");
  }
  const TcpPeer peer = tcp_peer(source.host, source.port != 0 ? source.port : stream.port);
  std::printf("hl2ss %s: %s\n", printable(peer.name).c_str(),
              rate_text(stream, source.divisor).c_str());
  std::fflush(stdout);
  std::string name = source.calibration;
  Bytes calibration;
  if (name.empty()) {
    name = peer.name + ", calibration";
    const std::size_t bytes = hl2ss_calibration_bytes(cell.camera.model, stream.is_ahat);
    calibration = repeated(
        peer, live.stop, std::string("the calibration of hl2ss's ") + stream.name + " stream",
        [&](std::string& why) {
          return tcp_answer(peer, k_answer_limits, k_calibration_request, bytes, why);
        });
  } else {
    const std::string text = read_file(name, k_data_bytes_max, "hl2ss's calibration of the device");
    calibration.assign(text.begin(), text.end());
  }
  const Pose T_rig_camera = hl2ss_rig_camera(calibration, cell.camera, stream.is_ahat, name);
  if (!names_lens(cell)) {
    std::vector<float> rays = rays_of_hl2ss_calibration(calibration, cell.camera.model);
    set_lens(cell, {name, *with_rays(cell.camera, std::move(rays), name).table, {}});
  }
  require_lens(cell);
  Descriptor connection = repeated(
      peer, live.stop, std::string("hl2ss's ") + stream.name + " stream",
      [&](std::string& why) { return tcp_connect(peer, k_connect_limit, stream.request, why); });
  return std::unique_ptr<Hl2ssSource>(
      new Hl2ssSource(stream, peer, std::move(connection), T_rig_camera, cell, live));
}

Hl2ssSource::Hl2ssSource(const Stream& stream, TcpPeer peer, Descriptor connection,
                         const Pose& T_rig_camera, const Cell& cell, LiveSettings live)
    : LiveSource(cell.camera, live),
      stream_(stream),
      peer_(std::move(peer)),
      divisor_(cell.source.divisor),
      decode_(live.long_throw_planes),
      clock_offset_(clock_offset(cell.source)),
      T_rig_camera_(T_rig_camera),
      packet_(packet_bytes_max(stream)),
      newest_stamp_{INT64_MIN} {
  connection_.emplace(std::move(connection));
  begin_connection();
  thread_ = std::thread([this] { run(); });
}

Hl2ssSource::~Hl2ssSource() { stop(); }

void Hl2ssSource::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Hl2ssSource::run() noexcept {
  while (!stop_) {
    if (!connection_) {
      connect_again();
      continue;
    }
    tcp_wait(connection_->get(), k_live_poll);
    receive();
  }
}

void Hl2ssSource::connect_again() {
  const Time now = monotonic_now();
  if (now < next_attempt_) {
    (void)sleep_until(std::min(next_attempt_, now + k_live_poll));
    return;
  }
  next_attempt_ = now + k_attempt_gap;
  std::string why;
  auto connection = tcp_connect(peer_, k_connect_limit, stream_.request, why);
  if (!connection) return;
  connection_.emplace(std::move(*connection));
  begin_connection();
}

void Hl2ssSource::begin_connection() {
  ++connections_;
  filled_ = 0;
  wanted_ = k_hl2ss_heading_bytes;
  first_packet_ = true;
  last_byte_ = last_packet_ = monotonic_now();
  next_attempt_ = last_byte_ + k_attempt_gap;
}

void Hl2ssSource::lose_connection(const std::string& why) {
  if (lost_++ == 0) first_loss_ = why;
  note(SourceFault::connection_lost);
  truncated_ += filled_ > 0 && filled_ < wanted_ ? 1 : 0;
  connection_.reset();
}

void Hl2ssSource::receive() {
  for (int reception = 0; reception < k_receptions_max && connection_; ++reception) {
    std::string why;
    const auto got = tcp_receive(connection_->get(),
                                 std::span(packet_).subspan(filled_, wanted_ - filled_), why);
    if (!got) return lose_connection(why);
    if (*got == 0) {
      if (monotonic_now() - last_byte_ > k_silence_max) lose_connection("no byte for 2 s");
      return;
    }
    last_byte_ = monotonic_now();
    filled_ += *got;
    if (filled_ == wanted_ && !complete_part()) return;
  }
}

// Returns false at the end of a packet, so that the thread reads its flags.
bool Hl2ssSource::complete_part() {
  if (wanted_ > k_hl2ss_heading_bytes) {
    take_packet();
    filled_ = 0;
    wanted_ = k_hl2ss_heading_bytes;
    return false;
  }
  const auto heading = hl2ss_heading(std::span(packet_).first<k_hl2ss_heading_bytes>());
  const std::size_t bytes_max = stream_.payload_bytes_max;
  if (heading.payload_bytes > bytes_max) {  // the next packet cannot be found
    ++oversize_;
    name_malformed("a payload of " + std::to_string(heading.payload_bytes) +
                   " bytes; expected at most " + std::to_string(bytes_max));
    lose_connection("a packet too large");
    return false;
  }
  wanted_ = k_hl2ss_heading_bytes + heading.payload_bytes + k_hl2ss_pose_bytes;
  return true;
}

void Hl2ssSource::name_malformed(const std::string& what) {
  note(SourceFault::packet_refused);
  if (first_malformed_.empty()) first_malformed_ = what;
}

void Hl2ssSource::count_gap(Time stamp, Time arrival) {
  const Duration nominal = stream_.period * divisor_;
  stalls_ += (arrival - last_packet_).seconds() > k_stall_gaps * nominal.seconds() ? 1 : 0;
  last_packet_ = arrival;
  if (newest_stamp_.nanoseconds == INT64_MIN || stamp <= newest_stamp_) return;
  const Duration gap = stamp - newest_stamp_;
  if (gap > k_gap_max) return;
  const auto frames = std::llround(gap.seconds() / nominal.seconds());
  missing_ += frames > 1 ? static_cast<std::uint64_t>(frames - 1) : 0;
}

// The packet with the least delay has the largest value.
void Hl2ssSource::note_clock(Time stamp, Time arrival) {
  if (!clock_offset_) return;
  const Duration delay = camera().transport + Duration{camera().exposure.nanoseconds / 2};
  const Duration ahead = (stamp + *clock_offset_) - (arrival - delay + glint::unix_offset());
  clock_ahead_ = std::max(clock_ahead_.value_or(ahead), ahead);
}

std::optional<Hl2ssSource::Planes> Hl2ssSource::ahat_planes(std::span<const std::uint8_t> payload) {
  const AhatPayload ahat = hl2ss_ahat(payload, pixels_of(camera()));
  if (ahat.contents == AhatContents::frame) return Planes{ahat.depth, ahat.reflectivity};
  if (ahat.contents == AhatContents::empty) {
    ++empty_;
    note(SourceFault::packet_refused);
  } else {
    ++wrong_size_;
    name_malformed("a frame of " + std::to_string(ahat.z_bytes) + " and " +
                   std::to_string(ahat.ab_bytes) + " bytes; expected 0 and " +
                   std::to_string(4 * pixels_of(camera())));
  }
  return std::nullopt;
}

// Decoding allocates: the reading thread has no deadline.
std::optional<Hl2ssSource::Planes> Hl2ssSource::long_throw_planes(
    std::span<const std::uint8_t> payload) {
  if (payload.size() <= k_hl2ss_sensor_ticks_bytes) {
    ++empty_;
    note(SourceFault::packet_refused);
    return std::nullopt;
  }
  try {
    decoded_ = decode_(payload.first(payload.size() - k_hl2ss_sensor_ticks_bytes), camera(),
                       "a packet of long throw");
  } catch (const InputError& error) {
    ++wrong_size_;
    name_malformed(error.what());
    return std::nullopt;
  }
  const std::span<const std::uint8_t> planes(decoded_);
  return Planes{planes.first(planes.size() / 2), planes.last(planes.size() / 2)};
}

void Hl2ssSource::take_packet() {
  const Time arrival = monotonic_now();
  const std::span<const std::uint8_t> bytes(packet_.data(), wanted_);
  const auto heading = hl2ss_heading(bytes.first<k_hl2ss_heading_bytes>());
  ++packets_;
  const auto payload = bytes.subspan(k_hl2ss_heading_bytes, heading.payload_bytes);
  const std::optional<Planes> planes =
      stream_.is_ahat ? ahat_planes(payload) : long_throw_planes(payload);
  if (!planes) return;
  const Time stamp = time_of_file_time(heading.stamp);
  if (stamp.nanoseconds > k_live_stamp_max_ns) {
    ++stamps_out_of_range_;
    return note(SourceFault::stamp_refused);
  }
  // The counter restarts with the device; a connection that was lost keeps it.
  if (std::exchange(first_packet_, false) && stamp < newest_stamp_) {
    restart_clock();
    newest_stamp_ = {INT64_MIN};
  }
  count_gap(stamp, arrival);
  if (!accept_rising(stamp, newest_stamp_)) return;
  const std::optional<Time> exposure = exposure_of(stamp, arrival);
  if (!exposure) return;
  note_clock(stamp, arrival);
  Slot* const slot = slot_for_next();
  if (slot == nullptr) return;
  std::memcpy(slot->pixels.depth.data(), planes->depth.data(), planes->depth.size());
  std::memcpy(slot->pixels.reflectivity_16.data(), planes->reflectivity.data(),
              planes->reflectivity.size());
  HeadPose head;
  if (const auto T_world_rig = hl2ss_pose(bytes.last<k_hl2ss_pose_bytes>())) {
    head.valid = true;
    head.T_world_camera = *T_world_rig * T_rig_camera_;
  }
  publish(*exposure, arrival, head);
}

std::string Hl2ssSource::clock_text() const {
  if (!clock_ahead_) return clock_offset_ ? "" : "; headset's clock unknown";
  char text[80];
  const double ms = 1e3 * clock_ahead_->seconds();
  std::snprintf(text, sizeof text, "; headset's clock %.1f ms %s this machine's", std::abs(ms),
                ms < 0 ? "behind" : "ahead of");
  return text;
}

SourceReport Hl2ssSource::report() {
  stop();
  SourceReport report;
  report.text = "hl2ss " + printable(peer_.name) + ": " + rate_text(stream_, divisor_) +
                (packets_ == 0 ? ": no packet received" : "") + clock_text();
  report.counts = {{"packets", packets_},
                   {"connections", connections_},
                   {"connections_lost", lost_},
                   {"stalls", stalls_},
                   {"frames_missing", missing_},
                   {"packets_without_frame", empty_},
                   {"packets_of_wrong_size", wrong_size_},
                   {"packets_oversize", oversize_},
                   {"packets_truncated", truncated_},
                   {"stamps_out_of_range", stamps_out_of_range_}};
  add_to(report);
  if (lost_ > 0) {
    report.failures.push_back(std::to_string(lost_) + " connections to " + peer_.name +
                              " lost, the first: " + first_loss_);
  }
  if (!first_malformed_.empty()) {
    report.failures.push_back(std::to_string(wrong_size_ + oversize_) +
                              " packets of another size, the first: " + first_malformed_);
  }
  return report;
}

}  // namespace glint
