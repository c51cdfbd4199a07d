// What the module's files share: their entry points, arrays of rows, and cells by name.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <string_view>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/frame_pose.hpp"

namespace glint::python {

namespace py = pybind11;

void bind_recording(py::module_& module);
void bind_tracker(py::module_& module);

template <class Row>
[[nodiscard]] py::array_t<Row> array_of(const std::vector<Row>& rows) {
  return py::array_t<Row>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

// The cell of a file, of a TOML text (it has a newline), or, if empty, the built-in one.
[[nodiscard]] inline Cell cell_of(const std::string& cell) {
  if (cell.empty()) return default_cell();
  return cell.find('\n') == std::string::npos ? load_cell(cell) : cell_from_text(cell, "cell");
}

[[nodiscard]] inline PoseOrigin origin_of(std::string_view name) {
  if (name == "tool") return PoseOrigin::tool;
  if (name == "tip") return PoseOrigin::tip;
  throw InputError("origin: \"" + std::string(name) + "\"; expected tool or tip");
}

[[nodiscard]] inline std::vector<std::string> tool_names(const Cell& cell) {
  std::vector<std::string> names;
  for (int t = 0; t < cell.tools.count; ++t)
    names.emplace_back(cell.tools.items[static_cast<std::size_t>(t)].name.data());
  return names;
}

}  // namespace glint::python
