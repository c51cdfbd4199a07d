#include "platform/sinks/dds/diagnostics.hpp"

#include <cstdio>

#include "kernels/angles.hpp"
#include "platform/sinks/dds/pose_publisher.hpp"

namespace glint {
namespace {

// diagnostic_msgs/DiagnosticStatus
enum Level : std::uint8_t { k_ok = 0, k_warn = 1, k_error = 2 };

struct StateText {
  Level level;
  const char* text;
};

StateText text_of(TrackState state) {
  switch (state) {
    case TrackState::measured:
      return {k_ok, "measured"};
    case TrackState::predicted:
      return {k_warn, "predicted"};
    case TrackState::lost:
      return {k_error, "lost"};
    case TrackState::none:
      break;
  }
  return {k_error, "none"};
}

}  // namespace

char* Diagnostics::keep(std::string_view text) { return texts_.emplace_back(text).data(); }

void Diagnostics::add(std::string_view tool, const PoseSample& sample, const SinkCounts& counts) {
  const StateText state = text_of(sample.state);
  std::vector<Value>& values = values_.emplace_back();
  const auto value = [&](std::string_view key, const std::string& text) {
    values.push_back({keep(key), keep(text)});
  };
  value("state", state.text);
  value("reason", std::string(name_of(sample.reason)));
  if (sample.has_pose()) {
    value("age_ms", std::to_string(sample.age().seconds() * 1e3));
    value("age_sigma_ms", std::to_string(sample.age_sigma_s * 1e3));
  }
  value("tick", std::to_string(sample.tick_number));
  value("frame", std::to_string(sample.frame_sequence));
  value("offered", std::to_string(counts.offered));
  value("written", std::to_string(counts.written));
  value("ring_dropped", std::to_string(counts.ring_dropped));

  add_entry(state.level, keep("glint: " + std::string(tool)),
            sample.reason == Reason::none ? keep(state.text) : keep(name_of(sample.reason)),
            values);
}

void Diagnostics::add_timing(const OverrunCounters& overruns, std::string_view timing_faults) {
  const std::uint64_t frame = overruns.frame.load(std::memory_order_relaxed);
  const std::uint64_t tick = overruns.tick.load(std::memory_order_relaxed);
  const std::uint64_t source = overruns.source.load(std::memory_order_relaxed);
  std::vector<Value>& values = values_.emplace_back();
  values.push_back({keep("overruns_frame"), keep(std::to_string(frame))});
  values.push_back({keep("overruns_tick"), keep(std::to_string(tick))});
  values.push_back({keep("ticks_source_late"), keep(std::to_string(source))});
  values.push_back({keep("best_effort"), keep(timing_faults)});
  const bool late = frame + tick + source > 0;
  const char* const message = frame + tick > 0        ? "overruns"
                              : source > 0            ? "source too slow"
                              : timing_faults.empty() ? "in time"
                                                      : "best effort";
  add_entry(late || !timing_faults.empty() ? k_warn : k_ok, keep("glint: timing"), keep(message),
            values);
}

void Diagnostics::add_losses(const LossCounters& losses) {
  std::vector<Value>& values = values_.emplace_back();
  std::string text;
  for (std::size_t k = 0; k < k_loss_kinds; ++k) {
    const auto kind = static_cast<LossKind>(k);
    const std::string name(name_of(kind));
    const std::string count = std::to_string(losses.of(kind));
    values.push_back({keep(name), keep(count)});
    if (losses.of(kind) > 0) text += (text.empty() ? "lost: " : ", ") + name + " " + count;
  }
  const bool lost = !text.empty();
  add_entry(lost ? k_error : k_ok, keep("glint: losses"), keep(lost ? text : "none"), values);
}

void Diagnostics::add_process(std::uint64_t restarts, std::string_view how) {
  std::vector<Value>& values = values_.emplace_back();
  values.push_back({keep("restarts"), keep(std::to_string(restarts))});
  add_entry(k_error, keep("glint: DDS process"), keep("it " + std::string(how)), values);
}

void Diagnostics::add_inputs(const InputRefusals& refusals) {
  std::vector<Value>& values = values_.emplace_back();
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    const std::string name = k_dds_input_names[i];
    values.push_back({keep(name + "_not_allowed"), keep(std::to_string(refusals.not_allowed[i]))});
    values.push_back({keep(name + "_too_fast"), keep(std::to_string(refusals.too_fast[i]))});
  }
  const std::string refused = text_of(refusals);
  add_entry(refused.empty() ? k_ok : k_warn, keep("glint: inputs"),
            keep(refused.empty() ? "none refused" : refused), values);
}

void Diagnostics::add_source(const SourceFaults& faults, std::uint64_t published) {
  std::vector<Value>& values = values_.emplace_back();
  for (std::size_t k = 0; k < k_source_faults; ++k) {
    const auto fault = static_cast<SourceFault>(k);
    values.push_back({keep(name_of(fault)), keep(std::to_string(faults.of(fault)))});
  }
  const bool is_new = faults.total() > published;
  const std::string_view text = is_new            ? name_of(faults.newest())
                                : faults.silent() ? name_of(SourceFault::no_frame)
                                                  : "frames arrive";
  add_entry(faults.silent() ? k_error
            : is_new        ? k_warn
                            : k_ok,
            keep("glint: source"), keep(text), values);
}

void Diagnostics::add_robot(const RobotTrackingStatus& robot) {
  const std::int64_t followed = robot.followed.load(std::memory_order_relaxed);
  const std::int64_t jumps = robot.jumps.load(std::memory_order_relaxed);
  const std::int64_t inconclusive = robot.inconclusive.load(std::memory_order_relaxed);
  const std::int64_t skipped_without_joints =
      robot.skipped_without_joints.load(std::memory_order_relaxed);
  const double shift_mm = 1e3 * robot.translation_m.load(std::memory_order_relaxed);
  const double turn_deg = k_degrees_per_radian * robot.rotation_rad.load(std::memory_order_relaxed);
  std::vector<Value>& values = values_.emplace_back();
  values.push_back({keep("followed"), keep(std::to_string(followed))});
  values.push_back({keep("jumps_refused"), keep(std::to_string(jumps))});
  values.push_back({keep("unsure"), keep(std::to_string(inconclusive))});
  values.push_back({keep("without_joints"), keep(std::to_string(skipped_without_joints))});
  values.push_back({keep("jump_mm"), keep(std::to_string(shift_mm))});
  values.push_back({keep("jump_deg"), keep(std::to_string(turn_deg))});
  std::string warning;
  if (robot.jumped.load(std::memory_order_relaxed)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "detected %.1f mm and %.1f deg from its stored pose, rejected; stop, check what "
                  "moved, run glint reference",
                  shift_mm, turn_deg);
    warning = text;
  }
  if (robot.joints_lost.load(std::memory_order_relaxed)) {
    warning += warning.empty() ? "" : "; ";
    warning += "not tracked: joint states are too old; check the robot's driver";
  }
  if (warning.empty()) {
    add_entry(k_ok, keep("glint: robot"), keep(followed > 0 ? "followed" : "not yet detected"),
              values);
  } else {
    add_entry(k_warn, keep("glint: robot"), keep(warning), values);
  }
}

void Diagnostics::add_entry(std::uint8_t level, char* name, char* message,
                            std::vector<Value>& values) {
  Entry entry{};
  entry.level = level;
  entry.name = name;
  entry.message = message;
  entry.hardware_id = keep("glint");
  entry.values._length = entry.values._maximum = static_cast<std::uint32_t>(values.size());
  entry.values._buffer = values.data();
  entries_.push_back(entry);
}

void Diagnostics::add_calibration(const std::vector<CalibrationFinding>& findings) {
  std::vector<Value>& values = values_.emplace_back();
  std::string warning;
  for (const CalibrationFinding& finding : findings) {
    const std::string text = text_of(finding);
    const std::string key = finding.tool.empty() ? "" : finding.tool + ": ";
    values.push_back({keep(key + std::string(name_of(finding.source))), keep(text)});
    if (finding.exceeds_stated) warning += (warning.empty() ? "" : "; ") + text;
  }
  const char* const fine = findings.empty() ? "too few data" : "as stated";
  add_entry(warning.empty() ? k_ok : k_warn, keep("glint: calibration"),
            keep(warning.empty() ? fine : warning), values);
}

DiagnosticsMessage Diagnostics::message(Time unix_time) {
  DiagnosticsMessage message{};
  message.header = header_message(unix_time, "");
  message.status._length = message.status._maximum = static_cast<std::uint32_t>(entries_.size());
  message.status._buffer = entries_.data();
  return message;
}

}  // namespace glint
