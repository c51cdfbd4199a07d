// Files that a command leaves behind, written whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint {

// Throws InputError where the file cannot be written; its folder is made.
void write_text(const std::string& path, const std::string& text);

// --json FILE: the figures of the table. An empty path writes nothing.
void write_json(const std::string& path, const nlohmann::ordered_json& figures);

// Makes the folder a file is to be in. Throws InputError where that cannot be.
void make_folder_of(const std::string& path);
void make_folder(const std::string& path);

}  // namespace glint
