// glint.open: recordings as numpy arrays.
#include <memory>
#include <optional>
#include <utility>

#include "platform/apps/python/bindings.hpp"
#include "platform/apps/python/recorded_items.hpp"
#include "platform/apps/python/recording.hpp"

namespace glint::python {
namespace {

// Rows of the messages of type Message, read without Python's lock.
template <class Message, class Row>
py::array_t<Row> table(const Recording& recording) {
  std::vector<Row> rows;
  {
    const py::gil_scoped_release released;
    rows = recording.rows<Message, Row>(
        [](const Message& message, auto& to) { to.push_back(row_of(message)); });
  }
  return array_of(rows);
}

template <class Row>
py::array_t<Row> of_tool(const Recording& recording, std::vector<Row> rows,
                         const std::optional<std::string>& tool) {
  if (tool) {
    const std::uint8_t index = recording.tool_index(*tool);
    std::erase_if(rows, [&](const Row& row) { return row.tool != index; });
  }
  return array_of(rows);
}

py::array_t<FramePoseRow> frame_poses(const Recording& recording,
                                      const std::optional<std::string>& tool,
                                      const std::string& origin) {
  const PoseOrigin wanted = origin_of(origin);
  std::vector<FramePoseRow> rows;
  {
    const py::gil_scoped_release released;
    rows = recording.frame_poses(wanted);
  }
  return of_tool(recording, std::move(rows), tool);
}

py::array_t<TickPoseRow> tick_poses(const Recording& recording,
                                    const std::optional<std::string>& tool) {
  std::vector<TickPoseRow> rows;
  {
    const py::gil_scoped_release released;
    rows = recording.rows<OutputMessage, TickPoseRow>([&](const OutputMessage& message, auto& to) {
      to.push_back(row_of(message, recording.path()));
    });
  }
  return of_tool(recording, std::move(rows), tool);
}

py::array_t<BlobRow> blobs(const Recording& recording) {
  std::vector<BlobRow> rows;
  {
    const py::gil_scoped_release released;
    rows = recording.rows<MarkerFrame, BlobRow>([](const MarkerFrame& frame, auto& to) {
      const std::vector<BlobRow> found = rows_of(frame);
      to.insert(to.end(), found.begin(), found.end());
    });
  }
  return array_of(rows);
}

py::dict info(const Recording& recording) {
  py::dict info;
  info["path"] = recording.path();
  info["level"] = std::string(name_of(recording.level()));
  info["nominal_tick_ns"] = recording.nominal_tick().nanoseconds;
  info["unix_offset_ns"] = recording.unix_offset().nanoseconds;
  info["tools"] = tool_names(recording.cell());
  info["attachments"] = recording.attachments();
  info["facts"] = recording.facts();
  return info;
}

py::dict losses(const Recording& recording) {
  RecordingLosses found;
  {
    const py::gil_scoped_release released;
    found = recording.losses();
  }
  py::dict losses;
  losses["frames"] = found.frames;
  losses["messages"] = found.messages;
  losses["chunks"] = found.chunks;
  losses["bytes"] = found.bytes;
  losses["at_least"] = found.at_least;
  return losses;
}

void bind_rows(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(TickPoseRow, time_ns, measurement_ns, tick, sequence, tool, state, reason,
                       registration, frame, marker_mask, buttons, position_m, orientation_xyzw,
                       velocity_m_s, angular_velocity_rad_s, covariance, systematic,
                       sigma_position_m, sigma_orientation_rad, registration_rms_m);
  PYBIND11_NUMPY_DTYPE(BlobRow, time_ns, sequence, ray, surface_range_m, centroid_px, sigma_px,
                       range_sigma_m, bias_subtracted_m, area_px, peak, flags);
  PYBIND11_NUMPY_DTYPE(HeadPoseRow, time_ns, valid, position_m, orientation_xyzw);
  PYBIND11_NUMPY_DTYPE(ButtonRow, time_ns, button, pressed);
  PYBIND11_NUMPY_DTYPE(HeldButtonsRow, time_ns, version, held);
  PYBIND11_NUMPY_DTYPE(RobotFrameRow, time_ns, version, state, in_reference, rms_m, position_m,
                       orientation_xyzw);
  PYBIND11_NUMPY_DTYPE(ChoiceRow, time_ns, unix_offset_ns, activation, versions, group,
                       version_count, overrun, policy, after_node);
  PYBIND11_NUMPY_DTYPE(DroppedRow, time_ns, arrival_ns, sequence, reason);
  module.attr("TICK_POSE") = py::dtype::of<TickPoseRow>();
}

}  // namespace

void bind_recording(py::module_& module) {
  bind_rows(module);
  bind_frames(module);
  py::class_<Recording>(module, "Recording",
                        "A recording. Iteration gives (kind, value) for each message in order.\n\n"
                        "Each method reads the file anew. Times are nanoseconds of the run's\n"
                        "clock; plus info()['unix_offset_ns'] they are Unix times.")
      .def("__iter__", [](const Recording& self) { return MessageIterator(self); })
      .def(
          "frames", [](const Recording& self) { return FrameIterator(self); },
          "Iterator of Frame. Raises InputError at levels blobs and outputs.")
      .def("frame_poses", &frame_poses, py::arg("tool") = py::none(), py::arg("origin") = "tool",
           "Poses of each frame and tool, tracked anew as `glint export csv` does: FRAME_POSE.\n\n"
           "tool: a name, or None for all. origin: tool or tip. Without a measured pose its\n"
           "numbers are NaN. Raises InputError at levels blobs and outputs.")
      .def("tick_poses", &tick_poses, py::arg("tool") = py::none(),
           "Output poses of the tip, one for each tick and tool, as recorded: TICK_POSE.")
      .def("blobs", &blobs, "Marker candidates of each frame (level blobs).")
      .def("head_poses", &table<HeadPose, HeadPoseRow>, "T_world_camera of each frame.")
      .def("buttons", &table<ButtonEvent, ButtonRow>, "Events of the pen's buttons: BUTTONS.")
      .def("held_buttons", &table<PenButtonsRecord, HeldButtonsRow>,
           "Versions of the held buttons: bit i is BUTTONS[i].")
      .def("robot_frames", &table<RobotFrameRecord, RobotFrameRow>,
           "Versions of T_world_robot, or T_reference_robot.")
      .def("choices", &table<ChoiceRecord, ChoiceRow>, "Inputs of each activation, for replay.")
      .def("dropped", &table<DroppedInput, DroppedRow>, "Rejected frames and their reason.")
      .def("losses", &losses, "Data of the file that was skipped, as a dict of numbers.")
      .def("info", &info, "Level, tools, period of the ticks, facts and attachments, as a dict.")
      .def(
          "attachment",
          [](const Recording& self, const std::string& name) {
            const Attachment found = self.reader().attachment(name);
            return py::bytes(reinterpret_cast<const char*>(found.data.data()), found.data.size());
          },
          py::arg("name"), "Bytes of an attached file. Raises InputError, which lists the names.")
      .def_property_readonly("path", &Recording::path)
      .def_property_readonly(
          "cell_text", [](const Recording& self) { return self.cell().text; },
          "The cell file of the run, as text.");
  module.def(
      "open",
      [](const std::string& path, bool allow_truncated) {
        return std::make_unique<Recording>(path, ReadTolerance{allow_truncated, allow_truncated});
      },
      py::arg("path"), py::arg("allow_truncated") = false,
      "Open a recording (MCAP). allow_truncated: read the intact part of a truncated, damaged or\n"
      "incomplete one; losses() counts the rest. Raises InputError: path, byte and expectation.");
}

}  // namespace glint::python
