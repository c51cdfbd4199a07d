#include "platform/tools/robot/joint_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

struct Position {
  std::string name;  // empty: by order
  double value = 0;
  std::string where;  // file and line or index
};

std::optional<double> number_of(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0') return {};
  return value;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words(1);
  for (const char c : line.substr(0, line.find('#'))) {
    if (std::isspace(static_cast<unsigned char>(c)) || std::string_view(",:=[]\"'").find(c) < 8) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::vector<Position> text_positions(const std::string& path) {
  std::istringstream file(read_file(path, k_text_bytes_max, "joint positions"));
  std::vector<Position> positions;
  std::string line, name;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string where = path + ":" + std::to_string(number);
    for (const std::string& word : words_of(line)) {
      const std::optional<double> value = number_of(word);
      if (!value && !name.empty()) {
        throw InputError(where + ": '" + word + "' is not a number; expected the position of '" +
                         name + "'");
      }
      if (value) positions.push_back({name, *value, where});
      name = value ? "" : word;
      if (positions.size() > k_robot_joints_max) {
        throw InputError(where + ": more than " + std::to_string(k_robot_joints_max) +
                         " positions");
      }
    }
  }
  if (!name.empty()) throw InputError(path + ": '" + name + "' at the end has no number");
  return positions;
}

std::vector<Position> npy_positions(const std::string& path) {
  std::vector<Position> positions;
  for (const double value : read_npy_numbers(path).values) {
    positions.push_back({"", value, path + ": value " + std::to_string(positions.size())});
  }
  return positions;
}

void check_count(const std::string& path, std::size_t found,
                 const std::vector<std::string>& inputs) {
  if (found == inputs.size()) return;
  std::string names;
  for (const std::string& name : inputs) names += (names.empty() ? "" : ", ") + name;
  throw InputError(path + ": " + std::to_string(found) + " positions; expected " +
                   std::to_string(inputs.size()) + ": " + names);
}

}  // namespace

std::vector<double> read_joint_positions(const std::string& path,
                                         const std::vector<std::string>& inputs) {
  const bool npy = path.size() > 4 && path.compare(path.size() - 4, 4, ".npy") == 0;
  const std::vector<Position> found = npy ? npy_positions(path) : text_positions(path);
  std::vector<double> values(inputs.size(), 0);
  std::vector<bool> set(values.size(), false);
  const bool named =
      std::any_of(found.begin(), found.end(), [](const Position& p) { return !p.name.empty(); });
  if (!named) check_count(path, found.size(), inputs);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Position& position = found[i];
    std::size_t at = i;
    if (named) {
      const auto input = std::find(inputs.begin(), inputs.end(), position.name);
      if (input == inputs.end()) {
        throw InputError(position.where + ": the robot has no joint '" + position.name +
                         "' with its own position");
      }
      at = static_cast<std::size_t>(input - inputs.begin());
      if (set[at]) throw InputError(position.where + ": '" + position.name + "' occurs twice");
    }
    if (!(std::abs(position.value) <= k_joint_position_max)) {
      throw InputError(position.where + ": " + std::to_string(position.value) +
                       "; expected a finite position in radians or metres");
    }
    values[at] = position.value;
    set[at] = true;
  }
  const auto missing = std::find(set.begin(), set.end(), false);
  if (missing != set.end()) {
    throw InputError(path + ": no position for joint '" +
                     inputs[static_cast<std::size_t>(missing - set.begin())] + "'");
  }
  return values;
}

}  // namespace glint
