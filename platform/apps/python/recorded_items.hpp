// Iterators of a recording in Python: its frames, and every message with its kind.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "platform/apps/python/bindings.hpp"
#include "platform/apps/python/recording.hpp"
#include "platform/sources/recording_frames.hpp"

namespace glint::python {

struct RecordedFrame {
  std::int64_t time_ns, arrival_ns, stamp_sigma_ns;
  std::uint64_t sequence;
  py::object reflectivity, depth, head_pose;
};

template <class Pixel>
py::object image_array(const std::vector<Pixel>& pixels, int width, int height) {
  if (pixels.empty()) return py::none();
  return py::array_t<Pixel>({height, width}, pixels.data());
}

inline py::object head_array(const HeadPose& head) {
  if (!head.valid) return py::none();
  const Vector3& p = head.T_world_camera.translation;
  const Quaternion& q = head.T_world_camera.rotation;
  const double numbers[] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  return py::array_t<double>(7, numbers);
}

inline RecordedFrame frame_of(const ReadFrame& read) {
  const FrameBuffer& pixels = read.pixels;
  return {read.mid_exposure.nanoseconds,
          read.arrival.value_or(read.mid_exposure).nanoseconds,
          read.stamp_sigma.nanoseconds,
          read.sequence.value_or(0),
          pixels.reflectivity_8.empty()
              ? image_array(pixels.reflectivity_16, pixels.width, pixels.height)
              : image_array(pixels.reflectivity_8, pixels.width, pixels.height),
          image_array(pixels.depth, pixels.width, pixels.height),
          head_array(read.head)};
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

// Its items: (kind, value) of a message: a row as a table's, "frame" a Frame, "blobs" an array.
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

inline void bind_frames(py::module_& module) {
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

}  // namespace glint::python
