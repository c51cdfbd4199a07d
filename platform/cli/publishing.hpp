// --dds SECONDS: what a command made, published for so long.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/dds/surroundings_publisher.hpp"

namespace glint {

struct PublishOptions {
  double seconds = 0;  // 0: nothing is published
  DdsSettings settings;
};

// --dds-interface, --dds-domain.
void add_network_options(CLI::App& command, DdsSettings& settings);

void add_publish_options(CLI::App& command, PublishOptions& options);

// Now, on the clock that stamps messages.
[[nodiscard]] Time publishing_time();

// Stays so long, that listeners who come later are served too; ends with how many there were.
void keep_publishing(const SurroundingsPublisher& publisher, const PublishOptions& options);

}  // namespace glint
