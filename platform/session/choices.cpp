#include "platform/session/choices.hpp"

#include <algorithm>

namespace glint {

FrameStamp overrun_stamp(const Frame& frame) {
  return {frame.mid_exposure, frame.arrival, frame.sequence, Reason::none};
}

ChoiceRecord as_record(const graph::Choice& choice, std::int64_t unix_offset_ns) {
  ChoiceRecord record;
  record.group = static_cast<std::uint8_t>(choice.group);
  record.activation = choice.activation;
  record.nominal = Time{choice.nominal_ns};
  record.version_count = static_cast<std::uint8_t>(choice.version_count);
  for (int i = 0; i < choice.version_count && i < k_recorded_versions; ++i) {
    record.versions[static_cast<std::size_t>(i)] = choice.versions[static_cast<std::size_t>(i)];
  }
  record.unix_offset_ns = unix_offset_ns;
  return record;
}

graph::Choice as_choice(const ChoiceRecord& record) {
  graph::Choice choice;
  choice.group = record.group;
  choice.activation = record.activation;
  choice.nominal_ns = record.nominal.nanoseconds;
  choice.version_count = std::min<int>(record.version_count, k_recorded_versions);
  std::copy_n(record.versions.begin(), choice.version_count, choice.versions.begin());
  return choice;
}

}  // namespace glint
