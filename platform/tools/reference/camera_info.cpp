#include "platform/tools/reference/camera_info.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr int k_lines_max = 10'000;
constexpr int k_side_max = 16'384;

// The YAML subset of such files: "key: value", lists as [a, b] or as lines "- a".
struct Entry {
  std::string text;
  std::vector<double> numbers;
  int line = 0;
};
using Entries = std::map<std::string, Entry>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\"'");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\"'") - first + 1);
}

void add_numbers(const std::string& text, Entry& entry) {
  std::string word;
  for (const char c : text + " ") {
    if (std::isspace(static_cast<unsigned char>(c)) || c == '[' || c == ']' || c == ',') {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (!word.empty() && *end == '\0') entry.numbers.push_back(value);
      word.clear();
    } else {
      word += c;
    }
  }
}

// Joins the names of nested keys: camera_matrix/data.
Entries entries_of(const std::string& path) {
  std::istringstream file(read_file(path, k_text_bytes_max, "a camera_info YAML file"));
  Entries entries;
  std::string line, above, key;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number > k_lines_max) throw InputError(path + ": too long for a camera_info file");
    line = line.substr(0, line.find('#'));
    const std::string content = trimmed(line);
    if (content.empty() || content == "---" || content == "...") continue;
    const bool indented = std::isspace(static_cast<unsigned char>(line[0])) != 0;
    const std::size_t colon = content.find(':');
    const bool item = content[0] == '-' && (content.size() == 1 || content[1] == ' ');
    if (item || colon == std::string::npos) {
      if (!key.empty()) add_numbers(item ? content.substr(1) : content, entries[key]);
      continue;
    }
    const std::string name = trimmed(content.substr(0, colon));
    if (!indented) above = name;
    key = indented ? above + "/" + name : name;
    entries[key].text = trimmed(content.substr(colon + 1));
    entries[key].line = number;
    add_numbers(entries[key].text, entries[key]);
  }
  return entries;
}

const Entry* find(const Entries& entries, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto found = entries.find(name);
    if (found != entries.end()) return &found->second;
  }
  return nullptr;
}

int side(const Entries& entries, const std::string& path, const char* upright, const char* other) {
  const Entry* entry = find(entries, {upright, other});
  if (entry == nullptr) throw InputError(path + ": no " + std::string(upright));
  if (entry->numbers.size() != 1 || !(entry->numbers[0] >= 1 && entry->numbers[0] <= k_side_max)) {
    throw InputError(path + ":" + std::to_string(entry->line) + ": " + upright + " '" +
                     entry->text + "'; expected pixels from 1 to " + std::to_string(k_side_max));
  }
  return static_cast<int>(entry->numbers[0]);
}

}  // namespace

CameraModel read_camera_info(const std::string& path) {
  const Entries entries = entries_of(path);
  CameraModel camera;
  camera.width = side(entries, path, "width", "image_width");
  camera.height = side(entries, path, "height", "image_height");
  const Entry* k = find(entries, {"k", "K", "camera_matrix/data", "camera_matrix"});
  if (k == nullptr || k->numbers.size() != 9) {
    throw InputError(path + (k == nullptr ? "" : ":" + std::to_string(k->line)) +
                     ": expected k with 9 numbers, row by row");
  }
  camera.fx = k->numbers[0];
  camera.fy = k->numbers[4];
  camera.cx = k->numbers[2] + 0.5;
  camera.cy = k->numbers[5] + 0.5;
  if (!(camera.fx > 0 && camera.fy > 0) || !std::isfinite(camera.cx + camera.cy) ||
      !std::isfinite(camera.fx + camera.fy)) {
    throw InputError(path + ":" + std::to_string(k->line) +
                     ": k has no focal length; expected fx, 0, cx, 0, fy, cy, 0, 0, 1");
  }
  const Entry* d = find(entries, {"d", "D", "distortion_coefficients/data"});
  bool distorted = false;
  for (std::size_t i = 0; d != nullptr && i < d->numbers.size(); ++i) {
    distorted = distorted || d->numbers[i] != 0;
    if (i < camera.distortion.size()) camera.distortion[i] = d->numbers[i];
  }
  if (!distorted) return camera;
  const Entry* model = find(entries, {"distortion_model"});
  const std::string name = model == nullptr ? "" : model->text;
  const bool brown = name == "plumb_bob" && d->numbers.size() <= 5;
  const bool rational = name == "rational_polynomial" && d->numbers.size() == 8;
  if (!brown && !rational) {
    throw InputError(path + ":" + std::to_string(d->line) + ": distortion model '" + name +
                     "' with " + std::to_string(d->numbers.size()) +
                     " coefficients; expected plumb_bob with 5 or rational_polynomial with 8");
  }
  camera.lens = brown ? Lens::brown : Lens::rational;
  return camera;
}

std::string read_camera_frame(const std::string& path) {
  const Entries entries = entries_of(path);
  const Entry* frame = find(entries, {"header/frame_id"});
  return frame == nullptr ? "" : frame->text;
}

}  // namespace glint
