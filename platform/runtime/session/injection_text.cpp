#include "platform/runtime/session/node_probe.hpp"

#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>

#include "graph/describe.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_delay_max_us = 10'000'000;
constexpr std::int64_t k_at_max = std::numeric_limits<std::int64_t>::max();

template <class G>
int number_of(const std::string& name) {
  int number = 0;
  for (const graph::NodeInfo& node : graph::Description<G>::nodes) {
    const std::string plain(node.name);
    const std::string copy = plain + "#" + std::to_string(node.copy);
    if (name == copy || (node.copy == 0 && name == plain)) return number;
    ++number;
  }
  return -1;
}

template <class G>
std::string names() {
  std::string text;
  for (const graph::NodeInfo& node : graph::Description<G>::nodes) {
    if (node.copy == 0) text += (text.empty() ? "" : ", ") + std::string(node.name);
  }
  return text;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("--inject " + text + ": " + why);
}

std::int64_t whole_number(const std::string& text, const std::string& key, const std::string& value,
                          std::int64_t high) {
  char* end = nullptr;
  const long long number = std::strtoll(value.c_str(), &end, 10);
  if (value.empty() || *end != '\0' || number < 0 || number > high) {
    refuse(text, key + " is \"" + value + "\"; expected 0 to " + std::to_string(high));
  }
  return number;
}

}  // namespace

Injection injection_of(const std::string& text) {
  std::map<std::string, std::string> values;
  std::stringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    if (equals == std::string::npos ||
        (key != "node" && key != "delay_us" && key != "frame" && key != "tick") ||
        !values.emplace(key, part.substr(equals + 1)).second) {
      refuse(text, "found \"" + part + "\"; expected node=NAME,delay_us=N and frame=N or tick=N");
    }
  }
  if (values.count("node") == 0 || values.count("delay_us") == 0 ||
      values.count("frame") + values.count("tick") != 1) {
    refuse(text, "expected node=NAME,delay_us=N and either frame=N or tick=N");
  }
  Injection injection;
  injection.node = values["node"];
  injection.in_tick = values.count("tick") == 1;
  const std::string at_key = injection.in_tick ? "tick" : "frame";
  injection.number =
      injection.in_tick ? number_of<Output>(injection.node) : number_of<Tracker>(injection.node);
  if (injection.number < 0) {
    refuse(text, "no node \"" + injection.node + "\" in the " + at_key +
                     " group; expected one of " +
                     (injection.in_tick ? names<Output>() : names<Tracker>()));
  }
  injection.at = static_cast<std::uint64_t>(whole_number(text, at_key, values[at_key], k_at_max));
  injection.delay =
      microseconds(whole_number(text, "delay_us", values["delay_us"], k_delay_max_us));
  return injection;
}

}  // namespace glint
