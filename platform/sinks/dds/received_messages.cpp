#include "platform/sinks/dds/received_messages.hpp"

#include <cmath>
#include <optional>

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {
namespace {

constexpr double k_unit_tolerance = 0.01;  // of a quaternion's norm, for rounded inputs
constexpr double k_distance_max_m = 1000;  // a robot farther away is none of this cell

// The text without its terminating zero; nothing if it does not end with its only zero.
std::optional<std::string_view> checked_text(CdrReader& from) {
  const auto bytes = from.get_bytes();
  if (from.failed() || bytes.empty()) return {};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.find('\0') != text.size() - 1) return {};
  return text.substr(0, text.size() - 1);
}

bool read_name(CdrReader& from, std::size_t length_min, BoundedName& to) {
  const auto text = checked_text(from);
  if (!text || text->size() < length_min || text->size() > k_received_name_max) return false;
  to = {};
  text->copy(to.data(), text->size());
  return true;
}

struct Header {
  Time time;
  BoundedName frame{};
};

bool read_header(CdrReader& from, Duration unix_minus_session, Time arrival, Header& to) {
  const Time stamp = stamp_of(from);
  to.time = stamp == Time{} ? arrival : stamp - unix_minus_session;
  return read_name(from, 0, to.frame);
}

}  // namespace

bool read_message(MessageBytes message, Duration unix_minus_session, Time arrival,
                  ReceivedJoints& to) {
  CdrReader from(message);
  Header header;
  if (!read_header(from, unix_minus_session, arrival, header)) return false;
  const auto count = from.get<std::uint32_t>();
  if (count < 1 || count > static_cast<std::uint32_t>(k_received_joints_max)) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!read_name(from, 1, to.names[i])) return false;
  }
  if (from.get<std::uint32_t>() != count) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    to.positions[i] = from.get<double>();
    if (!std::isfinite(to.positions[i])) return false;
  }
  to.count = static_cast<int>(count);
  to.time = header.time;
  return !from.failed();
}

bool read_message(MessageBytes message, Duration unix_minus_session, Time arrival,
                  ReceivedInitialPose& to) {
  CdrReader from(message);
  Header header;
  if (!read_header(from, unix_minus_session, arrival, header)) return false;
  to.pose = get_pose(from);
  const Quaternion& rotation = to.pose.rotation;
  if (!(to.pose.translation.norm() <= k_distance_max_m) || !rotation.coeffs().allFinite())
    return false;
  if (std::abs(rotation.norm() - 1) > k_unit_tolerance) return false;
  to.pose.rotation = rotation.normalized();
  for (int i = 0; i < 36; ++i) {
    const auto number = from.get<double>();
    if (!std::isfinite(number)) return false;
    to.covariance(i / 6, i % 6) = number;
  }
  to.frame = header.frame;
  to.time = header.time;
  return !from.failed();
}

std::string_view text_of(MessageBytes message) {
  CdrReader from(message);
  return checked_text(from).value_or(std::string_view{});
}

bool read_message(MessageBytes message, ReceivedDescription& to) {
  const std::string_view text = text_of(message);
  if (text.empty() || text.size() > k_received_description_max) return false;
  to.urdf = text;
  return true;
}

bool read_message(MessageBytes message, bool& to) {
  CdrReader from(message);
  const auto byte = from.get<std::uint8_t>();
  to = byte == 1;
  return !from.failed() && byte <= 1;
}

std::size_t positions_of(const ReceivedJoints& joints, std::span<const std::string> names,
                         std::span<double> positions) noexcept {
  for (std::size_t n = 0; n < names.size(); ++n) {
    int times = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints.count); ++i) {
      if (names[n] != joints.names[i].data()) continue;
      positions[n] = joints.positions[i];
      ++times;
    }
    if (times != 1) return n;
  }
  return names.size();
}

}  // namespace glint
