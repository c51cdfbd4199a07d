#include "platform/session/replay.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "graph/describe.hpp"
#include "kernels/wire/output_record.hpp"
#include "nodes/output.hpp"
#include "nodes/overrun_effects.hpp"
#include "nodes/tracker.hpp"
#include "platform/input_error.hpp"
#include "platform/record/sha256.hpp"
#include "platform/session/choices.hpp"
#include "platform/session/pipeline.hpp"
#include "platform/session/recorded_cell.hpp"
#include "platform/session/tool_roster.hpp"
#include "platform/session/tracker_executor.hpp"

namespace glint {
namespace {

// The last node of G that has run when `node` is the last one of Other that has; -1: none.
template <class G, class Other>
int same_place(int node) {
  int last = -1;
  int number = 0;
  for (const graph::NodeInfo& one : graph::Description<G>::nodes) {
    for (int other = 0; other <= node && other < Other::node_count; ++other) {
      const graph::NodeInfo& theirs =
          graph::Description<Other>::nodes[static_cast<std::size_t>(other)];
      if (theirs.name == one.name && theirs.copy == one.copy) last = number;
    }
    ++number;
  }
  return last;
}

class Replayer {
 public:
  Replayer(const Cell& cell, Duration tick_period, int workers, ReplayResult& result)
      : result_(result),
        tick_period_(tick_period),
        executor_(workers),
        lost_after_(cell.lost_after),
        declared_(cell.tools),
        robot_(declared_robot_frame(cell)) {
    configure(cell, *tracker_);
    configure(cell, *marker_tracker_);
    configure(cell, *output_);
  }

  // Messages are missing: from here on the tracker's records are no longer those of the run.
  void on_gap() {
    gap_ = true;
    head_since_gap_ = choice_since_gap_ = false;
    decided_.clear();
    recorded_.clear();
  }

  void on(const HeadPose& head) {
    head_ = head;
    head_since_gap_ = true;
  }
  void on(const DroppedInput&) {}  // said beside the frame, which is there as well
  void on(const ButtonEvent&) {}   // a path is made of it; ticks read what was held by then
  // It stands in front of every tick that read it.
  void on(const RobotFrameRecord& frame) {
    robot_frames_[frame.version] = {frame.state, frame.T_world_robot, frame.rms_m,
                                    frame.in_reference};
  }
  // Likewise.
  void on(const PenButtonsRecord& buttons) { pen_buttons_[buttons.version] = {buttons.held}; }

  void on(const FrameMessage& frame) {
    if (!has_all_inputs()) return;
    const Frame view = frame.view();
    tracker_->input<Frame>() = view;
    tracker_->input<HeadPose>() = head_;
    const graph::OverrunDecision overrun = overrun_of_frame();
    estimate(*tracker_, overrun, overrun.after_node, overrun_stamp(view));
  }

  void on(const MarkerFrame& frame) {
    if (!has_all_inputs()) return;
    const FrameStamp stamp{frame.mid_exposure, frame.arrival, frame.sequence, frame.reason};
    marker_tracker_->input<FrameStamp>() = stamp;
    marker_tracker_->input<Markers>() = frame.markers;
    marker_tracker_->input<HeadPose>() = head_;
    const graph::OverrunDecision overrun = overrun_of_frame();
    estimate(*marker_tracker_, overrun, same_place<MarkerTracker, Tracker>(overrun.after_node),
             {stamp.mid_exposure, stamp.arrival, stamp.sequence, Reason::none});
  }

  // A frame's choice stands in front of it. A tick is decided as soon as the estimates that it read
  // are there: its choice may stand in front of the frame, which is offered to the recorder only
  // after its estimates are published.
  void on(const ChoiceRecord& choice) {
    if (choice.group == k_frame_group) {
      frame_choice_ = choice;
      choice_since_gap_ = true;
      return;
    }
    if (choice.group != k_tick_group) return;
    waiting_.push_back(choice);
    run_ready();
  }

  void on(const OutputMessage& message) {
    ++result_.records_recorded;
    recorded_.push_back(message.record);
    compare();
  }

  void finish() {
    result_.versions_missing += static_cast<std::int64_t>(waiting_.size());
    result_.output_sha256 = hash_.hex();
  }

 private:
  using Record = std::vector<std::uint8_t>;

  // Behind a gap the choice tells the frame's number; the first frame may lack its inputs.
  [[nodiscard]] bool has_all_inputs() {
    if (!gap_) return true;
    if (!head_since_gap_ || !choice_since_gap_) {
      ++result_.losses.frames;
      return false;
    }
    version_ = std::max(version_, frame_choice_.activation - 1);
    return true;
  }

  [[nodiscard]] graph::OverrunDecision overrun_of_frame() const {
    return frame_choice_.activation == version_ + 1 ? frame_choice_.overrun
                                                    : graph::OverrunDecision{};
  }

  // `last`: the node after which this activation ended; -1 where none of this graph's had run.
  template <class AnyTracker>
  void estimate(AnyTracker& tracker, const graph::OverrunDecision& overrun, int last,
                const FrameStamp& stamp) {
    ++result_.frames;
    ++version_;
    give_tools(tracker);
    if (!overrun.happened()) {
      executor_.activate(tracker);
      *in_time_ = tracker.template output<Estimates>();
      estimates_[version_] = std::make_unique<Estimates>(*in_time_);
    } else {
      ++result_.overruns;
      if (last >= 0) run_until(tracker, overrun, last);
      auto out = std::make_unique<Estimates>();
      const OverrunFrame frame{stamp, head_, lost_after_};
      if (substitute(overrun.policy, frame, *in_time_, *out)) estimates_[version_] = std::move(out);
    }
    run_ready();
  }

  // As that frame was given them. A frame without its choice has what the one before had.
  template <class AnyTracker>
  void give_tools(AnyTracker& tracker) {
    auto& tools = tracker.template latest<ToolSet>();
    const std::uint64_t version = std::max<std::uint64_t>(frame_choice_.versions[0], 1);
    if (tools.version() != version)
      tools.set(tools_present(declared_, tools_in(version)), version, 0);
  }

  template <class G>
  static void run_until(G& graph, graph::OverrunDecision overrun, int last) {
    overrun.after_node = static_cast<std::uint8_t>(last);
    graph::NoTrace trace;
    graph::RecordedBoundary boundary(overrun);
    (void)graph.activate_until(trace, boundary);
  }

  void run_ready() {
    while (!waiting_.empty() && waiting_.front().versions[0] <= version_) {
      decide(waiting_.front());
      waiting_.pop_front();
    }
  }

  // Each returns false where the recording lacks the version that the tick read.
  bool take_estimates(std::uint64_t version) {
    if (version == 0 || version == output_->latest<Estimates>().version()) return true;
    // Versions only rise, so what is older than this one is never read again.
    estimates_.erase(estimates_.begin(), estimates_.lower_bound(version));
    const auto known = estimates_.find(version);
    if (known == estimates_.end()) return false;
    output_->latest<Estimates>().set(*known->second, version, 0);
    return true;
  }
  bool take_robot_frame(std::uint64_t version) {
    if (version == output_->latest<RobotFrame>().version()) return true;
    const RobotFrame* const robot = robot_frame(version);
    if (robot == nullptr) return false;
    output_->latest<RobotFrame>().set(*robot, version, 0);
    return true;
  }
  // Older recordings name no version of the buttons: 0, none was ever held.
  bool take_buttons(std::uint64_t version) {
    if (version == output_->latest<PenButtons>().version()) return true;
    const auto known = pen_buttons_.find(version);
    if (known == pen_buttons_.end()) return false;
    output_->latest<PenButtons>().set(known->second, version, 0);
    return true;
  }

  // Behind a gap a tick goes on with what was there before.
  void decide(const ChoiceRecord& choice) {
    const bool estimates = take_estimates(choice.versions[0]);
    const bool robot = take_robot_frame(choice.versions[1]);
    const bool buttons = take_buttons(choice.versions[2]);
    if (!(estimates && robot && buttons) && !gap_) {
      ++result_.versions_missing;
      return;
    }
    // Ticks that were skipped have numbers, too.
    const auto number =
        static_cast<std::uint64_t>(choice.nominal.nanoseconds / tick_period_.nanoseconds);
    output_->input<Now>() = {choice.nominal, number, choice.unix_offset_ns};
    ++result_.ticks;
    const PoseSamples& samples = run_tick(choice);
    for (int t = 0; t < samples.count; ++t) {
      Record record(k_output_record_bytes);
      encode(samples.items[static_cast<std::size_t>(t)],
             std::span<std::uint8_t, k_output_record_bytes>(record.data(), k_output_record_bytes));
      hash_.add(record);
      ++result_.records;
      decided_.push_back(std::move(record));
    }
    compare();
  }

  // The first version is the cell's own; the others are in the recording.
  [[nodiscard]] const RobotFrame* robot_frame(std::uint64_t version) const {
    if (version <= 1) return &robot_;
    const auto known = robot_frames_.find(version);
    return known == robot_frames_.end() ? nullptr : &known->second;
  }

  // What left at this tick.
  const PoseSamples& run_tick(const ChoiceRecord& choice) {
    if (!choice.overrun.happened()) {
      output_->activate();
      *samples_in_time_ = output_->output<PoseSamples>();
      return *samples_in_time_;
    }
    ++result_.overruns;
    run_until(*output_, choice.overrun, choice.overrun.after_node);
    const OverrunTick tick{output_->input<Now>(), lost_after_,
                           output_->latest<PenButtons>().value()};
    if (!substitute(choice.overrun.policy, tick, *samples_in_time_, *substitute_)) {
      substitute_->count = 0;
    }
    return *substitute_;
  }

  void compare() {
    while (!gap_ && !decided_.empty() && !recorded_.empty()) {
      ++result_.records_compared;
      if (decided_.front() != recorded_.front()) {
        if (result_.mismatches++ == 0) result_.first_mismatch = compared_;
      }
      ++compared_;
      decided_.pop_front();
      recorded_.pop_front();
    }
  }

  ReplayResult& result_;
  Duration tick_period_;
  TrackerExecutor executor_;
  Duration lost_after_;
  ToolSet declared_;
  ChoiceRecord frame_choice_;  // of the newest frame
  std::unique_ptr<Estimates> in_time_ = std::make_unique<Estimates>();
  std::unique_ptr<PoseSamples> samples_in_time_ = std::make_unique<PoseSamples>();
  std::unique_ptr<PoseSamples> substitute_ = std::make_unique<PoseSamples>();
  RobotFrame robot_;
  std::map<std::uint64_t, RobotFrame> robot_frames_;
  std::map<std::uint64_t, PenButtons> pen_buttons_;
  HeadPose head_;
  bool gap_ = false, head_since_gap_ = false, choice_since_gap_ = false;
  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  std::unique_ptr<MarkerTracker> marker_tracker_ = std::make_unique<MarkerTracker>();
  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  std::map<std::uint64_t, std::unique_ptr<Estimates>> estimates_;
  std::uint64_t version_ = 0;
  std::deque<ChoiceRecord> waiting_;
  std::deque<Record> decided_, recorded_;
  std::int64_t compared_ = 0;
  Sha256 hash_;
};

// At level outputs nothing can be decided again: the records are only given back.
void resend(const OutputMessage& message, Sha256& hash, ReplayResult& result) {
  hash.add(message.record);
  ++result.records;
  ++result.records_recorded;
  ++result.records_compared;
}

Time time_of(const RecordedMessage& message, Time otherwise) {
  if (const auto* choice = std::get_if<ChoiceRecord>(&message)) return choice->nominal;
  return otherwise;
}

}  // namespace

ReplayResult replay(const std::string& file, const ReplayOptions& options) {
  RecordingReader reader(file, options.tolerance);
  const Cell cell = recorded_cell(reader, file);
  ReplayResult result;
  result.level = std::string(name_of(reader.level()));
  if (const auto it = reader.facts().find("output_sha256"); it != reader.facts().end())
    result.recorded_sha256 = it->second;
  const bool only_outputs = reader.level() == RecordingLevel::outputs;
  Replayer replayer(cell, reader.nominal_tick(), options.workers, result);
  Sha256 resent;
  Time now;
  std::uint64_t gaps = 0;
  while (auto message = reader.next()) {
    if (reader.gaps() != gaps) replayer.on_gap();
    gaps = reader.gaps();
    now = time_of(*message, now);
    if (options.progress) options.progress(static_cast<double>(now.nanoseconds) * 1e-9);
    if (only_outputs) {
      if (const auto* output = std::get_if<OutputMessage>(&*message))
        resend(*output, resent, result);
      continue;
    }
    std::visit([&](const auto& item) { replayer.on(item); }, *message);
  }
  replayer.finish();
  const std::int64_t frames_without_inputs = result.losses.frames;
  result.losses = reader.losses();
  result.losses.frames += frames_without_inputs;
  if (result.records == 0 && result.records_recorded == 0)
    throw InputError(file + ": nothing to replay: " + std::to_string(result.frames) +
                     " frames and " + std::to_string(result.ticks) +
                     " ticks, but no output record; expected a recording of a run with ticks");
  if (only_outputs) result.output_sha256 = resent.hex();
  return result;
}

}  // namespace glint
