#include "platform/apps/glint/publishing.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "platform/in_range.hpp"

namespace glint {
namespace {

constexpr auto k_poll_period = std::chrono::milliseconds(50);
constexpr Duration k_receipts_limit = milliseconds(5000);

}  // namespace

void add_network_options(CLI::App& command, DdsSettings& settings) {
  command.add_option("--dds-interface", settings.interface, "network interface")
      ->capture_default_str();
  command.add_option("--dds-domain", settings.domain, "ROS_DOMAIN_ID")
      ->check(in_range(0, 232))
      ->capture_default_str();
  command.add_option("--dds-name", settings.name, "namespace of the topics; default: none");
  command.add_option("--dds-security", settings.security,
                     "folder of `glint dds keys`; default: no DDS Security");
}

void add_publish_options(CLI::App& command, PublishOptions& options) {
  command
      .add_option("--dds", options.seconds,
                  "seconds of publication over DDS, also for late subscribers")
      ->check(in_range(0.1, 86400.0));
  add_network_options(command, options.settings);
}

Time publishing_time() { return Time{dds_time()}; }

void keep_publishing(const MapPublisher& publisher, const PublishOptions& options) {
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  int readers_max = 0;
  while (std::chrono::steady_clock::now() < end) {
    readers_max = std::max(readers_max, publisher.matched_readers());
    std::this_thread::sleep_for(k_poll_period);
  }
  const bool all_acknowledged = publisher.wait_for_acknowledgements(k_receipts_limit);
  std::printf("published  %.1f s, subscribers of every topic %d%s\n", options.seconds, readers_max,
              all_acknowledged ? "" : "; not all have received every message");
}

}  // namespace glint
