#include "platform/apps/glint/replay_view.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "platform/apps/glint/view_option.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/stop_signals.hpp"

namespace glint {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr auto k_wait_step = std::chrono::milliseconds(20);  // a signal is noticed within it

// Returns false if a signal came first.
bool wait_until(SteadyClock::time_point due, const std::atomic<bool>& stop) {
  for (SteadyClock::time_point now = SteadyClock::now(); now < due; now = SteadyClock::now()) {
    if (stop) return false;
    std::this_thread::sleep_for(std::min<SteadyClock::duration>(due - now, k_wait_step));
  }
  return !stop;
}

bool wait_for_client(const FoxgloveServer& server, const std::atomic<bool>& stop) {
  std::printf("waiting for the first client\n");
  std::fflush(stdout);
  while (server.counts().clients == 0 && !stop) std::this_thread::sleep_for(k_wait_step);
  return !stop;
}

}  // namespace

ViewedRecording view_recording(const std::string& path, const ReadTolerance& tolerance,
                               const FoxgloveSettings& settings, double speed) {
  const std::atomic<bool>& stop = stop_on_signals();
  McapReader reader(path, tolerance.truncated ? McapEnding::optional : McapEnding::required);
  const std::unique_ptr<FoxgloveServer> server = start_view(settings);
  ViewedRecording result;
  result.stopped = !wait_for_client(*server, stop);
  const SteadyClock::time_point begin = SteadyClock::now();
  std::optional<std::uint64_t> first_ns;
  std::set<std::uint16_t> channels;
  while (!result.stopped) {
    const std::optional<McapMessage> message = reader.next();
    if (!message) break;
    const auto& [channel, schema, heading, payload, offset] = *message;
    if (channel->encoding != "cdr" || schema == nullptr) {
      ++result.skipped;
      continue;
    }
    if (channels.insert(channel->id).second) {
      server->add_channel(channel->id, channel->topic, schema->name, schema->text);
    }
    if (!first_ns) first_ns = heading.log_time;
    // Messages of several threads: an earlier time may follow a later one.
    const auto passed_ns = static_cast<std::int64_t>(heading.log_time - *first_ns);
    const double seconds = static_cast<double>(std::max<std::int64_t>(0, passed_ns)) * 1e-9;
    result.seconds = std::max(result.seconds, seconds);
    const std::chrono::duration<double> due(seconds / speed);
    result.stopped =
        !wait_until(begin + std::chrono::duration_cast<SteadyClock::duration>(due), stop);
    if (result.stopped) break;
    server->add_message(channel->id, heading.log_time, payload);
    ++result.messages;
  }
  server->close();
  result.lost = !result.stopped && reader.losses().any();
  result.view = server->counts();
  return result;
}

}  // namespace glint
