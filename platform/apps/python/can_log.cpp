#include "platform/apps/python/can_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "kernels/wire/can_decode.hpp"
#include "kernels/wire/can_frames.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/can/candump_line.hpp"

namespace glint::python {
namespace {

constexpr int k_counter_period = 15, k_counter_period_fd = 256;  // can_frames.hpp
constexpr std::uint32_t k_fd_offset = k_fd_message.offset;
constexpr unsigned k_all_offsets = 0x1F;  // of the five classic frames

double known(double value) { return value < 0 ? k_nan : value; }

CanPoseRow empty_row(std::int64_t unix_ns, int tool) {
  CanPoseRow row{};
  row.unix_ns = unix_ns;
  row.tool = static_cast<std::uint8_t>(tool);
  row.checksum_ok = true;
  put_nothing(row.position_m);
  put_nothing(row.orientation_xyzw);
  put_nothing(row.velocity_m_s);
  put_nothing(row.angular_velocity_rad_s);
  row.sigma_position_m = row.sigma_orientation_rad = row.age_s = row.registration_rms_m = k_nan;
  return row;
}

bool has_pose(TrackState state) {
  return state == TrackState::measured || state == TrackState::predicted;
}

void put_quality(const DecodedQuality& quality, CanPoseRow& row) {
  row.state = static_cast<std::uint8_t>(quality.state);
  row.registration = static_cast<std::uint8_t>(quality.registration);
  row.markers = quality.markers;
  row.buttons = quality.buttons;
  row.sigma_position_m = known(quality.sigma_position_m);
  row.sigma_orientation_rad = known(quality.sigma_orientation_rad);
  row.age_s = known(quality.age_s);
  row.registration_rms_m = known(quality.registration_rms_m);
}

// The frames of one tool. A set is the frames with one counter, in the order of their identifiers.
class ToolSets {
 public:
  ToolSets(int tool, const Cell& cell)
      : tool_(tool), fd_(is_fd(cell.can.format)), period_ns_(1e9 / cell.tick_hz) {}

  void add(const CandumpRecord& record, std::uint32_t offset, std::vector<CanPoseRow>& rows) {
    CanPoseRow part = empty_row(record.unix_ns, tool_);
    const std::optional<std::uint8_t> counter = decode_into(part, record.frame, offset);
    const bool other_set = counter && counter_ && *counter != *counter_;
    const bool repeated = offsets_ != 0 && (offsets_ >> offset) != 0;
    if (offsets_ != 0 && (other_set || repeated)) close(rows);
    if (offsets_ == 0) row_ = empty_row(record.unix_ns, tool_);
    offsets_ |= 1U << offset;
    if (!counter) {
      row_.checksum_ok = false;
    } else {
      counter_ = counter;
      (void)decode_into(row_, record.frame, offset);
    }
    if (fd_ || offset == k_quality_message.offset) close(rows);
  }

  void close(std::vector<CanPoseRow>& rows) {
    if (offsets_ == 0) return;
    row_.complete = row_.checksum_ok && (fd_ || offsets_ == k_all_offsets);
    row_.counter = counter_.value_or(0);
    row_.tick = next_tick();
    row_.lost = last_ ? row_.tick - last_->tick - 1 : 0;
    last_ = Last{row_.tick, row_.unix_ns, counter_};
    rows.push_back(row_);
    counter_.reset();
    offsets_ = 0;
  }

 private:
  struct Last {
    std::int64_t tick, unix_ns;
    std::optional<std::uint8_t> counter;
  };

  // Returns the frame's counter; nothing if its length or checksum is wrong.
  std::optional<std::uint8_t> decode_into(CanPoseRow& row, const CanFrame& frame,
                                          std::uint32_t offset) const {
    if (fd_) {
      const auto pose = decode_fd_pose(frame);
      if (!pose) return std::nullopt;
      put_quality(pose.value.quality, row);
      row.valid = has_pose(pose.value.quality.state);
      if (row.valid) {
        put(row.position_m, pose.value.position_m);
        put(row.orientation_xyzw, pose.value.rotation);
        put(row.velocity_m_s, pose.value.velocity_m_s);
        put(row.angular_velocity_rad_s, pose.value.angular_velocity_rad_s);
      }
      return pose.value.quality.counter;
    }
    if (offset == k_position_message.offset) {
      const auto position = decode_position(frame);
      if (!position) return std::nullopt;
      row.valid = position.value.valid;
      if (row.valid) put(row.position_m, position.value.position_m);
      return position.value.counter;
    }
    if (offset == k_orientation_message.offset) {
      const auto orientation = decode_orientation(frame);
      if (!orientation) return std::nullopt;
      if (has_pose(orientation.value.state)) put(row.orientation_xyzw, orientation.value.rotation);
      return orientation.value.counter;
    }
    if (offset == k_quality_message.offset) {
      const auto quality = decode_quality(frame);
      if (!quality) return std::nullopt;
      put_quality(quality.value, row);
      return quality.value.counter;
    }
    const bool linear = offset == k_velocity_message.offset;
    const auto velocity = linear ? decode_velocity(frame) : decode_angular_velocity(frame);
    if (!velocity) return std::nullopt;
    if (has_pose(velocity.value.state)) {
      put(linear ? row.velocity_m_s : row.angular_velocity_rad_s, velocity.value.velocity);
    }
    return velocity.value.counter;
  }

  // Number of the tick after the first one of the log: by the counters, whose repetitions the times
  // count.
  std::int64_t next_tick() const {
    if (!last_) return 0;
    const double elapsed = static_cast<double>(row_.unix_ns - last_->unix_ns) / period_ns_;
    if (!counter_ || !last_->counter) {
      return last_->tick + std::max<std::int64_t>(1, std::llround(elapsed));
    }
    const int period = fd_ ? k_counter_period_fd : k_counter_period;
    const int step = (*counter_ - *last_->counter + period) % period;
    const auto turns =
        std::max<std::int64_t>(step == 0 ? 1 : 0, std::llround((elapsed - step) / period));
    return last_->tick + step + turns * period;
  }

  int tool_;
  bool fd_;
  double period_ns_;
  CanPoseRow row_{};
  unsigned offsets_ = 0;  // bit i: a frame with offset i belongs to the open set
  std::optional<std::uint8_t> counter_;
  std::optional<Last> last_;
};

// Remote requests ("123#R") and error frames ("20000080#...") hold no data of a message.
bool holds_no_data(std::string_view line) {
  const auto hash = line.find('#');
  if (hash == std::string_view::npos) return false;
  const auto space = line.rfind(' ', hash);
  if (space == std::string_view::npos || !line.starts_with('(')) return false;
  return line.substr(hash + 1).starts_with('R') || (hash - space == 9 && line[space + 1] == '2');
}

}  // namespace

std::vector<CanPoseRow> read_can_log(const std::string& path, const Cell& cell) {
  std::ifstream file(path);
  if (!file) {
    throw InputError(path + ": " + std::generic_category().message(errno) +
                     "; expected a log of candump -L");
  }
  std::vector<ToolSets> tools;
  for (int t = 0; t < k_tools_max; ++t) tools.emplace_back(t, cell);
  std::vector<CanPoseRow> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (holds_no_data(line)) continue;
    const std::optional<CandumpRecord> record = parse_candump(line);
    if (!record) {
      throw InputError(path + ":" + std::to_string(number) + ": \"" + line +
                       "\"; expected a line of candump -L: (seconds.microseconds) interface "
                       "identifier#data");
    }
    const CanFrame& frame = record->frame;
    if (frame.extended || frame.identifier < cell.can.base_id) continue;
    const std::uint32_t at = frame.identifier - cell.can.base_id;
    const std::uint32_t tool = at / k_can_tool_stride, offset = at % k_can_tool_stride;
    const bool of_pose =
        is_fd(cell.can.format) ? offset == k_fd_offset : offset <= k_quality_message.offset;
    if (tool < static_cast<std::uint32_t>(k_tools_max) && of_pose)
      tools[tool].add(*record, offset, rows);
  }
  if (file.bad()) throw InputError(path + ": cannot be read; expected a log of candump -L");
  for (ToolSets& tool : tools) tool.close(rows);
  return rows;
}

}  // namespace glint::python
