#include "platform/tools/programming/press_times.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr double k_seconds_max = 1e9;  // far beyond any recording, well within int64 nanoseconds

std::optional<Time> time_of(std::string_view text) {
  double seconds = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seconds);
  if (error != std::errc() || stop != end || !(std::abs(seconds) <= k_seconds_max)) return {};
  return Time{std::llround(seconds * 1e9)};
}

}  // namespace

std::vector<ButtonEvent> press_times(const std::string& text) {
  std::vector<ButtonEvent> events;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view one = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    if (more) rest.remove_prefix(comma + 1);
    const std::size_t dots = one.find("..");
    const bool two = dots != std::string_view::npos;
    const auto from = two ? time_of(one.substr(0, dots)) : std::nullopt;
    const auto to = two ? time_of(one.substr(dots + 2)) : std::nullopt;
    const bool rising = from && to && *from < *to && (events.empty() || events.back().time < *from);
    if (!rising) {
      throw InputError(
          "--button: found \"" + std::string(one) +
          "\"; expected FROM..TO in seconds, in increasing order, e.g. 1.0..2.5,3.0..4.2");
    }
    events.push_back({*from, Button::draw, true});
    events.push_back({*to, Button::draw, false});
  }
  return events;
}

}  // namespace glint
