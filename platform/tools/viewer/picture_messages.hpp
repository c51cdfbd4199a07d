// Serialisation of one examined frame for viewers: picture, camera, regions.
#pragma once

#include <span>

#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "platform/cells/cell.hpp"
#include "platform/sinks/record/cdr.hpp"
#include "platform/tools/inspect/examined_frame.hpp"

namespace glint {

// Each starts a message in the writer; `stamp` is since 1970.

// sensor_msgs/Image, mono16; 8-bit reflectivity keeps its counts.
void write_picture(CdrWriter& to, Time stamp, const Frame& frame);
// sensor_msgs/CameraInfo. A lens with a table of rays is described by its nearest lens with a
// model.
void write_camera_info(CdrWriter& to, Time stamp, const CameraModel& model);
// glint_msgs/Regions.
void write_regions(CdrWriter& to, Time stamp, std::span<const Roi> searched,
                   const ExaminedFrame& examined);

}  // namespace glint
