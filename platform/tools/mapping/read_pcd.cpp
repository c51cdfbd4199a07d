#include <array>

#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/point_fields.hpp"

namespace glint {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t k_words_max = 256;
constexpr std::size_t k_field_count_max = 1024;

void expect_one_each(const FileText& file, const Words& words, std::size_t fields) {
  if (words.size() != fields + 1) {
    file.refuse(std::to_string(words.size() - 1) + " words behind " + std::string(words[0]),
                std::to_string(fields) + ", one per field");
  }
}

void check_sizes(const FileText& file, const std::vector<PointField>& fields) {
  for (const PointField& field : fields) {
    const bool fits = field.kind == 'F' ? field.size == 4 || field.size == 8
                                        : field.size == 1 || field.size == 2 || field.size == 4 ||
                                              field.size == 8;
    if (!fits) {
      file.refuse("field " + field.name + " of " + std::to_string(field.size) + " bytes, type " +
                      field.kind,
                  "F of 4 or 8, I or U of 1, 2, 4 or 8");
    }
  }
}

// Parses one header line other than DATA.
void take_line(const FileText& file, const Words& words, std::vector<PointField>& fields,
               std::size_t& points) {
  const std::string_view name = words[0];
  if (name == "FIELDS") {
    if (words.size() > k_words_max) file.refuse("too many fields", "at most 255");
    for (std::size_t i = 1; i < words.size(); ++i) fields.push_back({std::string(words[i])});
  } else if (name == "SIZE" || name == "TYPE" || name == "COUNT") {
    expect_one_each(file, words, fields.size());
    for (std::size_t i = 1; i < words.size(); ++i) {
      PointField& field = fields[i - 1];
      if (name == "SIZE") field.size = file.count(words[i], 8);
      if (name == "COUNT") field.count = file.count(words[i], k_field_count_max);
      if (name == "TYPE") field.kind = words[i][0];
      if (field.kind != 'F' && field.kind != 'I' && field.kind != 'U') {
        file.refuse("type \"" + std::string(words[i]).substr(0, 40) + '"', "F, I or U");
      }
    }
  } else if (name == "POINTS" && words.size() == 2) {
    points = file.count(words[1], k_cloud_points_max);
  } else if (name != "VERSION" && name != "WIDTH" && name != "HEIGHT" && name != "VIEWPOINT") {
    file.refuse('"' + std::string(name).substr(0, 40) + '"',
                "VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA");
  }
}

}  // namespace

HostCloud read_pcd(const std::string& path) {
  FileText file(path, "a PCD cloud");
  Words words;
  std::vector<PointField> fields;
  std::size_t points = k_cloud_points_max + 1;
  while (true) {
    if (!file.next_line(words)) file.refuse("the file ends", "DATA");
    if (words.empty() || words[0][0] == '#') continue;
    if (words[0] == "DATA") break;
    take_line(file, words, fields, points);
  }
  check_sizes(file, fields);
  if (points > k_cloud_points_max) file.refuse("no POINTS before DATA", "their count");
  const std::string data(words.size() == 2 ? words[1] : "");
  if (data == "ascii") return read_ascii_points(file, fields, points);
  if (data == "binary") return read_binary_points(file, fields, points);
  if (data == "binary_compressed") return read_compressed_points(file, fields, points);
  file.refuse("DATA " + data.substr(0, 40), "ascii, binary or binary_compressed");
}

}  // namespace glint
