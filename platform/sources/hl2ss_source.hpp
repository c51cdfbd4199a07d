// Live source of depth frames of a HoloLens 2 over TCP, by the server of hl2ss, with pose: AHAT
// raw, or long throw as PNG. The cell's camera selects the stream. A thread with default scheduling
// receives the packets, one connection a stream. A lost connection is opened again.
//
// Memory: one packet; a packet that states more bytes than a frame ends the connection.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/descriptor.hpp"
#include "platform/sinks/record/bytes.hpp"
#include "platform/sources/live_source.hpp"
#include "platform/sources/tcp_client.hpp"

namespace glint {

class Hl2ssSource final : public LiveSource {
 public:
  // Requires `cell.source` of kind hl2ss. Prints the expected bit rate, downloads the calibration
  // unless the cell names a file, and connects. The cell takes the calibration's lens if it names
  // none. Throws InputError: no host, another camera than these two, an invalid calibration;
  // MissingDevice: no server within 5 s, or no calibration from it.
  [[nodiscard]] static std::unique_ptr<Hl2ssSource> open(Cell& cell, LiveSettings live);
  ~Hl2ssSource() override;
  Hl2ssSource(const Hl2ssSource&) = delete;
  Hl2ssSource& operator=(const Hl2ssSource&) = delete;

  [[nodiscard]] SourceReport report() override;

 private:
  // One of the two streams.
  struct Stream {
    const char* name = "";
    std::uint16_t port = 0;
    Duration period;  // nominal gap of frames
    bool is_ahat = false;
    std::size_t payload_bytes_max = 0;
    std::vector<std::uint8_t> request;
  };
  // Planes of u16; valid until the next packet.
  struct Planes {
    std::span<const std::uint8_t> depth, reflectivity;
  };
  Hl2ssSource(const Stream& stream, TcpPeer peer, Descriptor connection, const Pose& T_rig_camera,
              const Cell& cell, LiveSettings live);
  [[nodiscard]] static Stream stream_of(const Cell& cell);
  [[nodiscard]] static std::size_t packet_bytes_max(const Stream& stream);
  [[nodiscard]] static std::string rate_text(const Stream& stream, int divisor);
  void run() noexcept;
  void connect_again();
  void begin_connection();
  void lose_connection(const std::string& why);
  void receive();
  [[nodiscard]] bool complete_part();
  void take_packet();
  // Of a packet's payload; empty if it holds no frame, which is counted.
  [[nodiscard]] std::optional<Planes> ahat_planes(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::optional<Planes> long_throw_planes(std::span<const std::uint8_t> payload);
  void note_clock(Time stamp, Time arrival);
  [[nodiscard]] std::string clock_text() const;
  void count_gap(Time stamp, Time arrival);
  void name_malformed(const std::string& what);
  void stop();

  Stream stream_;
  TcpPeer peer_;
  int divisor_;
  LongThrowPlanes decode_;
  std::optional<Duration> clock_offset_;  // Unix time minus stamps, by the headset's clock
  std::optional<Duration> clock_ahead_;   // of the headset's clock
  Pose T_rig_camera_;
  std::atomic<bool> stop_{false};
  // Accessed by the reading thread, and by report() after its end.
  std::optional<Descriptor> connection_;
  Bytes packet_, decoded_;
  std::size_t filled_ = 0, wanted_ = 0;  // bytes of packet_
  Time last_byte_, last_packet_, next_attempt_;
  bool first_packet_ = true;  // of the connection
  Time newest_stamp_;
  std::uint64_t packets_ = 0, connections_ = 0, lost_ = 0, stalls_ = 0, missing_ = 0, empty_ = 0,
                wrong_size_ = 0, oversize_ = 0, truncated_ = 0, stamps_out_of_range_ = 0;
  std::string first_loss_, first_malformed_;
  std::thread thread_;
};

}  // namespace glint
