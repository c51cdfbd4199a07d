#include <algorithm>
#include <array>

#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/point_fields.hpp"

namespace glint {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t k_fields_max = 256;

struct PlyType {
  std::string_view name, other_name;
  char kind;
  std::size_t size;
};
constexpr std::array<PlyType, 8> k_types = {{{"char", "int8", 'I', 1},
                                             {"uchar", "uint8", 'U', 1},
                                             {"short", "int16", 'I', 2},
                                             {"ushort", "uint16", 'U', 2},
                                             {"int", "int32", 'I', 4},
                                             {"uint", "uint32", 'U', 4},
                                             {"float", "float32", 'F', 4},
                                             {"double", "float64", 'F', 8}}};

PointField property_of(const FileText& file, const Words& words) {
  if (words.size() == 5 && words[1] == "list") file.refuse("a list in a vertex", "plain numbers");
  if (words.size() != 3) file.refuse("a property of other words", "\"property TYPE NAME\"");
  const auto* const type = std::find_if(k_types.begin(), k_types.end(), [&](const PlyType& t) {
    return words[1] == t.name || words[1] == t.other_name;
  });
  if (type == k_types.end()) {
    file.refuse("type \"" + std::string(words[1]).substr(0, 40) + '"', "char to double");
  }
  return {std::string(words[2]), type->kind, type->size, 1};
}

}  // namespace

HostCloud read_ply(const std::string& path) {
  FileText file(path, "a PLY cloud");
  Words words;
  if (!file.next_line(words) || words.size() != 1 || words[0] != "ply") {
    file.refuse("no \"ply\"", "a PLY cloud");
  }
  std::string format;
  std::vector<PointField> fields;
  std::size_t points = 0;
  int elements = 0;
  while (true) {
    if (!file.next_line(words)) file.refuse("the file ends", "end_header");
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      format = words[1];
      if (format != "ascii" && format != "binary_little_endian") {
        file.refuse("format " + format.substr(0, 40), "ascii or binary_little_endian");
      }
    } else if (words[0] == "element" && words.size() == 3) {
      if (++elements == 1 && words[1] != "vertex") {
        file.refuse("another element before the vertices", "element vertex first");
      }
      if (elements == 1) points = file.count(words[2], k_cloud_points_max);
    } else if (words[0] == "property" && elements > 0) {
      if (elements > 1) continue;
      fields.push_back(property_of(file, words));
      if (fields.size() > k_fields_max) file.refuse("too many properties", "at most 256");
    } else {
      file.refuse('"' + std::string(words[0]).substr(0, 40) + '"',
                  "format, element, property, comment or end_header");
    }
  }
  if (format.empty()) file.refuse("no format", "\"format ascii 1.0\" or binary_little_endian");
  if (elements == 0) file.refuse("no vertices", "\"element vertex COUNT\"");
  return format == "ascii" ? read_ascii_points(file, fields, points)
                           : read_binary_points(file, fields, points);
}

}  // namespace glint
