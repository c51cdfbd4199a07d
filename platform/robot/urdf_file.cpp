#include "platform/robot/urdf_file.hpp"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::uintmax_t k_urdf_bytes_max = 16u << 20;
constexpr int k_nesting_max = 64;  // the XML reader calls itself for every level

// What urdfdom complains of, in place of its lines on stderr.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  [[nodiscard]] std::string first() const {
    return first_.empty() ? "no robot description" : first_;
  }

 private:
  std::string first_;
};

std::string text_of(const std::string& path) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  std::ifstream file(path, std::ios::binary);
  if (failed || !file) throw InputError(path + ": cannot be opened; expected a URDF file");
  if (size > k_urdf_bytes_max) {
    throw InputError(path + ": " + std::to_string(size) + " bytes; expected a URDF of at most " +
                     std::to_string(k_urdf_bytes_max));
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void check_nesting(const std::string& text, const std::string& path) {
  int depth = 0, line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') ++line;
    if (text.compare(i, 4, "<!--") == 0) {
      const std::size_t end = text.find("-->", i);
      if (end == std::string::npos) break;
      i = end;
    } else if (text[i] == '<' && i + 1 < text.size()) {
      if (text[i + 1] == '/')
        --depth;
      else if (text[i + 1] != '?' && text[i + 1] != '!')
        ++depth;
    } else if (text[i] == '/' && i + 1 < text.size() && text[i + 1] == '>') {
      --depth;
    }
    if (depth > k_nesting_max) {
      throw InputError(path + ":" + std::to_string(line) + ": elements nested more than " +
                       std::to_string(k_nesting_max) + " deep; expected a URDF");
    }
  }
}

std::vector<std::string> joints_of(const std::string& text, const std::string& path) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error()) {
    throw InputError(path + ":" + std::to_string(document.ErrorRow()) + ": " +
                     document.ErrorDesc() + "; expected a URDF");
  }
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) throw InputError(path + ": no <robot> element; expected a URDF");
  std::vector<std::string> joints;
  for (const TiXmlElement* joint = robot->FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char* name = joint->Attribute("name");
    joints.emplace_back(name == nullptr ? "" : name);
  }
  return joints;
}

// Each link hangs on one joint at most, and going up ends at a link that hangs on none. Told by
// the file alone: urdfdom takes the last of two parents and says nothing.
void check_tree(const std::string& text, const std::string& path) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  std::map<std::string, std::string> parent, by;
  for (const TiXmlElement* joint = document.FirstChildElement("robot")->FirstChildElement("joint");
       joint != nullptr; joint = joint->NextSiblingElement("joint")) {
    const TiXmlElement* from = joint->FirstChildElement("parent");
    const TiXmlElement* to = joint->FirstChildElement("child");
    const char* from_link = from == nullptr ? nullptr : from->Attribute("link");
    const char* to_link = to == nullptr ? nullptr : to->Attribute("link");
    const char* name = joint->Attribute("name");
    if (from_link == nullptr || to_link == nullptr || name == nullptr) continue;
    if (parent.count(to_link) != 0) {
      throw InputError(path + ":" + std::to_string(joint->Row()) + ": link '" + to_link +
                       "' is the child of joint '" + by[to_link] + "' and of '" + name +
                       "'; expected a tree, not a loop");
    }
    parent[to_link] = from_link;
    by[to_link] = name;
  }
  for (const auto& [link, above] : parent) {
    std::string at = link;
    for (std::size_t steps = 0; parent.count(at) != 0; ++steps) {
      if (steps > parent.size()) {
        throw InputError(path + ": the joints above link '" + link +
                         "' form a loop; expected a tree");
      }
      at = parent[at];
    }
  }
}

}  // namespace

UrdfFile read_urdf(const std::string& path) { return read_urdf_text(text_of(path), path); }

UrdfFile read_urdf_text(const std::string& text, const std::string& from) {
  check_nesting(text, from);
  UrdfFile file;
  file.joints = joints_of(text, from);
  check_tree(text, from);
  Complaints complaints;
  try {
    file.model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    throw InputError(from + ": " + error.what());
  }
  if (!file.model) throw InputError(from + ": " + complaints.first());
  return file;
}

}  // namespace glint
