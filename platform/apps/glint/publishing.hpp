// Option --dds SECONDS: publishes the results of a command for this time.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/sinks/dds/surroundings_publisher.hpp"

namespace glint {

struct PublishOptions {
  double seconds = 0;  // 0: publishes nothing
  DdsSettings settings;
};

// --dds-interface, --dds-domain, --dds-name, --dds-security.
void add_network_options(CLI::App& command, DdsSettings& settings);

void add_publish_options(CLI::App& command, PublishOptions& options);

// Current time on the clock of the messages' time stamps.
[[nodiscard]] Time publishing_time();

// Waits for options.seconds, so that late subscribers are served too; prints their largest number.
void keep_publishing(const MapPublisher& publisher, const PublishOptions& options);

}  // namespace glint
