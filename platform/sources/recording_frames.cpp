#include "platform/sources/recording_frames.hpp"

#include <algorithm>
#include <cstring>
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
    frame.stamp_sigma = found->stamp_sigma;
    frame.arrival = found->arrival;
    frame.sequence = found->sequence;
    frame.head = head_.time == found->mid_exposure ? head_ : HeadPose{};
    return true;
  }
  return false;
}

std::optional<SourceLens> RecordingFrames::lens() const {
  const auto names = reader_.attachment_names();
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  constexpr const char* k_rays = "rays.f32";
  constexpr const char* k_file = "camera.file.toml";
  if (!has(k_rays) && !has(k_file)) return std::nullopt;
  const Attachment found = reader_.attachment(has(k_rays) ? k_rays : k_file);
  SourceLens lens{path_ + ":" + found.name, {}, {}};
  if (has(k_rays)) {
    lens.rays.resize(found.data.size() / sizeof(float));
    std::memcpy(lens.rays.data(), found.data.data(), lens.rays.size() * sizeof(float));
  } else {
    lens.file.assign(found.data.begin(), found.data.end());
  }
  return lens;
}

std::string RecordingFrames::text() const {
  return "recording " + path_ + ", level " + std::string(name_of(reader_.level())) +
         (reader_.level() == RecordingLevel::roi ? ": pixels inside ROIs only" : "");
}

std::optional<Duration> RecordingFrames::unix_offset() const { return reader_.unix_offset(); }

std::string RecordingFrames::missing() const {
  const RecordingLosses losses = reader_.losses();
  return losses.any() ? path_ + ": missing: " + text_of(losses) : "";
}

}  // namespace glint
