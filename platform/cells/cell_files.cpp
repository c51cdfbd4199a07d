#include "platform/cells/cell_files.hpp"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"

namespace glint {

std::string CellFileReader::resolved(const std::string& path, const std::string& key) const {
  if (recorded_files != nullptr || path.empty()) return path;
  std::string text = path;
  for (std::size_t from = text.find("${"); from != std::string::npos; from = text.find("${")) {
    const std::size_t to = text.find('}', from);
    const std::string name = to == std::string::npos ? "" : text.substr(from + 2, to - from - 2);
    const char* value = name.empty() ? nullptr : std::getenv(name.c_str());
    if (value == nullptr) {
      throw InputError(cell.file + ": " + key + " is \"" + path + "\": the environment has no " +
                       (name.empty() ? "closing }" : name) + "; expected it to be set");
    }
    text.replace(from, to - from + 1, value);
  }
  const std::filesystem::path file(text);
  if (file.is_absolute()) return text;
  return (std::filesystem::path(cell.file).parent_path() / file).lexically_normal().string();
}

const NamedFile& CellFileReader::named_file(const std::string& path, const std::string& key) const {
  NamedFile named{key, resolved(path, key), ""};
  if (recorded_files == nullptr) {
    named.text = read_text(named.path);
  } else if (const auto text = recorded_files->named.find(key);
             text != recorded_files->named.end()) {
    named.text = text->second;
  } else {
    throw InputError(cell.file + ": no attachment " + key + ".toml; expected the file \"" + path +
                     "\" that the cell names");
  }
  return cell.named_files.emplace_back(std::move(named));
}

}  // namespace glint
