// Comparison of a recording's replay with the original run.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kernels/wire/output_record.hpp"
#include "platform/runtime/session/replay.hpp"
#include "platform/runtime/session/session.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sinks/record/recording_writer.hpp"

namespace glint {

// Expects the replay's decisions and outputs to equal the run's. Returns the replay's result.
inline ReplayResult expect_same_bytes(const std::string& recording, const SessionResult& run,
                                      int workers = 1) {
  ReplayOptions options;
  options.workers = workers;
  ReplayResult result = replay(recording, options);
  EXPECT_TRUE(result.agrees()) << result.mismatches << " differ, first " << result.first_mismatch
                               << ", " << workers << " workers";
  EXPECT_EQ(result.output_sha256, run.output_sha256);
  return result;
}

// Rewrites a recording of level blobs after applying `change` to its messages.
inline void rewrite(const std::string& from, const std::string& to,
                    const std::function<void(std::vector<RecordedMessage>&)>& change) {
  RecordingReader reader(from);
  RecordingInfo info;
  info.level = reader.level();
  info.nominal_tick = reader.nominal_tick();
  info.unix_offset = reader.unix_offset();
  for (const std::string& name : reader.attachment_names()) {
    info.attachments.push_back(reader.attachment(name));
  }
  std::vector<RecordedMessage> messages;
  while (auto message = reader.next()) messages.push_back(std::move(*message));
  change(messages);
  RecordingWriter writer(to, info);
  for (const RecordedMessage& message : messages) {
    if (const auto* head = std::get_if<HeadPose>(&message)) writer.write_head_pose(*head);
    if (const auto* frame = std::get_if<MarkerFrame>(&message)) writer.write_markers(*frame);
    if (const auto* choice = std::get_if<ChoiceRecord>(&message)) writer.write_choice(*choice);
    if (const auto* held = std::get_if<PenButtonsRecord>(&message)) writer.write_pen_buttons(*held);
    if (const auto* output = std::get_if<OutputMessage>(&message)) {
      const std::span<const std::uint8_t, k_output_record_bytes> record(output->record);
      writer.write_output(decode(record).value, record);
    }
  }
}

}  // namespace glint
