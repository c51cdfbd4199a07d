// glint_dds_reader: receives all messages of a Glint sink and reports received and missed ones.
//   glint_dds_reader --interface lo --domain 0 --prefix glint --tool pen --out reader.json
// Ends when the sink has left, on SIGTERM or SIGINT, or if it finds no sink within the limit. Exit
// codes: 0 success, 2 wrong usage or input, 3 missing network interface or no sink found.
#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/dds/status_reader.hpp"

namespace {

volatile std::sig_atomic_t end_requested = 0;
void request_end(int) { end_requested = 1; }

void end_on_signals() {
  std::signal(SIGTERM, request_end);
  std::signal(SIGINT, request_end);
  sigset_t signals;  // the parent process may have blocked them
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

constexpr glint::Duration k_wait = glint::milliseconds(50);

bool read_until_end(glint::StatusReader& reader, double search_s) {
  const dds_time_t search_end = dds_time() + static_cast<dds_time_t>(search_s * 1e9);
  while (end_requested == 0) {
    // Queried before reading: all messages written before are then read below.
    const glint::StatusReader::Sinks sinks = reader.sinks();
    const bool left = sinks.found && !sinks.present;
    reader.read(left ? glint::Duration{} : k_wait);
    if (left) return true;
    if (!sinks.found && dds_time() > search_end) return false;
  }
  reader.read(glint::Duration{});
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  glint::DdsSettings settings;
  std::string out;
  double search_s = 30;
  CLI::App app{
      "Reads a Glint sink's topics and counts received and missed samples.\n"
      "Example: glint_dds_reader --interface lo --tool pen --out reader.json"};
  app.add_option("--interface", settings.interface, "network interface")->capture_default_str();
  app.add_option("--domain", settings.domain, "DDS domain, ROS_DOMAIN_ID")->capture_default_str();
  app.add_option("--prefix", settings.topic_prefix, "prefix of the topics")->capture_default_str();
  app.add_option("--name", settings.name, "namespace of the topics; default: none");
  app.add_option("--tool", settings.tool_names, "tool name; repeatable")->expected(1, 16);
  app.add_option("--peer", settings.peers, "address of the sink; repeatable");
  app.add_option("--security", settings.security, "folder with keys and documents");
  app.add_option("--search", search_s, "seconds to search for a sink")
      ->capture_default_str()
      ->check(glint::in_range(0.0, 86400.0));
  app.add_option("--out", out, "JSON file of the result")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  end_on_signals();
  try {
    glint::StatusReader reader(settings);
    const bool found = read_until_end(reader, search_s);
    glint::save_result(reader.result(), out);
    if (found) return 0;
    std::cerr << "dds: no sink found in " << search_s << " s on interface "
              << settings.interface << ", domain " << settings.domain
              << "; expected a running glint\n";
    return 3;
  } catch (const glint::MissingDevice& error) {
    std::cerr << error.what() << '\n';
    return 3;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
