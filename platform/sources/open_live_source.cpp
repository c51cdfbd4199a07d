#include "platform/sources/open_live_source.hpp"

#include <algorithm>
#include <array>

#include "platform/input_error.hpp"
#include "platform/sources/dds_source.hpp"
#include "platform/sources/hl2ss_source.hpp"
#include "platform/sources/shm_source.hpp"

namespace glint {
namespace {

struct LiveKind {
  const char* name;
  std::unique_ptr<LiveSource> (*open)(Cell& cell, LiveSettings live);
};

constexpr std::array k_live_kind_list = {
    LiveKind{"dds",
             [](Cell& cell, LiveSettings live) -> std::unique_ptr<LiveSource> {
               return DdsSource::open(cell, live);
             }},
    LiveKind{"hl2ss",
             [](Cell& cell, LiveSettings live) -> std::unique_ptr<LiveSource> {
               return Hl2ssSource::open(cell, live);
             }},
    LiveKind{"shm", [](Cell& cell, LiveSettings live) -> std::unique_ptr<LiveSource> {
               if (cell.source.path.empty()) {
                 throw InputError(cell.source.position +
                                  ".path: missing; expected the path of the shm socket");
               }
               require_lens(cell);
               return std::make_unique<ShmSource>(cell.source.path, cell.camera, live);
             }}};

}  // namespace

std::string live_kinds() {
  std::string names;
  for (const LiveKind& kind : k_live_kind_list)
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

std::unique_ptr<LiveSource> open_live_source(Cell& cell, LiveSettings live) {
  const SourceSettings& source = cell.source;
  const auto kind = std::find_if(k_live_kind_list.begin(), k_live_kind_list.end(),
                                 [&](const LiveKind& one) { return one.name == source.kind; });
  if (kind == k_live_kind_list.end()) return nullptr;
  if (!cell.realtime) {
    throw InputError(source.position + ".kind: " + source.kind +
                     " is a live source; expected a run in real time");
  }
  return kind->open(cell, live);
}

}  // namespace glint
