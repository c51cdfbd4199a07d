#include "platform/sources/recording_frames.hpp"

#include <utility>
#include <variant>

#include "platform/input_error.hpp"

namespace glint {

RecordingFrames::RecordingFrames(const std::string& path, ReadTolerance tolerance)
    : path_(path), reader_(path, tolerance) {
  const RecordingLevel level = reader_.level();
  if (level != RecordingLevel::full && level != RecordingLevel::roi) {
    throw InputError(path + ": level " + std::string(name_of(level)) +
                     " holds no frames; expected full or roi");
  }
}

bool RecordingFrames::next(ReadFrame& frame) {
  while (auto message = reader_.next()) {
    if (const auto* head = std::get_if<HeadPose>(&*message)) head_ = *head;
    auto* const found = std::get_if<FrameMessage>(&*message);
    if (found == nullptr) continue;
    frame.pixels = std::move(found->pixels);
    frame.mid_exposure = found->mid_exposure;
    frame.arrival = found->arrival;
    frame.sequence = found->sequence;
    frame.head = head_.time == found->mid_exposure ? head_ : HeadPose{};
    return true;
  }
  return false;
}

std::string RecordingFrames::text() const {
  return "recording " + path_ + ", level " + std::string(name_of(reader_.level())) +
         (reader_.level() == RecordingLevel::roi ? ": only inside its regions" : "");
}

std::optional<Duration> RecordingFrames::unix_offset() const { return reader_.unix_offset(); }

std::string RecordingFrames::missing() const {
  const RecordingLosses losses = reader_.losses();
  return losses.any() ? path_ + ": missing: " + text_of(losses) : "";
}

}  // namespace glint
