// A recording replayed beside the run that made it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "platform/record/recording_reader.hpp"
#include "platform/session/replay.hpp"
#include "platform/session/session.hpp"

namespace glint {

// Fails the test where the replay decides or says anything else than the run; gives what more it
// found.
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

// Of a recording that is to be written again in part.
inline RecordingInfo info_of(RecordingReader& reader) {
  RecordingInfo info;
  info.level = reader.level();
  info.nominal_tick = reader.nominal_tick();
  info.unix_offset = reader.unix_offset();
  for (const std::string& name : reader.attachment_names()) {
    info.attachments.push_back(reader.attachment(name));
  }
  return info;
}

}  // namespace glint
