#include "platform/apps/board/board_checks.hpp"

#include <string>

#include "platform/input_error.hpp"

namespace glint {
void check_camera(const Cell& cell, const FrameLoop& loop) {
  const FrameLoopHeader& header = loop.header();
  const CameraModel& model = cell.camera.model;
  const auto text = [](auto width, auto height, auto bits) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
           std::to_string(bits) + " bits";
  };
  const std::string found = text(header.width, header.height, header.reflectivity_bits);
  const std::string expected = text(model.width, model.height, cell.camera.reflectivity_bits);
  if (found != expected) {
    throw InputError("the loop has frames of " + found + "; expected " + expected +
                     " (the cell's camera)");
  }
}

void check_for_companion(const Cell& cell) {
  if (cell.tool_changes.empty()) return;
  throw InputError(cell.file +
                   ": [[tool_change]] is not supported on a board; expected none (absent = [..] "
                   "leaves tools out from the start)");
}

}  // namespace glint
