// Strokes file as MCAP: one message glint_msgs/Stroke for each element on /glint/stroke, with names
// and covariances, for viewers and ROS 2.
#pragma once

#include <string>

#include "platform/tools/programming/strokes_json.hpp"

namespace glint {

// Throws InputError if the file cannot be written completely.
void write_strokes_recording(const std::string& file, const StrokesFile& strokes);

}  // namespace glint
