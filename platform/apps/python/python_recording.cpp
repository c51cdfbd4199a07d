// glint.open: recordings as numpy arrays.
#include <memory>
#include <optional>
#include <utility>

#include "platform/apps/python/bindings.hpp"
#include "platform/apps/python/recording.hpp"
#include "platform/sources/recording_frames.hpp"

namespace glint::python {
namespace {

struct RecordedFrame {
  std::int64_t time_ns, arrival_ns, stamp_sigma_ns;
  std::uint64_t sequence;
  py::object reflectivity, depth, head_pose;
};

template <class Pixel>
py::object image_of(const std::vector<Pixel>& pixels, int width, int height) {
  if (pixels.empty()) return py::none();
  return py::array_t<Pixel>({height, width}, pixels.data());
}

py::object head_of(const HeadPose& head) {
  if (!head.valid) return py::none();
  const Vector3& p = head.T_world_camera.translation;
  const Quaternion& q = head.T_world_camera.rotation;
  const double numbers[] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  return py::array_t<double>(7, numbers);
}

RecordedFrame frame_of(const ReadFrame& read) {
  const FrameBuffer& pixels = read.pixels;
  return {read.mid_exposure.nanoseconds,
          read.arrival.value_or(read.mid_exposure).nanoseconds,
          read.stamp_sigma.nanoseconds,
          read.sequence.value_or(0),
          pixels.reflectivity_8.empty()
              ? image_of(pixels.reflectivity_16, pixels.width, pixels.height)
              : image_of(pixels.reflectivity_8, pixels.width, pixels.height),
          image_of(pixels.depth, pixels.width, pixels.height),
          head_of(read.head)};
}

class FrameIterator {
 public:
  explicit FrameIterator(const Recording& recording)
      : frames_(recording.path(), recording.tolerance()) {}
  RecordedFrame next() {
    bool found = false;
    {
      const py::gil_scoped_release released;
      found = frames_.next(read_);
    }
    if (!found) throw py::stop_iteration();
    return frame_of(read_);
  }

 private:
  RecordingFrames frames_;
  ReadFrame read_;
};

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

// (kind, value) of a message: a row as a table's, "frame" a Frame, "blobs" an array.
class MessageIterator {
 public:
  explicit MessageIterator(const Recording& recording)
      : path_(recording.path()), reader_(recording.reader()) {}
  py::tuple next() {
    std::optional<RecordedMessage> message;
    {
      const py::gil_scoped_release released;
      message = reader_.next();
    }
    if (!message) throw py::stop_iteration();
    return std::visit([this](const auto& item) { return of(item); }, *message);
  }

 private:
  template <class Row>
  static py::tuple with_row(const char* kind, const Row& row) {
    return py::make_tuple(kind, array_of(std::vector<Row>{row})[py::int_(0)]);
  }
  py::tuple of(const FrameMessage& frame) {
    const ReadFrame read{frame.pixels,  frame.mid_exposure, frame.stamp_sigma,
                         frame.arrival, frame.sequence,     head_};
    return py::make_tuple("frame", frame_of(read));
  }
  py::tuple of(const HeadPose& head) {
    head_ = head;
    return with_row("head_pose", row_of(head));
  }
  py::tuple of(const MarkerFrame& frame) {
    return py::make_tuple("blobs", array_of(rows_of(frame)));
  }
  py::tuple of(const OutputMessage& output) { return with_row("tick_pose", row_of(output, path_)); }
  py::tuple of(const ChoiceRecord& choice) { return with_row("choice", row_of(choice)); }
  py::tuple of(const DroppedInput& input) { return with_row("dropped", row_of(input)); }
  py::tuple of(const ButtonEvent& event) { return with_row("button", row_of(event)); }
  py::tuple of(const RobotFrameRecord& frame) { return with_row("robot_frame", row_of(frame)); }
  py::tuple of(const PenButtonsRecord& held) { return with_row("held_buttons", row_of(held)); }

  std::string path_;
  RecordingReader reader_;
  HeadPose head_;  // the newest: it precedes its frame
};

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

void bind_frames(py::module_& module) {
  py::class_<RecordedFrame>(module, "Frame", "One recorded camera frame.")
      .def_readonly("time_ns", &RecordedFrame::time_ns, "Middle of the exposure.")
      .def_readonly("arrival_ns", &RecordedFrame::arrival_ns, "Last byte in memory.")
      .def_readonly("stamp_sigma_ns", &RecordedFrame::stamp_sigma_ns,
                    "Standard deviation of time_ns; 0: not stated.")
      .def_readonly("sequence", &RecordedFrame::sequence, "Number of the frame.")
      .def_readonly("reflectivity", &RecordedFrame::reflectivity,
                    "uint8 or uint16, (H, W), raw counts; outside recorded regions 0. Or None.")
      .def_readonly("depth", &RecordedFrame::depth,
                    "uint16, (H, W), the camera's raw unit, 0: invalid or not recorded. Or None.")
      .def_readonly("head_pose", &RecordedFrame::head_pose,
                    "T_world_camera, x y z qx qy qz qw, (7,) float64, m. None: not known.");
  py::class_<FrameIterator>(module, "FrameIterator")
      .def("__iter__", [](FrameIterator& self) -> FrameIterator& { return self; })
      .def("__next__", &FrameIterator::next);
  py::class_<MessageIterator>(module, "MessageIterator")
      .def("__iter__", [](MessageIterator& self) -> MessageIterator& { return self; })
      .def("__next__", &MessageIterator::next);
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
