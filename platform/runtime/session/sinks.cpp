#include "platform/runtime/session/sinks.hpp"

#include <exception>
#include <filesystem>
#include <vector>

#include "kernels/wire/can_messages.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sinks/dds/dds_process.hpp"
#include "schedules/bus_load.hpp"

namespace glint {
namespace {

constexpr Duration k_reader_limit = milliseconds(10'000);

std::string in_folder(const std::string& folder, const std::string& file) {
  const std::filesystem::path path(file);
  return path.is_absolute() ? file : (std::filesystem::path(folder) / path).string();
}

std::vector<std::string> names_of(const ToolSet& tools) {
  std::vector<std::string> names;
  for (int t = 0; t < tools.count; ++t) {
    names.emplace_back(tools.items[static_cast<std::size_t>(t)].name.data());
  }
  return names;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

double checked_bus_load(const Cell& cell) {
  const CanTraffic traffic{cell.tools.count, highest_tick_hz_of(cell), cell.can.format};
  const CanBitRates rates{static_cast<double>(cell.can.bit_rate),
                          static_cast<double>(cell.can.data_bit_rate)};
  if (const auto refusal = check_bus_load(traffic, rates)) {
    const bool by_estimates = cell.tick_release == TickRelease::estimate;
    throw InputError(cell.file + ": can: " + *refusal +
                     (by_estimates ? ", or rates.tick_release = \"clock\"" : ""));
  }
  return bus_load(traffic, rates).fraction;
}

DdsSettings dds_settings(const Cell& cell, std::int64_t unix_offset_ns) {
  DdsSettings settings = network_of(cell.dds);
  settings.tool_names = names_of(cell.tools);
  settings.button_timeout = cell.button_timeout;
  settings.tick_period = tick_period_of(cell);
  settings.actuation_delay = cell.actuation_delay;
  settings.unix_minus_session = {unix_offset_ns};
  for (const NamedFile& file : cell.named_files) {
    if (file.key == k_urdf_key) settings.robot_description = file.text;
  }
  if (cell.robot_valid && !cell.robot_in_reference) {
    settings.static_transforms.push_back(
        {settings.frames.world, settings.frames.robot, cell.T_world_robot});
  }
  return settings;
}

}  // namespace

Sinks::Sinks(const Cell& cell, const SinkOptions& options, std::int64_t unix_offset_ns)
    : out_(options.out), can_bus_load_(checked_bus_load(cell)), input_access_(cell.dds.allow) {
  CanSinkOptions can;
  can.directory = out_;
  can.unix_offset_ns = unix_offset_ns;
  can.format = cell.can.format;
  can.frames_a_tick =
      limits_of(cell).tools * can_frames_per_pose(can.format) + k_can_periodic_frames;
  can.when_full = cell.realtime ? OverflowPolicy::drop : OverflowPolicy::wait;
  can_ = open_can_sink(cell.can.sink, can);
  if (cell.can.sink.rfind("log:", 0) == 0) can_file_ = in_folder(out_, cell.can.sink.substr(4));

  if (!cell.record.file.empty()) {
    recording_file_ = in_folder(out_, cell.record.file);
    RecordingInfo info;
    info.level = recording_level(cell.record.level, cell.file);
    info.nominal_tick = tick_period_of(cell);
    info.unix_offset = {unix_offset_ns};
    info.tool_names = names_of(cell.tools);
    info.facts = {{"compiler", __VERSION__},
                  {"cell", cell.file},
                  {"best_effort", joined(options.timing_faults)}};
    info.attachments = attachments_of(cell);
    RecorderSettings settings;
    settings.when_full = can.when_full;
    settings.file.observer = options.observer;
    settings.file.derived = options.derived;
    recorder_ = std::make_unique<Recorder>(recording_file_, info, settings);
  }

  if (!cell.files.tum.empty()) tum_file_ = in_folder(out_, cell.files.tum);
  if (!cell.files.csv.empty()) csv_file_ = in_folder(out_, cell.files.csv);
  if (!tum_file_.empty() || !csv_file_.empty() || options.by_rate) {
    files_ = std::make_unique<FileSink>(tum_file_, csv_file_, can.when_full, cell, options.truth);
    by_rate_ = options.by_rate;
  }

  if (cell.can.buttons) {
    // No bus input without real time: a person cannot keep up with such a run.
    if (cell.realtime) {
      buttons_ = open_can_buttons(
          cell.can.sink, *cell.can.buttons, {unix_offset_ns},
          [this](const ButtonEvent& event) { offer_button(event); }, cell.button_timeout);
    }
    if (buttons_ == nullptr) {
      can_receive_error_ = std::string("can.buttons: ") +
                           (cell.realtime ? cell.can.sink + " is not a bus" : "not in real time") +
                           "; expected socketcan:IF in real time";
    }
  }

  if (cell.openigtlink && cell.realtime) {
    openigtlink_ = std::make_unique<OpenIgtLinkSink>(OpenIgtLinkOptions{
        *cell.openigtlink, names_of(cell.tools), {unix_offset_ns}, cell.actuation_delay});
    openigtlink_->start();
  }

  // A run that is faster than real time would only overrun its DDS readers.
  if (cell.dds.on && cell.realtime) {
    DdsSettings settings = dds_settings(cell, unix_offset_ns);
    settings.timing_faults = joined(options.timing_faults);
    settings.overruns = &overruns_;
    settings.losses = &losses_;
    settings.access = &input_access_;
    settings.source = options.faults;
    settings.calibration = &calibration_notes_;
    if (cell.mapping && !cell.mapping->model.empty()) settings.robot = &robot_notes_;
    dds_ = std::make_unique<DdsSink>(settings);
    if (options.with_reader) {
      reader_ = std::make_unique<ReaderProcess>(settings, in_folder(out_, "dds_reader.json"));
    }
    const auto record_button = [this](const ButtonEvent& event) { offer_button(event); };
    tool_change_counts_.resize(settings.tool_names.size());
    const auto on_tool_change = [this](int tool, bool there) {
      ToolChangeCounts& orders = tool_change_counts_[static_cast<std::size_t>(tool)];
      ++(there ? orders.added : orders.removed);
      tool_requests_.ask(tool, there);
    };
    inputs_ = std::make_unique<DdsInputs>(dds_->process(), settings, record_button, on_tool_change);
    inputs_->start();
    dds_->start();
    if (reader_ != nullptr && !dds_->wait_for_readers(1, k_reader_limit)) {
      throw MissingDevice("the DDS reader found no topics on interface " + cell.dds.interface +
                          "; expected them within 10 s");
    }
  }
}

void Sinks::offer_button(const ButtonEvent& event) {
  const std::lock_guard lock(button_mutex_);
  RecorderLane* const lane = recorder_ != nullptr ? &recorder_->input_lane() : nullptr;
  if (lane != nullptr) (void)lane->offer_button(event);
  held_buttons_.apply(event, lane);
}

void Sinks::close(SinkOutcome& result) {
  can_->flush();
  result.can = can_->counts();
  losses_.store(LossKind::can, result.can.lost());
  result.can_bus_load = can_bus_load_;
  can_.reset();
  if (!can_file_.empty()) result.files.push_back(can_file_);
  result.can_receive_error = can_receive_error_;
  if (buttons_ != nullptr) {
    buttons_->stop();
    result.can_received = buttons_->counts();
    buttons_.reset();
  }
  if (inputs_ != nullptr) {
    inputs_->stop();
    result.dds_received = inputs_->counts();
    result.tool_change_counts = tool_change_counts_;
    inputs_.reset();  // the sink leaves the domain when nothing else holds it
  }
  if (openigtlink_ != nullptr) {
    openigtlink_->stop();
    result.openigtlink = openigtlink_->counts();
  }
  if (files_ != nullptr) {
    result.files_error = files_->close();
    result.files_lost = files_->lost();
    if (by_rate_) result.by_rate = std::make_shared<const OutputByRate>(files_->by_rate());
    losses_.store(LossKind::files, result.files_lost);
    for (const std::string& file : {tum_file_, csv_file_}) {
      if (!file.empty()) result.files.push_back(file);
    }
  }
  if (recorder_ != nullptr) {
    recorder_->add_closing_fact("output_sha256", result.output_sha256);
    result.recording = recorder_->close();
    losses_.store(LossKind::recording, result.recording.dropped + result.recording.lost);
    result.recording_file = recording_file_;
    result.files.push_back(recording_file_);
  }
  // Last, so that the last diagnostics include every loss.
  if (dds_ != nullptr) {
    const std::shared_ptr<DdsProcess> process = dds_->process();
    dds_->stop();
    result.dds = dds_->counts();
    result.dds_process_end = process->last_end();
    if (reader_ != nullptr) {
      try {
        result.dds_reader = reader_->finish(k_reader_limit);
        result.dds_was_read = true;
      } catch (const std::exception& error) {
        result.dds_reader_error = error.what();
      }
    }
  }
}

}  // namespace glint
