#include "platform/sources/open_source.hpp"

#include <algorithm>
#include <array>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sources/file_source.hpp"
#include "platform/sources/folder_frames.hpp"
#include "platform/sources/recording_frames.hpp"

namespace glint {
namespace {

using Opened = std::unique_ptr<FrameReader>;

struct SourceKind {
  const char* name;
  Opened (*open)(const Cell& cell, ReadTolerance tolerance);
};

constexpr std::array k_kinds = {
    SourceKind{"folder",
               [](const Cell& cell, ReadTolerance) -> Opened {
                 return std::make_unique<FolderFrames>(cell.source.path, cell.camera);
               }},
    SourceKind{"recording",
               [](const Cell& cell, ReadTolerance tolerance) -> Opened {
                 return std::make_unique<RecordingFrames>(cell.source.path, tolerance);
               }},
};

}  // namespace

std::string recorded_kinds() {
  std::string names;
  for (const SourceKind& kind : k_kinds)
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

std::unique_ptr<FrameSource> open_recorded(const Cell& cell, ReadTolerance tolerance) {
  const SourceSettings& source = cell.source;
  const auto kind = std::find_if(k_kinds.begin(), k_kinds.end(),
                                 [&](const SourceKind& one) { return one.name == source.kind; });
  if (kind == k_kinds.end()) {
    throw InputError(source.place + ".kind: \"" + printable(source.kind) +
                     "\"; expected simulator, " + recorded_kinds());
  }
  if (source.path.empty()) {
    throw InputError(source.place + ".path: none; expected the file or folder of the " +
                     source.kind);
  }
  return std::make_unique<FileSource>(kind->open(cell, tolerance), cell.camera);
}

}  // namespace glint
