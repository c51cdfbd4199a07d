// import glint: recordings and CAN logs as numpy arrays, the tracker on numpy images, experiments.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/reason.hpp"
#include "platform/apps/python/bindings.hpp"
#include "platform/apps/python/can_log.hpp"
#include "platform/sinks/record/button_event.hpp"

namespace glint::python {
namespace {

// An error that is no wrong input: a missing program, or an experiment that failed.
struct Failure : std::runtime_error {
  explicit Failure(const std::string& message) : std::runtime_error(one_line(message)) {}
};

// Errors of this module only: another module's InputError keeps its own.
void bind_errors(py::module_& module) {
  static py::handle failure, input;  // the translator has no state of its own
  const py::exception<Failure> base(module, "Error");
  failure = base;
  failure.attr("__doc__") = "Base of the module's errors: one line, as the commands print it.";
  input = py::exception<InputError>(module, "InputError",
                                    py::make_tuple(base, py::handle(PyExc_ValueError)))
              .release();
  input.attr("__doc__") = "A wrong argument, file or image: place, found, expected.";
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const InputError& wrong) {
      PyErr_SetString(input.ptr(), wrong.what());
    } catch (const Failure& failed) {
      PyErr_SetString(failure.ptr(), failed.what());
    }
  });
}

void bind_names(py::module_& module) {
  module.attr("STATES") = py::make_tuple("none", "predicted", "measured", "lost");
  module.attr("REGISTRATIONS") = py::make_tuple("none", "given", "accepted", "refused");
  module.attr("REFERENCE_FRAMES") = py::make_tuple("camera", "world", "robot");
  module.attr("BUTTONS") = py::make_tuple("draw", "delete_last", "undo", "finish");
  py::list reasons;
  for (std::size_t i = 0; i < k_reasons; ++i)
    reasons.append(std::string(name_of(static_cast<Reason>(i))));
  module.attr("REASONS") = py::tuple(reasons);
}

std::string lab_beside(const std::string& module_file) {
  const std::filesystem::path folder = std::filesystem::path(module_file).parent_path();
  for (const auto& place : {folder / "glint_lab", folder.parent_path() / "glint_lab"})
    if (std::filesystem::exists(place)) return place.string();
  throw Failure(folder.string() +
                ": no glint_lab in this folder or the one above; expected "
                "it there, or its path in lab");
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return "no output";
  const auto begin = text.find_last_of('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1, end - begin);
}

// A folder of the system's, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : folder_(py::module_::import("tempfile")
                    .attr("TemporaryDirectory")(py::arg("prefix") = "glint_")) {}
  ~TemporaryFolder() {
    try {
      folder_.attr("cleanup")();
    } catch (const std::exception&) {
      return;  // it stays, as the system's other temporary files
    }
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string path() const { return py::str(folder_.attr("name")); }

 private:
  py::object folder_;
};

// glint_lab experiment NAME --OPTION VALUE ... --json FILE, as a process.
py::object experiment(const std::string& module_file, const std::string& name,
                      const std::optional<std::string>& lab, py::dict options) {
  const TemporaryFolder folder;
  const std::string path = folder.path();
  const std::string json = path + "/figures.json";
  py::list words;  // the command's default folder of its plots would be the caller's
  if (!options.contains("out")) options["out"] = path;
  words.append(lab ? *lab : lab_beside(module_file));
  words.append("experiment");
  words.append(name);
  for (const auto& [key, value] : options) {
    std::string option = py::str(key);
    std::replace(option.begin(), option.end(), '_', '-');
    if (py::isinstance<py::bool_>(value)) {
      if (value.cast<bool>()) words.append("--" + option);
    } else {
      words.append("--" + option);
      words.append(py::str(value));
    }
  }
  words.append("--json");
  words.append(json);
  py::object done;
  try {
    done = py::module_::import("subprocess")
               .attr("run")(words, py::arg("capture_output") = true, py::arg("text") = true,
                            py::arg("errors") = "replace");
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_OSError)) throw;
    throw Failure(std::string(py::str(error.value())) + "; expected the program glint_lab");
  }
  const int code = done.attr("returncode").cast<int>();
  const std::string errors = py::str(done.attr("stderr"));
  if (code == 2) throw InputError(last_line(errors));
  if (code != 0) {
    const std::string printed = errors.empty() ? std::string(py::str(done.attr("stdout"))) : errors;
    throw Failure("experiment " + name + ": exit code " + std::to_string(code) + ": " +
                  last_line(printed));
  }
  const auto file = py::module_::import("io").attr("open")(json);
  const py::object figures = py::module_::import("json").attr("load")(file);
  file.attr("close")();
  return figures;
}

}  // namespace
}  // namespace glint::python

PYBIND11_MODULE(glint, module) {
  using namespace glint::python;
  module.doc() =
      "Glint: recordings and CAN logs as numpy arrays, the tracker on numpy images, "
      "experiments.\n\n"
      "Lengths are metres, angles radians, times int64 nanoseconds, quaternions x y z w.\n"
      "T_a_b maps coordinates in b to a. The camera: x right, y down, z forward.";
  bind_errors(module);
  bind_names(module);
  bind_tracker(module);
  bind_recording(module);
  PYBIND11_NUMPY_DTYPE(CanPoseRow, unix_ns, tick, lost, tool, counter, state, registration, markers,
                       buttons, valid, complete, checksum_ok, position_m, orientation_xyzw,
                       velocity_m_s, angular_velocity_rad_s, sigma_position_m,
                       sigma_orientation_rad, age_s, registration_rms_m);
  module.attr("CAN_POSE") = py::dtype::of<CanPoseRow>();
  module.def(
      "read_can_log",
      [](const std::string& path, const std::string& cell) {
        std::vector<CanPoseRow> rows;
        {
          const py::gil_scoped_release released;
          rows = read_can_log(path, cell_of(cell));
        }
        return array_of(rows);
      },
      py::arg("path"), py::arg("cell") = "",
      "Poses of a log of `candump -L`, one row for each tool and tick: CAN_POSE.\n\n"
      "cell: path or text; it names identifiers and frame format; default: the built-in cell.\n"
      "lost: ticks without a frame before this one. complete: all frames of the pose, with right\n"
      "checksums. Numbers of missing or wrong frames are NaN. Raises InputError: file:line.");
  module.def(
      "experiment",
      [module](const std::string& name, const std::optional<std::string>& lab,
               const py::kwargs& options) {
        return experiment(py::str(module.attr("__file__")), name, lab, options);
      },
      py::arg("name"), py::kw_only(), py::arg("lab") = py::none(),
      "Run `glint experiment NAME`; its figures as a dict.\n\n"
      "lab: path of glint_lab; default: beside the module or in the folder above. Options are the\n"
      "command's: seed=3 is --seed 3, flag=True is --flag. Raises InputError for a wrong option,\n"
      "Error with the last line if a bar is missed or the program is missing.");
}
