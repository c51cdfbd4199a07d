#include "kernels/wire/output_record.hpp"

#include <bit>
#include <cmath>

#include "kernels/limits.hpp"
#include "kernels/wire/bits.hpp"

namespace glint {
namespace {

// Writer and Reader follow the order of the table in output_record.hpp.
class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}
  void integer(std::uint64_t value, std::size_t size) {
    put_little_endian(bytes_.subspan(at_, size), value);
    at_ += size;
  }
  void real(double value) {
    const double clean = std::isfinite(value) && value != 0 ? value : 0.0;
    integer(std::bit_cast<std::uint64_t>(clean), 8);
  }

 private:
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint64_t integer(std::size_t size) {
    at_ += size;
    return get_little_endian(bytes_.subspan(at_ - size, size));
  }
  double real() {
    const double value = std::bit_cast<double>(integer(8));
    good = good && std::isfinite(value);
    return value;
  }
  std::uint8_t choice(std::uint8_t last) {
    const auto value = static_cast<std::uint8_t>(integer(1));
    good = good && value <= last;
    return value;
  }
  bool good = true;

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace

void encode(const PoseSample& s, std::span<std::uint8_t, k_output_record_bytes> record) noexcept {
  Writer out(record);
  out.integer(static_cast<std::uint64_t>(s.tick.nanoseconds), 8);
  out.integer(static_cast<std::uint64_t>(s.measurement.nanoseconds), 8);
  out.integer(s.tick_number, 4);
  out.integer(s.frame_sequence, 4);
  out.integer(s.tool, 1);
  out.integer(s.marker_mask, 1);
  out.integer(s.buttons, 1);
  out.integer(static_cast<std::uint8_t>(s.state), 1);
  out.integer(static_cast<std::uint8_t>(s.registration), 1);
  out.integer(static_cast<std::uint8_t>(s.frame), 1);
  out.integer(static_cast<std::uint8_t>(s.reason), 1);
  out.integer(k_output_record_layout, 1);
  for (int i = 0; i < 3; ++i) out.real(s.pose.translation[i]);
  for (int i = 0; i < 4; ++i) out.real(s.pose.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) out.real(s.velocity_m_s[i]);
  for (int i = 0; i < 3; ++i) out.real(s.angular_velocity_rad_s[i]);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) out.real(s.covariance(row, column));
  out.real(s.sigma_position_m);
  out.real(s.sigma_orientation_rad);
  out.real(s.registration_rms_m);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column) out.real(s.systematic(row, column));
}

Result<PoseSample> decode(std::span<const std::uint8_t> record) noexcept {
  constexpr std::size_t k_layout_at = 31;
  const bool newest = record.size() == k_output_record_bytes;
  if (!newest && record.size() != k_output_record_bytes_1) return {{}, Reason::out_of_range};
  if (record[k_layout_at] != (newest ? k_output_record_layout : 1))
    return {{}, Reason::out_of_range};
  Reader in(record);
  PoseSample s;
  s.tick.nanoseconds = static_cast<std::int64_t>(in.integer(8));
  s.measurement.nanoseconds = static_cast<std::int64_t>(in.integer(8));
  s.tick_number = in.integer(4);
  s.frame_sequence = in.integer(4);
  s.tool = in.choice(k_tools_max - 1);
  s.marker_mask = static_cast<std::uint8_t>(in.integer(1));
  s.buttons = static_cast<std::uint8_t>(in.integer(1));
  s.state = static_cast<TrackState>(in.choice(static_cast<std::uint8_t>(TrackState::lost)));
  s.registration = static_cast<RegistrationState>(
      in.choice(static_cast<std::uint8_t>(RegistrationState::refused)));
  s.frame =
      static_cast<ReferenceFrame>(in.choice(static_cast<std::uint8_t>(ReferenceFrame::robot)));
  s.reason = static_cast<Reason>(in.choice(static_cast<std::uint8_t>(k_last_reason)));
  (void)in.integer(1);  // the layout
  for (int i = 0; i < 3; ++i) s.pose.translation[i] = in.real();
  for (int i = 0; i < 4; ++i) s.pose.rotation.coeffs()[i] = in.real();
  for (int i = 0; i < 3; ++i) s.velocity_m_s[i] = in.real();
  for (int i = 0; i < 3; ++i) s.angular_velocity_rad_s[i] = in.real();
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) s.covariance(row, column) = in.real();
  s.sigma_position_m = in.real();
  s.sigma_orientation_rad = in.real();
  s.registration_rms_m = in.real();
  for (int row = 0; newest && row < 6; ++row) {
    for (int column = 0; column <= row; ++column)
      s.systematic(row, column) = s.systematic(column, row) = in.real();
  }
  if (!in.good) return {{}, Reason::out_of_range};
  return {s, Reason::none};
}

}  // namespace glint
