// Conversion of a recording's messages to rows.
#pragma once

#include <string>
#include <vector>

#include "platform/apps/python/rows.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint::python {

// Decodes the output record. Throws InputError with `path` for an invalid one.
[[nodiscard]] TickPoseRow row_of(const OutputMessage& message, const std::string& path);
[[nodiscard]] std::vector<BlobRow> rows_of(const MarkerFrame& frame);
[[nodiscard]] HeadPoseRow row_of(const HeadPose& pose);
[[nodiscard]] ButtonRow row_of(const ButtonEvent& event);
[[nodiscard]] HeldButtonsRow row_of(const PenButtonsRecord& buttons);
[[nodiscard]] RobotFrameRow row_of(const RobotFrameRecord& frame);
[[nodiscard]] ChoiceRow row_of(const ChoiceRecord& choice);
[[nodiscard]] DroppedRow row_of(const DroppedInput& input);

}  // namespace glint::python
