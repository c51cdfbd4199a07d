// Reports of a run: the table of its summary, and plots.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "platform/runtime/session/session.hpp"

namespace glint {

void print_table(const nlohmann::ordered_json& summary, const SessionResult& result);

// Prints the rows of the files from index `first` on.
void print_files(const SessionResult& result, std::size_t first);

// Writes tip_error.svg, tip_path.svg and frame_to_can.svg into `folder`; appends their names to
// result.files. Throws InputError if one cannot be written.
void draw_plots(const std::string& folder, SessionResult& result);

}  // namespace glint
