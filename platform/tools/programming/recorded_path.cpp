#include "platform/tools/programming/recorded_path.hpp"

#include <algorithm>
#include <span>
#include <variant>

#include "kernels/wire/output_record.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t k_events_max = 1 << 20;

std::vector<std::string> tool_names(const RecordingReader& reader) {
  std::vector<std::string> names;
  const auto found = reader.facts().find("tools");
  if (found == reader.facts().end()) return names;
  const std::string& text = found->second;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    names.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return names;
}

std::uint8_t tool_number(const std::vector<std::string>& names, const std::string& wanted,
                         const std::string& recording) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found != names.end()) return static_cast<std::uint8_t>(found - names.begin());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw InputError(recording + ": no tool '" + wanted + "'; expected one of: " + list);
}

// Order at equal times: press, pose, release.
bool before_pose(const ButtonEvent& event, Time tick) {
  return event.pressed ? event.time <= tick : event.time < tick;
}

std::vector<ButtonEvent> recorded_events(const std::string& recording, ReadTolerance tolerance) {
  RecordingReader reader(recording, tolerance);
  std::vector<ButtonEvent> events;
  while (const auto message = reader.next()) {
    const auto* event = std::get_if<ButtonEvent>(&*message);
    if (event == nullptr) continue;
    if (events.size() == k_events_max) {
      throw InputError(recording + ": more than " + std::to_string(k_events_max) +
                       " button events; expected fewer");
    }
    events.push_back(*event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const ButtonEvent& a, const ButtonEvent& b) { return a.time < b.time; });
  return events;
}

std::string no_accepted_pose_text(const CaptureCounts& counts) {
  return ": no path drawn: of " + std::to_string(counts.poses) +
         " poses while the button was held " + std::to_string(counts.not_measured) +
         " were not measured and " + std::to_string(counts.not_in_robot) +
         " not in the robot's frame; expected measured poses of a cell with a [robot]";
}

}  // namespace

RecordedPath recorded_path(const std::string& recording, const RecordedPathOptions& options) {
  PathCapture capture(options.capture);
  const std::vector<ButtonEvent> events =
      options.presses.empty() ? recorded_events(recording, options.tolerance) : options.presses;
  RecordingReader reader(recording, options.tolerance);
  const std::vector<std::string> names = tool_names(reader);
  RecordedPath result;
  result.tool = options.tool.empty() && !names.empty() ? names.front() : options.tool;
  const std::uint8_t tool = tool_number(names, result.tool, recording);
  if (events.empty()) {
    throw InputError(recording + ": no recorded button; expected --button FROM..TO in seconds");
  }
  result.events = static_cast<std::int64_t>(events.size());
  result.unix_offset = reader.unix_offset();
  auto event = events.begin();
  while (const auto message = reader.next()) {
    const auto* output = std::get_if<OutputMessage>(&*message);
    if (output == nullptr || output->tool != tool) continue;
    const Result<PoseSample> sample = decode(output->record);
    if (!sample) {
      throw InputError(recording + ": an output record of " +
                       std::to_string(output->record.size()) + " bytes; expected layout 1 or " +
                       std::to_string(k_output_record_layout));
    }
    for (; event != events.end() && before_pose(*event, sample.value.tick); ++event) {
      capture.add(*event);
    }
    capture.add(sample.value);
  }
  for (; event != events.end(); ++event) capture.add(*event);
  capture.finish();
  result.losses = reader.losses();
  result.path = capture.path();
  result.counts = capture.counts();
  if (result.counts.poses_accepted == 0)
    throw InputError(recording + no_accepted_pose_text(result.counts));
  return result;
}

}  // namespace glint
