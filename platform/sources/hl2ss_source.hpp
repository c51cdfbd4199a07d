// Live source of AHAT frames of a HoloLens 2 over TCP, by the server of hl2ss: raw with pose. A
// thread with default scheduling receives the packets, one connection a stream. A lost connection
// is opened again.
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
  // none. Throws InputError: no host, another camera than AHAT, an invalid calibration;
  // MissingDevice: no server within 5 s, or no calibration from it.
  [[nodiscard]] static std::unique_ptr<Hl2ssSource> open(Cell& cell, LiveSettings live);
  ~Hl2ssSource() override;
  Hl2ssSource(const Hl2ssSource&) = delete;
  Hl2ssSource& operator=(const Hl2ssSource&) = delete;

  [[nodiscard]] SourceReport report() override;

 private:
  Hl2ssSource(TcpPeer peer, Descriptor connection, const Pose& T_rig_camera, const Cell& cell,
              LiveSettings live);
  void run() noexcept;
  void connect_again();
  void begin_connection();
  void lose_connection(const std::string& why);
  void receive();
  [[nodiscard]] bool complete_part();
  void take_packet();
  void count_gap(Time stamp, Time arrival);
  void name_malformed(const std::string& what);
  void stop();

  TcpPeer peer_;
  int divisor_;
  Pose T_rig_camera_;
  std::atomic<bool> stop_{false};
  // Accessed by the reading thread, and by report() after its end.
  std::optional<Descriptor> connection_;
  Bytes packet_;
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
