// Overruns in a run's recording and CAN log, for the tests of their effects.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "kernels/wire/can_decode.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/output_record.hpp"
#include "nodes/overrun_effects.hpp"
#include "platform/runtime/session/release_records.hpp"
#include "platform/sinks/can/candump_line.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

inline constexpr std::int64_t k_tick_ns = 4'000'000;  // of the default cell

// CAN frames of one tick for its tool.
struct TickOnTheBus {
  int frames = 0;
  TrackState state = TrackState::none;
};

struct OverrunLog {
  std::map<std::uint32_t, graph::OverrunDecision> frames, ticks;  // by sequence and tick number
  std::map<std::uint32_t, std::uint64_t> activations;             // of the frame group, by sequence
  std::map<std::uint32_t, std::uint64_t> versions;  // of the estimates that each tick read
  std::map<std::uint32_t, PoseSample> outputs;      // of the first tool, by tick number
  std::map<std::uint32_t, TickOnTheBus> bus;        // likewise
  std::map<std::string, int> emergencies;  // count of each overrun emergency, by its eight bytes
};

inline void read_recording(const std::string& file, OverrunLog& log, Duration& unix_offset) {
  RecordingReader reader(file);
  unix_offset = reader.unix_offset();
  ChoiceRecord frame_choice;
  const auto on_frame = [&](std::uint32_t sequence) {
    log.activations[sequence] = frame_choice.activation;
    if (frame_choice.overrun.happened()) log.frames[sequence] = frame_choice.overrun;
  };
  while (const auto message = reader.next()) {
    if (const auto* choice = std::get_if<ChoiceRecord>(&*message)) {
      if (choice->group == k_frame_group) frame_choice = *choice;
      if (choice->group != k_tick_group) continue;
      const auto tick = static_cast<std::uint32_t>(choice->nominal.nanoseconds / k_tick_ns);
      log.versions[tick] = choice->versions[0];
      if (choice->overrun.happened()) log.ticks[tick] = choice->overrun;
    } else if (const auto* frame = std::get_if<FrameMessage>(&*message)) {
      on_frame(frame->sequence);
    } else if (const auto* markers = std::get_if<MarkerFrame>(&*message)) {
      on_frame(markers->sequence);
    } else if (const auto* output = std::get_if<OutputMessage>(&*message)) {
      const auto sample = decode(output->record);
      EXPECT_TRUE(sample);
      EXPECT_TRUE(log.outputs.emplace(sample.value.tick_number, sample.value).second);
    }
  }
}

inline void read_bus(const std::string& file, Duration unix_offset, OverrunLog& log) {
  constexpr std::uint32_t k_emergencies = 0x80 + 32;  // of the default node
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const auto record = parse_candump(line);
    ASSERT_TRUE(record) << line;
    const CanFrame& frame = record->frame;
    // The log's time stamps are truncated to microseconds.
    const std::int64_t since_ns = record->unix_ns - unix_offset.nanoseconds + k_tick_ns / 2;
    const auto tick = static_cast<std::uint32_t>(since_ns / k_tick_ns);
    if (frame.identifier >= k_can_base_default &&
        frame.identifier <= k_can_base_default + k_quality_message.offset) {
      ++log.bus[tick].frames;
    }
    if (frame.identifier == k_can_base_default + k_quality_message.offset) {
      const auto quality = decode_quality(frame);
      ASSERT_TRUE(quality);
      log.bus[tick].state = quality.value.state;
    }
    // Kind 3 is not an overrun: a tool that stop_safe declares lost has its own emergency, state 3.
    if (frame.identifier == k_emergencies && frame.data[1] == 0xFF && frame.data[4] != 3 &&
        is_overrun(static_cast<Reason>(frame.data[0]))) {
      std::string bytes;
      for (const std::uint8_t byte : frame.bytes()) {
        char digits[4];
        std::snprintf(digits, sizeof digits, "%02X", byte);
        bytes += digits;
      }
      ++log.emergencies[bytes];
    }
  }
}

inline OverrunLog overrun_log(const std::string& recording, const std::string& can_log) {
  OverrunLog log;
  Duration unix_offset;
  read_recording(recording, log, unix_offset);
  read_bus(can_log, unix_offset, log);
  return log;
}

}  // namespace glint
