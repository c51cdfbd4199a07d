// glint.Tracker: the frame group on numpy images.
#include <cmath>
#include <cstdint>
#include <mutex>
#include <optional>

#include "platform/apps/python/bindings.hpp"
#include "platform/apps/python/frame_tracker.hpp"
#include "platform/apps/python/recording.hpp"
#include "platform/sources/head_pose_check.hpp"
#include "platform/sources/matrix_pose.hpp"

namespace glint::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "shape (";
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + ")";
}

// The pixels of a C-contiguous array of this type with the camera's size; nothing is copied.
template <class Pixel>
ImageView<Pixel> image_of(const py::array& array, const char* name, const Camera& camera) {
  const int width = camera.model.width, height = camera.model.height;
  std::string wrong;
  if (!py::isinstance<py::array_t<Pixel>>(array)) {
    wrong = "dtype " + std::string(py::str(py::object(array.dtype())));
  } else if (array.ndim() != 2 || array.shape(0) != height || array.shape(1) != width) {
    wrong = shape_text(array);
  } else if ((array.flags() & py::array::c_style) == 0) {
    wrong = "not C-contiguous";
  } else {
    return {static_cast<const Pixel*>(array.data()), width, height};
  }
  throw InputError(std::string(name) + ": " + wrong + "; expected uint" +
                   std::to_string(8 * sizeof(Pixel)) + ", shape (" + std::to_string(height) + ", " +
                   std::to_string(width) + "), C-contiguous (" + camera.name + ")");
}

// T_world_camera: a 4x4 matrix, or x y z qx qy qz qw.
HeadPose head_of(const py::object& given, Time time) {
  HeadPose head;
  head.time = time;
  if (given.is_none()) return head;
  using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const auto numbers = Numbers::ensure(given);
  if (!numbers) {
    PyErr_Clear();
    throw InputError("head_pose: not numbers; expected a 4x4 matrix or x y z qx qy qz qw");
  }
  const double* const n = numbers.data();
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(n[i]))
      throw InputError("head_pose: a number is not finite; expected None for an unknown pose");
  }
  if (numbers.ndim() == 2 && numbers.shape(0) == 4 && numbers.shape(1) == 4) {
    MatrixNumbers matrix{};
    std::copy_n(n, matrix.size(), matrix.begin());
    const std::optional<Pose> pose = pose_of_matrix(matrix);
    if (!pose) {
      throw InputError(
          "head_pose: not a rigid transform; expected T_world_camera with an orthonormal rotation "
          "and the last row 0 0 0 1");
    }
    head.T_world_camera = *pose;
  } else if (numbers.ndim() == 1 && numbers.shape(0) == 7) {
    head.T_world_camera = {Quaternion(n[6], n[3], n[4], n[5]), Vector3(n[0], n[1], n[2])};
  } else {
    throw InputError("head_pose: " + shape_text(numbers) + "; expected (4, 4) or (7,)");
  }
  head.valid = true;
  check_head_pose(head);
  if (!head.valid) {
    throw InputError(
        "head_pose: not a unit quaternion, or beyond 10 km; expected metres and a rotation");
  }
  head.time = time;
  return head;
}

class ArrayTracker {
 public:
  ArrayTracker(Cell cell, PoseOrigin origin)
      : cell_(std::move(cell)), tracker_((require_lens(cell_), cell_), origin) {}

  py::array_t<FramePoseRow> track(const py::array& reflectivity, const py::array& depth,
                                  std::int64_t time_ns, const py::object& head_pose,
                                  std::optional<std::uint64_t> sequence,
                                  std::int64_t stamp_sigma_ns) {
    const Camera& camera = cell_.camera;
    Frame frame;
    frame.mid_exposure = frame.arrival = Time{time_ns};
    frame.stamp_sigma = Duration{stamp_sigma_ns};
    if (stamp_sigma_ns < 0) throw InputError("stamp_sigma_ns: negative; expected 0 or more");
    if (camera.reflectivity_bits == 8) {
      frame.reflectivity_8 = image_of<std::uint8_t>(reflectivity, "reflectivity", camera);
    } else {
      frame.reflectivity_16 = image_of<std::uint16_t>(reflectivity, "reflectivity", camera);
    }
    frame.depth = image_of<std::uint16_t>(depth, "depth", camera);
    const HeadPose head = head_of(head_pose, frame.mid_exposure);
    std::vector<FramePoseRow> rows;
    {
      const py::gil_scoped_release released;
      const std::lock_guard lock(mutex_);
      frame.sequence = sequence.value_or(next_sequence_);
      next_sequence_ = frame.sequence + 1;
      rows = tracker_.track(frame, head);
    }
    return array_of(rows);
  }

  [[nodiscard]] const Cell& cell() const { return cell_; }

 private:
  Cell cell_;
  std::mutex mutex_;  // of two Python threads, one tracks
  FrameTracker tracker_;
  std::uint64_t next_sequence_ = 0;
};

constexpr const char* k_track_doc =
    "Track one frame: a structured array with one row for each tool of the cell.\n\n"
    "reflectivity: uint16 (uint8 for an 8-bit camera), (H, W), C-contiguous, raw counts.\n"
    "depth: uint16, (H, W), C-contiguous, the camera's raw unit; 0: invalid.\n"
    "time_ns: middle of the exposure, int64; frames in the order of their times.\n"
    "head_pose: T_world_camera as 4x4 matrix or x y z qx qy qz qw (m); None: unknown, the poses\n"
    "are then in the camera's frame. A 4x4 matrix is rounded as it is converted.\n"
    "sequence: the frame's number; default: the previous one plus 1.\n"
    "stamp_sigma_ns: standard deviation of time_ns.\n\n"
    "The row's fields: see FRAME_POSE. Raises InputError. Python's lock is released meanwhile.";

}  // namespace

void bind_tracker(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(FramePoseRow, time_ns, sequence, tool, state, reason, frame, marker_mask,
                       rms_m, position_m, orientation_xyzw, covariance);
  module.attr("FRAME_POSE") = py::dtype::of<FramePoseRow>();
  py::class_<ArrayTracker>(module, "Tracker",
                           "The tracker of a cell, fed frame by frame from numpy images.\n\n"
                           "It keeps the tracks from frame to frame. Trackers are independent.")
      .def(py::init([](const std::string& cell, const std::string& origin) {
             return std::make_unique<ArrayTracker>(cell_of(cell), origin_of(origin));
           }),
           py::arg("cell") = "", py::arg("origin") = "tool",
           "cell: path of a cell file, or its text; default: the built-in cell. origin: of the\n"
           "poses, tool or tip. Raises InputError for a wrong cell.")
      .def(py::init([](const Recording& recording, const std::string& origin) {
             return std::make_unique<ArrayTracker>(recording.cell(), origin_of(origin));
           }),
           py::arg("recording"), py::arg("origin") = "tool",
           "recording: a Recording, whose own cell, tools and calibration files are used.")
      .def("track", &ArrayTracker::track, py::arg("reflectivity"), py::arg("depth"),
           py::arg("time_ns"), py::arg("head_pose") = py::none(), py::arg("sequence") = py::none(),
           py::arg("stamp_sigma_ns") = 0, k_track_doc)
      .def_property_readonly(
          "tools", [](const ArrayTracker& tracker) { return tool_names(tracker.cell()); },
          "Names of the tools, by the number in the field tool.")
      .def_property_readonly(
          "shape",
          [](const ArrayTracker& tracker) {
            const CameraModel& model = tracker.cell().camera.model;
            return py::make_tuple(model.height, model.width);
          },
          "(H, W) of the camera's images, pixels.");
}

}  // namespace glint::python
