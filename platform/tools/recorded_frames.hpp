// Recorded frames through the frame graph, in order and without ticks: what calibration and export
// read.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

// A cell whose [source] is recorded frames: `source` where it is given, of this kind or else by
// what is there. Without a cell file a recording's own cell holds. Throws InputError: nothing
// recorded.
[[nodiscard]] Cell recorded_source_cell(const std::string& source, const std::string& config,
                                        const std::string& kind, ReadTolerance tolerance = {});

struct RecordedFrames {
  std::string path;
  Cell cell;  // with the source's lens, where the cell names none
  std::unique_ptr<FrameSource> source;
};

// Throws InputError as recorded_source_cell() and open_source() do.
[[nodiscard]] RecordedFrames open_recorded(const std::string& path, const std::string& config,
                                           const std::string& kind = {});

// The index of the cell's tool with this name; empty: the first. Any other name is a built-in tool
// or a tool file, which then is the cell's only tool. Throws InputError: neither.
[[nodiscard]] std::size_t select_tool(Cell& cell, const std::string& name);

// The cell has this tool and no other.
void set_only_tool(Cell& cell, const Tool& tool);

enum class Search {
  tracked,    // as a run does: once a tool is tracked, only around it
  everywhere  // each frame whole, as if its tools had just come
};

struct TrackedFrames {
  int frames = 0;
  std::vector<std::string> failures;  // of the source: what could not be read, a line each
};

// Activates the frame graph with each frame and calls `visit` after each that was accepted. A
// source is read once.
TrackedFrames track_frames(RecordedFrames& recorded, Search search,
                           const std::function<void(const ArrivedFrame&, Tracker&)>& visit);

// The centres of all markers that have a range, in the camera's frame, m. A centre lies behind the
// measured surface as one of this tool's markers does.
[[nodiscard]] std::vector<Vector3> marker_centres(const Markers& markers, const Tool& tool);

}  // namespace glint
