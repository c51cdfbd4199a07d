#include "platform/sources/open_source.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/record/mcap_format.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sources/file_source.hpp"
#include "platform/sources/folder_frames.hpp"
#include "platform/sources/hl2ss_frames.hpp"
#include "platform/sources/hl2ss_long_throw.hpp"
#include "platform/sources/open_live_source.hpp"
#include "platform/sources/recording_frames.hpp"
#include "platform/sources/rosbag_frames.hpp"
#include "platform/sources/stream_recorder_frames.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Opened = std::unique_ptr<FrameReader>;

bool begins_with(const std::string& path, std::string_view expected) {
  std::string found(expected.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(found.data(), static_cast<std::streamsize>(found.size()));
  return file.gcount() == static_cast<std::streamsize>(found.size()) && found == expected;
}

bool is_mcap(const std::string& path) {
  const std::string magic(k_mcap_magic.begin(), k_mcap_magic.end());
  return !fs::is_directory(path) && begins_with(path, magic);
}

// Treats a damaged file as Glint's own, so that its reader reports the damage.
bool is_foreign_mcap(const std::string& path) {
  try {
    return !McapReader(path, McapEnding::optional).metadata().contains(k_opening_metadata);
  } catch (const InputError&) {
    return false;
  }
}

bool has_file(const std::string& folder, const auto& is_it) {
  if (!fs::is_directory(folder)) return false;
  const fs::directory_iterator files(folder);
  return std::any_of(begin(files), end(files),
                     [&](const auto& entry) { return is_it(entry.path().filename().string()); });
}

struct SourceKind {
  const char* name;
  bool (*is_at)(const std::string& path);
  Opened (*open)(const Cell& cell, ReadTolerance tolerance);
};

constexpr std::array k_kinds = {
    SourceKind{"folder",
               [](const std::string& path) {
                 return has_file(path,
                                 [](const std::string& name) { return name == "frames.csv"; });
               },
               [](const Cell& cell, ReadTolerance) -> Opened {
                 return std::make_unique<FolderFrames>(cell.source.path, cell.camera);
               }},
    SourceKind{"hl2ss_file",
               [](const std::string& path) {
                 return !fs::is_directory(path) && begins_with(path, "HL2SS");
               },
               [](const Cell& cell, ReadTolerance) -> Opened {
                 return std::make_unique<Hl2ssFrames>(cell.source, cell.camera);
               }},
    SourceKind{"recording",
               [](const std::string& path) { return is_mcap(path) && !is_foreign_mcap(path); },
               [](const Cell& cell, ReadTolerance tolerance) -> Opened {
                 return std::make_unique<RecordingFrames>(cell.source.path, tolerance);
               }},
    SourceKind{"rosbag",
               [](const std::string& path) {
                 return (is_mcap(path) && is_foreign_mcap(path)) ||
                        has_file(path,
                                 [](const std::string& name) { return name.ends_with(".mcap"); });
               },
               [](const Cell& cell, ReadTolerance tolerance) -> Opened {
                 return std::make_unique<RosbagFrames>(cell.source, cell.camera, tolerance);
               }},
    SourceKind{"stream_recorder",
               [](const std::string& path) {
                 return has_file(path, [](const std::string& name) {
                   return name.starts_with("Depth AHaT") || name.starts_with("Depth Long Throw");
                 });
               },
               [](const Cell& cell, ReadTolerance) -> Opened {
                 return std::make_unique<StreamRecorderFrames>(cell.source.path, cell.camera);
               }},
};

}  // namespace

std::string recorded_kinds() {
  std::string names;
  for (const SourceKind& kind : k_kinds)
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

std::string kind_at(const std::string& path) {
  for (const SourceKind& kind : k_kinds) {
    if (kind.is_at(path)) return kind.name;
  }
  return {};
}

std::unique_ptr<FrameSource> open_source(Cell& cell, ReadTolerance tolerance, LiveSettings live) {
  const SourceSettings& source = cell.source;
  if (source.kind == "simulator") {
    require_lens(cell);
    return nullptr;
  }
  live.long_throw_planes = hl2ss_long_throw_planes;
  if (auto opened = open_live_source(cell, live)) return opened;
  if (source.path.empty()) {
    throw InputError(source.position + ".path: missing; expected the file or folder of the " +
                     printable(source.kind));
  }
  const auto kind = std::find_if(k_kinds.begin(), k_kinds.end(),
                                 [&](const SourceKind& one) { return one.name == source.kind; });
  if (kind == k_kinds.end()) {
    throw InputError(source.position + ".kind: \"" + printable(source.kind) +
                     "\"; expected simulator, " + live_kinds() + ", " + recorded_kinds());
  }
  Opened reader = kind->open(cell, tolerance);
  if (!names_lens(cell)) {
    if (auto lens = reader->lens()) set_lens(cell, std::move(*lens));
  }
  require_lens(cell);
  return std::make_unique<FileSource>(std::move(reader), cell.camera, live.duration);
}

}  // namespace glint
