// Recordings: the MCAP container, and each of Glint's messages by itself.
#include "kernels/wire/output_record.hpp"
#include "platform/record/glint_messages.hpp"
#include "platform/record/recording_reader.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace glint::fuzz {
namespace {

void read_all(const std::string& path, ReadTolerance tolerance) {
  RecordingReader reader(path, tolerance);
  for (const std::string& name : reader.attachment_names()) (void)reader.attachment(name);
  while (reader.next()) {
  }
}

void read_whole(Bytes bytes) { read_all(file_of(bytes), {}); }

void read_tolerant(Bytes bytes) { read_all(file_of(bytes), {true, true}); }

// The first byte chooses the message's type.
void read_message(Bytes bytes) {
  if (bytes.empty()) return;
  const Bytes message = bytes.subspan(1);
  switch (bytes[0] % 10) {
    case 0: {
      const ImageRows rows = read_image(message).value_or(ImageRows{});
      (void)read_frame(message, rows, rows);
      return;
    }
    case 1:
      (void)read_image(message);
      return;
    case 2:
      (void)read_head_pose(message);
      return;
    case 3:
      (void)read_markers(message);
      return;
    case 4:
      (void)read_choice(message);
      return;
    case 5: {
      const auto output = read_output(message);
      if (!output || output->record.size() != k_output_record_bytes) return;
      (void)decode(std::span<const std::uint8_t>(output->record).first<k_output_record_bytes>());
      return;
    }
    case 6:
      (void)read_dropped(message);
      return;
    case 7:
      (void)read_robot_frame(message);
      return;
    case 8:
      (void)read_pen_buttons(message);
      return;
    default:
      (void)read_button(message);
  }
}

constexpr Target k_recording_targets[] = {
    {"mcap", read_whole}, {"mcap_tolerant", read_tolerant}, {"messages", read_message}};

}  // namespace

std::span<const Target> recording_targets() { return k_recording_targets; }

}  // namespace glint::fuzz
