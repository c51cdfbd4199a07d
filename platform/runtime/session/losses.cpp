#include "platform/runtime/session/losses.hpp"

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "platform/runtime/rt/loss_counters.hpp"

namespace glint {
namespace {

// Adds "disk full" to the system's message if that is the cause.
std::string cause(const std::string& words) {
  const std::string full = std::generic_category().message(ENOSPC);
  return words.find(full) == std::string::npos ? words : "disk full: " + words;
}

std::string counted(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

class Losses {
 public:
  void add(LossKind kind, std::uint64_t count, const std::string& text) {
    add(name_of(kind), count, text);
  }
  void add(std::string_view kind, std::uint64_t count, const std::string& text) {
    items_.push_back({std::string(kind), count, text});
  }
  [[nodiscard]] std::vector<Loss> take() { return std::move(items_); }

 private:
  std::vector<Loss> items_;
};

void add_can(const CanSinkCounts& can, Losses& losses) {
  if (can.dropped > 0) {
    losses.add(LossKind::can, can.dropped,
               counted(can.dropped, "frames dropped, queue full: the bus or the disk is too slow"));
  }
  if (can.bus.bus_off > 0) {
    losses.add(LossKind::can, can.bus.bus_off,
               counted(can.bus.bus_off, "times off the bus: frames were lost until it restarted"));
  }
  if (can.failed > 0) {
    losses.add(LossKind::can, can.failed,
               counted(can.failed, "frames refused: ") +
                   cause(std::generic_category().message(can.error)));
  }
}

void add_dds(const SinkOutcome& outcome, Losses& losses) {
  const DdsCounts& dds = outcome.dds;
  if (dds.ring_dropped > 0) {
    losses.add(
        LossKind::dds, dds.ring_dropped,
        counted(dds.ring_dropped,
                "samples not published: queue full, or the DDS process refused or lost them"));
  }
  if (dds.poses_and_transforms_lost > 0) {
    losses.add(LossKind::dds, dds.poses_and_transforms_lost,
               counted(dds.poses_and_transforms_lost, "other messages not published"));
  }
  if (dds.process_restarts > 0) {
    losses.add(LossKind::dds, 0,
               "the DDS process " + outcome.dds_process_end + "; restarted " +
                   std::to_string(dds.process_restarts) + " times");
  }
  // The reader also misses what the DDS process lost, which is counted above.
  if (outcome.dds_was_read && outcome.dds_reader.missed > dds.process_lost) {
    const std::uint64_t missed = outcome.dds_reader.missed - dds.process_lost;
    losses.add(LossKind::dds, missed, counted(missed, "samples written but not received"));
  }
  if (outcome.dds_received.lost > 0) {
    losses.add(LossKind::dds, outcome.dds_received.lost,
               counted(outcome.dds_received.lost, "received messages overwritten: read too late"));
  }
  if (!outcome.dds_reader_error.empty()) {
    losses.add(LossKind::dds, 0, "received count unknown: " + outcome.dds_reader_error);
  }
}

void add_recording(const RecordingOutcome& recording, Losses& losses) {
  if (recording.dropped > 0) {
    losses.add(LossKind::recording, recording.dropped,
               counted(recording.dropped, "messages dropped, queue full"));
  }
  if (recording.ended_early) {
    losses.add(LossKind::recording, recording.lost,
               counted(recording.lost, "messages not written: ") + cause(recording.reason));
  }
}

void add_headset(const HeadsetCounts& headset, Losses& losses) {
  constexpr std::string_view k_kind = "headset";
  if (headset.clients == 0) losses.add(k_kind, 0, "no client connected");
  if (headset.not_taken > 0) {
    losses.add(
        k_kind, headset.not_taken,
        counted(headset.not_taken, "messages replaced by newer ones: a client reads slowly"));
  }
  if (headset.queue_full > 0) {
    losses.add(k_kind, headset.queue_full,
               counted(headset.queue_full, "samples not taken, queue full"));
  }
}

void add_openigtlink(const OpenIgtLinkCounts& counts, Losses& losses) {
  constexpr std::string_view k_kind = "OpenIGTLink";
  if (counts.missed > 0) {
    losses.add(k_kind, counts.missed,
               counted(counts.missed, "messages not sent: a client reads too slowly"));
  }
  if (counts.ring_dropped > 0) {
    losses.add(k_kind, counts.ring_dropped,
               counted(counts.ring_dropped, "samples not taken, queue full"));
  }
}

}  // namespace

std::vector<Loss> losses_of(const SinkOutcome& outcome) {
  Losses losses;
  add_can(outcome.can, losses);
  add_dds(outcome, losses);
  add_recording(outcome.recording, losses);
  if (outcome.files_lost > 0 || !outcome.files_error.empty()) {
    const std::string why = outcome.files_error.empty() ? "queue full" : cause(outcome.files_error);
    losses.add(LossKind::files, outcome.files_lost,
               counted(outcome.files_lost, "lines not written: ") + why);
  }
  if (outcome.headset) add_headset(*outcome.headset, losses);
  if (outcome.openigtlink) add_openigtlink(*outcome.openigtlink, losses);
  for (const std::string& file : outcome.not_written) losses.add(LossKind::files, 0, cause(file));
  return losses.take();
}

std::vector<std::string> lines_of(const std::vector<Loss>& losses) {
  std::vector<std::string> lines;
  for (const Loss& loss : losses) lines.push_back("lost, " + loss.kind + ": " + loss.text);
  return lines;
}

}  // namespace glint
