#include "platform/sinks/can/candump_line.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace glint {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;
constexpr std::int64_t k_microsecond_ns = 1'000;
constexpr std::string_view k_digits = "0123456789ABCDEF";
constexpr unsigned k_bit_rate_switch_flag = 1;  // CANFD_BRS of linux/can.h
constexpr unsigned k_fd_flag = 4;               // CANFD_FDF: set by Linux since 6.1
constexpr int k_extended_digits = 8;
constexpr int k_standard_digits = 3;

// Parses all of `text` as a number.
template <class Number>
bool read(std::string_view text, Number& number, int base) {
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number, base);
  return result.ec == std::errc{} && result.ptr == end;
}

bool is_fd_length(std::size_t length) {
  constexpr std::array<std::size_t, 7> k_long{12, 16, 20, 24, 32, 48, 64};
  return length <= 8 || std::find(k_long.begin(), k_long.end(), length) != k_long.end();
}

bool read_data(std::string_view digits, CanFrame& frame) {
  const std::size_t length = digits.size() / 2;
  const bool fits = frame.fd ? is_fd_length(length) : length <= 8;
  if (digits.size() % 2 != 0 || !fits) return false;
  for (std::size_t i = 0; i < length; ++i)
    if (!read(digits.substr(2 * i, 2), frame.data[i], 16)) return false;
  frame.length = static_cast<std::uint8_t>(length);
  return true;
}

bool read_frame(std::string_view text, CanFrame& frame) {
  const auto hash = text.find('#');
  if (hash != k_extended_digits && hash != k_standard_digits) return false;
  frame.extended = hash == k_extended_digits;
  const std::uint32_t last = frame.extended ? k_can_extended_identifier_max : k_can_identifier_max;
  if (!read(text.substr(0, hash), frame.identifier, 16) || frame.identifier > last) return false;
  text.remove_prefix(hash + 1);
  frame.fd = text.starts_with('#');
  if (!frame.fd) return read_data(text, frame);
  unsigned flags = 0;
  if (!read(text.substr(1, 1), flags, 16)) return false;
  frame.bit_rate_switch = (flags & k_bit_rate_switch_flag) != 0;
  return read_data(text.substr(2), frame);
}

}  // namespace

std::string_view format_candump(const CanFrame& frame, std::int64_t unix_ns,
                                std::string_view interface, CandumpLine& buffer) noexcept {
  const std::int64_t time = unix_ns < 0 ? 0 : unix_ns;
  interface = interface.substr(0, k_interface_name_max);
  const int head =
      std::snprintf(buffer.data(), buffer.size(),
                    frame.extended ? "(%010lld.%06lld) %.*s %08X#" : "(%010lld.%06lld) %.*s %03X#",
                    static_cast<long long>(time / k_second_ns),
                    static_cast<long long>(time % k_second_ns / k_microsecond_ns),
                    static_cast<int>(interface.size()), interface.data(), frame.identifier);
  auto at = static_cast<std::size_t>(head);
  if (frame.fd) {
    buffer[at++] = '#';
    buffer[at++] = k_digits[k_fd_flag | (frame.bit_rate_switch ? k_bit_rate_switch_flag : 0)];
  }
  for (const std::uint8_t byte : frame.bytes()) {
    buffer[at++] = k_digits[byte >> 4];
    buffer[at++] = k_digits[byte & 0xFU];
  }
  buffer[at++] = '\n';
  return {buffer.data(), at};
}

std::optional<CandumpRecord> parse_candump(std::string_view line) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  const auto close = line.find(") ");
  const auto dot = line.find('.');
  if (!line.starts_with('(') || close == std::string_view::npos || dot > close) return {};
  std::int64_t seconds = 0;
  std::int64_t microseconds = 0;
  const std::string_view fraction = line.substr(dot + 1, close - dot - 1);
  if (!read(line.substr(1, dot - 1), seconds, 10) || fraction.size() != 6 ||
      !read(fraction, microseconds, 10) || seconds < 0 || microseconds < 0 ||
      seconds > INT64_MAX / k_second_ns - 1)
    return {};
  line.remove_prefix(close + 2);
  const auto space = line.find(' ');
  if (space == std::string_view::npos) return {};
  CandumpRecord record;
  record.unix_ns = seconds * k_second_ns + microseconds * k_microsecond_ns;
  record.interface = std::string(line.substr(0, space));
  const auto is_visible_ascii = [](char c) { return c > ' ' && c <= '~'; };
  if (space == 0 || space > k_interface_name_max ||
      !std::all_of(record.interface.begin(), record.interface.end(), is_visible_ascii)) {
    return {};
  }
  if (!read_frame(line.substr(space + 1), record.frame)) return {};
  return record;
}

}  // namespace glint
