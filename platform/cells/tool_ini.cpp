#include <charconv>
#include <cmath>
#include <map>

#include "platform/cells/tool_formats.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

struct Entry {
  std::string value;
  int line = 0;
};
// "section/key", both in lower case.
using Entries = std::map<std::string, Entry>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string lowered(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

std::string place_of(const std::string& path, int line) {
  return path + ":" + std::to_string(line);
}

Entries entries_of(std::string_view text, const std::string& path) {
  Entries entries;
  std::string section;
  int line = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view row = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++line;
    if (row.empty() || row.front() == ';' || row.front() == '#') continue;
    if (row.front() == '[' && row.back() == ']') {
      section = lowered(trimmed(row.substr(1, row.size() - 2)));
      continue;
    }
    const std::size_t equals = row.find('=');
    if (equals == std::string_view::npos) {
      throw InputError(place_of(path, line) + ": \"" + std::string(row.substr(0, 40)) +
                       "\"; expected [section] or key=value");
    }
    const std::string key = section + "/" + lowered(trimmed(row.substr(0, equals)));
    if (!entries.emplace(key, Entry{std::string(trimmed(row.substr(equals + 1))), line}).second) {
      throw InputError(place_of(path, line) + ": " + key + " occurs twice; expected it once");
    }
  }
  return entries;
}

const Entry& required(const Entries& entries, const std::string& key, const std::string& path) {
  const auto found = entries.find(key);
  if (found != entries.end()) return found->second;
  const std::size_t slash = key.find('/');
  throw InputError(path + ":1: [" + key.substr(0, slash) + "] " + key.substr(slash + 1) +
                   " is missing; expected it in an Atracsys geometry");
}

double coordinate_m(const Entry& entry, const std::string& key, const std::string& path) {
  double value = 0;
  const char* end = entry.value.data() + entry.value.size();
  const auto [rest, error] = std::from_chars(entry.value.data(), end, value);
  if (error != std::errc{} || rest != end || !(std::abs(value) <= k_tool_coordinate_max_mm)) {
    throw InputError(place_of(path, entry.line) + ": " + key + " is \"" + entry.value +
                     "\"; expected a number from -2000 to 2000 mm");
  }
  return 1e-3 * value;
}

Vector3 point_in(const Entries& entries, const std::string& section, const std::string& path) {
  Vector3 point;
  int axis = 0;
  for (const char* name : {"/x", "/y", "/z"}) {
    point(axis++) = coordinate_m(required(entries, section + name, path), section + name, path);
  }
  return point;
}

bool has_section(const Entries& entries, const std::string& section) {
  const auto next = entries.lower_bound(section + "/");
  return next != entries.end() && next->first.compare(0, section.size() + 1, section + "/") == 0;
}

}  // namespace

Tool tool_from_ini_text(std::string_view text, const std::string& path) {
  const Entries entries = entries_of(text, path);
  const Entry& stated = required(entries, "geometry/count", path);
  int count = 0;
  const char* end = stated.value.data() + stated.value.size();
  const auto [rest, error] = std::from_chars(stated.value.data(), end, count);
  if (error != std::errc{} || rest != end) {
    throw InputError(place_of(path, stated.line) + ": count is \"" + stated.value +
                     "\"; expected a whole number");
  }
  check_marker_count(count, place_of(path, stated.line));
  Tool tool;
  set_name(tool, stem_of(path), path);
  for (int m = 0; m < count; ++m) {
    tool.markers_m[static_cast<std::size_t>(m)] =
        point_in(entries, "fiducial" + std::to_string(m), path);
  }
  if (has_section(entries, "fiducial" + std::to_string(count))) {
    throw InputError(place_of(path, stated.line) + ": count is " + std::to_string(count) +
                     " but [fiducial" + std::to_string(count) +
                     "] follows; expected as many fiducials as count");
  }
  tool.marker_count = count;
  tool.marker_radius_m = 1e-3 * k_passive_sphere_radius_mm;
  if (has_section(entries, "pivot")) tool.tip_m = point_in(entries, "pivot", path);
  return prepared(tool, place_of(path, stated.line));
}

}  // namespace glint
