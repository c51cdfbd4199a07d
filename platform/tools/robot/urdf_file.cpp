#include "platform/tools/robot/urdf_file.hpp"

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "kernels/robot/joint_tree.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr std::size_t k_urdf_bytes_max = 16u << 20;
constexpr int k_nesting_max = 64;     // XML parsers recurse per level; a URDF has five
constexpr int k_attributes_max = 64;  // per element

// Captures urdfdom's error messages instead of printing them to stderr.
class UrdfErrors : public console_bridge::OutputHandler {
 public:
  UrdfErrors() { console_bridge::useOutputHandler(this); }
  ~UrdfErrors() override { console_bridge::restorePreviousOutputHandler(); }
  UrdfErrors(const UrdfErrors&) = delete;
  UrdfErrors& operator=(const UrdfErrors&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  [[nodiscard]] std::string first() const {
    return first_.empty() ? "no robot description" : first_;
  }

 private:
  std::string first_;
};

[[noreturn]] void refuse(const std::string& path, int line, const std::string& found) {
  throw InputError(path + ":" + std::to_string(line) + ": " + found + "; expected a URDF");
}

[[noreturn]] void refuse_nesting(const std::string& path, int line) {
  refuse(path, line, "elements nested more than " + std::to_string(k_nesting_max) + " deep");
}

// tinyxml2 limits the depth while parsing (XML_ELEMENT_DEPTH_EXCEEDED).
void parse(const std::string& text, const std::string& path, tinyxml2::XMLDocument& document) {
  const tinyxml2::XMLError error = document.Parse(text.data(), text.size());
  if (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    refuse_nesting(path, document.ErrorLineNum());
  }
  if (error != tinyxml2::XML_SUCCESS) {
    refuse(path, document.ErrorLineNum(), std::string("no XML: ") + document.ErrorName());
  }
}

// Normalises an attribute value by XML 1.0, section 3.3.3.
std::string blanks_for_breaks(std::string value) {
  for (char& c : value) c = c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
  return value;
}

bool is_plain_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto later = [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || std::string_view("_:.-").find(c) < 4;
  };
  return !name.empty() && (letter(name[0]) || name[0] == '_') &&
         std::all_of(name.begin(), name.end(), later);
}

// Rewrites only elements and attributes. urdfdom's parser recognises tags differently from tinyxml2
// (in comments, CDATA, a DOCTYPE, attributes) and recurses without a limit. In this text both find
// the same elements.
class PlainCopy : public tinyxml2::XMLVisitor {
 public:
  explicit PlainCopy(const std::string& path) : path_(path) {}

  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* attribute) override {
    if (++depth_ > k_nesting_max) refuse_nesting(path_, element.GetLineNum());
    check_name(element.Name(), element);
    text_.append(1, '<').append(element.Name());
    for (int count = 0; attribute != nullptr; attribute = attribute->Next()) {
      // urdfdom's parser compares each attribute with all previous ones.
      if (++count > k_attributes_max) {
        refuse(path_, element.GetLineNum(),
               "an element with more than " + std::to_string(k_attributes_max) + " attributes");
      }
      check_name(attribute->Name(), element);
      text_.append(1, ' ').append(attribute->Name());
      text_.append("=\"").append(printable_markup(blanks_for_breaks(attribute->Value())));
      text_.append(1, '"');
    }
    text_.append(">\n");
    return true;
  }
  bool VisitExit(const tinyxml2::XMLElement& element) override {
    --depth_;
    text_.append("</").append(element.Name()).append(">\n");
    return true;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void check_name(const char* name, const tinyxml2::XMLElement& element) const {
    if (!is_plain_name(name)) {
      refuse(path_, element.GetLineNum(), "the name '" + std::string(name).substr(0, 40) + "'");
    }
  }

  const std::string& path_;
  std::string text_;
  int depth_ = 0;
};

std::vector<std::string> joints_of(const tinyxml2::XMLElement& robot, const std::string& path) {
  std::vector<std::string> joints;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    if (joints.size() == static_cast<std::size_t>(k_robot_joints_max)) {
      throw InputError(path + ":" + std::to_string(joint->GetLineNum()) + ": more than " +
                       std::to_string(k_robot_joints_max) + " joints");
    }
    const char* name = joint->Attribute("name");
    joints.push_back(name == nullptr ? "" : printable(blanks_for_breaks(name)));
  }
  return joints;
}

// Requires that each link is the child of at most one joint and that its ancestors end at the root.
// Checks the file itself: of two parents urdfdom keeps the last without an error.
void check_tree(const tinyxml2::XMLElement& robot, const std::string& path) {
  std::map<std::string, std::string> parent, by;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const auto* from = joint->FirstChildElement("parent");
    const auto* to = joint->FirstChildElement("child");
    const char* from_link = from == nullptr ? nullptr : from->Attribute("link");
    const char* to_link = to == nullptr ? nullptr : to->Attribute("link");
    const char* name = joint->Attribute("name");
    if (from_link == nullptr || to_link == nullptr || name == nullptr) continue;
    if (parent.count(to_link) != 0) {
      throw InputError(path + ":" + std::to_string(joint->GetLineNum()) + ": link '" + to_link +
                       "' is the child of joint '" + by[to_link] + "' and of '" + name +
                       "'; expected a tree");
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

UrdfFile read_urdf(const std::string& path) {
  return read_urdf_text(read_file(path, k_urdf_bytes_max, "a URDF file"), path);
}

UrdfFile read_urdf_text(const std::string& text, const std::string& from) {
  tinyxml2::XMLDocument document;
  parse(text, from, document);
  const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) throw InputError(from + ": no <robot> element; expected a URDF");
  PlainCopy copy(from);
  robot->Accept(&copy);
  UrdfFile file;
  file.joints = joints_of(*robot, from);
  check_tree(*robot, from);
  UrdfErrors errors;
  try {
    file.model = urdf::parseURDF(copy.text());
  } catch (const std::exception& error) {
    throw InputError(from + ": " + error.what());
  }
  if (!file.model) throw InputError(from + ": " + errors.first());
  return file;
}

}  // namespace glint
