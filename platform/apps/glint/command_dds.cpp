// glint dds: keys and signed documents of DDS Security for a run and its peers.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/cells/cell.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/dds/security_keys.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_day_s = 24 * 3600;

struct KeyArguments {
  std::string config, name, out = "keys";
  std::vector<std::string> peers;
  int days = 365;
};

// A right of a peer: the name of an input, or a ROS topic.
void add_right(const std::string& option, const std::string& right, PeerRights& peer) {
  const auto found = std::find(k_dds_input_names.begin(), k_dds_input_names.end(), right);
  if (found != k_dds_input_names.end()) {
    peer.inputs.push_back(static_cast<DdsInput>(found - k_dds_input_names.begin()));
    return;
  }
  const std::string topic = right.starts_with('/') ? dds_topic(right) : "";
  if (!topic.empty()) {
    peer.topics.push_back(topic);
    return;
  }
  std::string expected;
  for (const char* name : k_dds_input_names) expected += std::string(name) + ", ";
  throw InputError("--peer " + option + ": \"" + right + "\"; expected " + expected +
                   "or a topic as /camera/image");
}

// NAME or NAME:RIGHT,RIGHT
PeerRights peer_of(const std::string& option) {
  const std::size_t colon = option.find(':');
  PeerRights peer{option.substr(0, colon), {}, {}};
  std::istringstream rights(colon == std::string::npos ? "" : option.substr(colon + 1));
  for (std::string right; std::getline(rights, right, ',');) add_right(option, right, peer);
  return peer;
}

int write_keys(const KeyArguments& arguments) {
  const Cell cell = cell_or_default(arguments.config);
  const std::int64_t now = std::time(nullptr);
  const int of_source = cell.source.domain.value_or(cell.dds.domain);
  const auto [first, last] = std::minmax(cell.dds.domain, of_source);
  KeySettings settings{arguments.out,
                       {first, last, arguments.name.empty() ? cell.dds.name : arguments.name, {}},
                       {}};
  // A board's clock may be late.
  settings.scope.validity = {now - k_day_s, now + arguments.days * k_day_s};
  for (const std::string& peer : arguments.peers) settings.peers.push_back(peer_of(peer));
  for (const std::string& folder : write_security_keys(settings)) {
    std::printf("written  %s\n", printable(folder).c_str());
  }
  std::printf("domains  %d to %d\nvalid    %d days\n", settings.scope.first_domain,
              settings.scope.last_domain, arguments.days);
  return 0;
}

void add_keys(CLI::App& parent, int& exit_code) {
  CLI::App* command = parent.add_subcommand(
      "keys", "Keys, certificates and rights of DDS Security for a run and its peers");
  auto arguments = std::make_shared<KeyArguments>();
  command->footer(
      "Example: glint dds keys --out keys --peer viewer --peer panel:buttons,tools\n"
      "The run's cell then has, in [dds]: security = \"keys/enclaves/glint\". A ROS 2 node reads\n"
      "its folder with ROS_SECURITY_KEYSTORE=keys and --enclave /viewer. Copy a participant's own\n"
      "folder to its machine only; keys/private signs all others and stays. A second call keeps\n"
      "existing keys: it adds peers, changes rights and extends the validity.");
  command->add_option("--out", arguments->out, "folder of the keys")->capture_default_str();
  command
      ->add_option(
          "--peer", arguments->peers,
          "peer that may receive all; NAME:INPUT,.. may send these inputs too, named as in "
          "[dds] allow, or topics as /camera/image; repeatable")
      ->allow_extra_args(false);
  command->add_option("--name", arguments->name, "as of `glint run`; default: the cell's");
  command->add_option("--days", arguments->days, "validity")
      ->check(in_range(1, 3650))
      ->capture_default_str();
  add_cell_option(*command, arguments->config, "cell file, for its domains and [dds] name");
  command->callback([arguments, &exit_code] { exit_code = write_keys(*arguments); });
}

}  // namespace

void add_dds(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("dds", "Keys and rights of the participants on DDS");
  command->require_subcommand(1);
  command->footer("Example: glint dds keys --out keys --peer viewer");
  add_keys(*command, exit_code);
}

}  // namespace glint
