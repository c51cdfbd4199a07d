#include "platform/tools/programming/recorded_path.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <variant>

#include "kernels/wire/output_record.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/runtime/session/replay.hpp"
#include "platform/tools/programming/smoothed_motion.hpp"

namespace glint {
namespace {

constexpr Time k_forever{INT64_MAX / 2};

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

// Times during which draw is held, in order.
struct DrawTime {
  Time from, to;
};

std::vector<DrawTime> draw_times(const std::vector<ButtonEvent>& events) {
  std::vector<DrawTime> times;
  bool held = false;
  for (const ButtonEvent& event : events) {
    if (event.button != Button::draw || event.pressed == held) continue;
    held = event.pressed;
    if (held) {
      times.push_back({event.time, k_forever});
    } else {
      times.back().to = event.time;
    }
  }
  return times;
}

// Poses of the strokes, smoothed over the frames that a replay of the recording measures.
class HindsightPoses {
 public:
  HindsightPoses(const std::string& recording, std::size_t tool, const RecordedPathOptions& options,
                 std::vector<DrawTime> times)
      : times_(std::move(times)) {
    RecordingReader reader(recording, options.tolerance);
    const Cell cell = recorded_cell(reader, recording);
    SmoothedMotionSettings settings;
    settings.motion = cell.motion;
    settings.slow_gap_max = cell.lost_after;
    settings.hidden_gap_max = options.capture.stroke.gap_max;
    const double place = cell.robot_sigma_m, turn = cell.robot_sigma_rad;
    settings.robot_covariance.diagonal() << Vector3::Constant(place * place),
        Vector3::Constant(turn * turn);
    frames_ = std::make_unique<MeasuredFrames>(
        tool, cell.camera.uncertainty.time_stamp_s,
        [this, margin = settings.margin](Time time) { return is_near_stroke(time, margin); });
    ReplayOptions replayed;
    replayed.tolerance = options.tolerance;
    replayed.on_frame = [this](const TrackedFrame& frame, const RobotFrame& robot) {
      frames_->add(frame, robot);
    };
    // A frame is processed after its exposure, by less than a second: the tracker rejects later.
    if (!times_.empty()) replayed.until = times_.back().to + settings.margin + milliseconds(1000);
    mismatches_ = replay(recording, replayed).mismatches;
    motion_ = std::make_unique<SmoothedMotion>(frames_->frames(), settings);
  }

  // Replaces the sample's pose; without a smoothed pose at its tick it is not measured.
  // Requires rising ticks.
  void replace(PoseSample& sample) {
    while (next_ < times_.size() && times_[next_].from <= sample.tick) {
      motion_->select(times_[next_].from, times_[next_].to);
      ++next_;
    }
    const bool drawing = next_ > 0 && sample.tick <= times_[next_ - 1].to;
    if (drawing && !motion_->write(sample) && sample.state == TrackState::measured)
      sample.state = TrackState::predicted;
  }

  [[nodiscard]] std::int64_t frames_used() const { return motion_->frames_used(); }
  [[nodiscard]] std::int64_t mismatches() const { return mismatches_; }

 private:
  [[nodiscard]] bool is_near_stroke(Time time, Duration margin) const {
    const auto next =
        std::partition_point(times_.begin(), times_.end(),
                             [&](const DrawTime& drawn) { return drawn.to + margin < time; });
    return next != times_.end() && next->from - margin <= time;
  }

  std::vector<DrawTime> times_;
  std::size_t next_ = 0;  // the stroke after the selected one
  std::unique_ptr<MeasuredFrames> frames_;
  std::unique_ptr<SmoothedMotion> motion_;
  std::int64_t mismatches_ = 0;
};

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
      options.presses.empty() ? recorded_buttons(recording, options.tolerance) : options.presses;
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
  std::unique_ptr<HindsightPoses> hindsight;
  if (options.poses == PathPoses::smoothed && reader.level() != RecordingLevel::outputs) {
    hindsight = std::make_unique<HindsightPoses>(recording, tool, options, draw_times(events));
    result.poses = PathPoses::smoothed;
    result.replay_mismatches = hindsight->mismatches();
  }
  auto event = events.begin();
  while (const auto message = reader.next()) {
    const auto* output = std::get_if<OutputMessage>(&*message);
    if (output == nullptr || output->tool != tool) continue;
    Result<PoseSample> sample = decode(output->record);
    if (!sample) {
      throw InputError(recording + ": an output record of " +
                       std::to_string(output->record.size()) + " bytes; expected layout 1 or " +
                       std::to_string(k_output_record_layout));
    }
    for (; event != events.end() && before_pose(*event, sample.value.tick); ++event) {
      capture.add(*event);
    }
    if (hindsight) hindsight->replace(sample.value);
    capture.add(sample.value);
  }
  for (; event != events.end(); ++event) capture.add(*event);
  capture.finish();
  if (hindsight) result.frames = hindsight->frames_used();
  result.losses = reader.losses();
  result.path = capture.path();
  result.counts = capture.counts();
  if (result.counts.poses_accepted == 0)
    throw InputError(recording + no_accepted_pose_text(result.counts));
  return result;
}

}  // namespace glint
