#include "platform/apps/glint/publishing.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "platform/in_range.hpp"

namespace glint {
namespace {

constexpr auto k_look_again = std::chrono::milliseconds(50);
constexpr Duration k_receipts_limit = milliseconds(5000);

}  // namespace

void add_network_options(CLI::App& command, DdsSettings& settings) {
  command.add_option("--dds-interface", settings.interface, "network interface")
      ->capture_default_str();
  command.add_option("--dds-domain", settings.domain, "ROS_DOMAIN_ID")
      ->check(in_range(0, 232))
      ->capture_default_str();
}

void add_publish_options(CLI::App& command, PublishOptions& options) {
  command
      .add_option("--dds", options.seconds,
                  "publish it over DDS for so many seconds, for listeners that come later too")
      ->check(in_range(0.1, 86400.0));
  add_network_options(command, options.settings);
}

Time publishing_time() { return Time{dds_time()}; }

void keep_publishing(const SurroundingsPublisher& publisher, const PublishOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  int most = 0;
  while (Clock::now() < end) {
    most = std::max(most, publisher.listeners());
    std::this_thread::sleep_for(k_look_again);
  }
  const bool all = publisher.wait_for_receipts(k_receipts_limit);
  std::printf("published  %.1f s, listeners to every topic %d%s\n", options.seconds, most,
              all ? "" : "; not all have received everything");
}

}  // namespace glint
