#include "platform/tools/mapping/point_fields.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "platform/tools/mapping/lzf.hpp"

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little);

// Position of a value: its word in a line, its byte in a record.
struct ValueOffset {
  std::size_t word = 0, byte = 0;
  const PointField* field = nullptr;
};

struct Layout {
  std::array<ValueOffset, 6> offsets;  // x, y, z, then the normal's
  bool has_normals = false;
  std::size_t words = 0, bytes = 0;
};

Layout layout_of(const FileText& file, const std::vector<PointField>& fields) {
  constexpr std::array<std::array<const char*, 2>, 6> names = {{{"x", "x"},
                                                                {"y", "y"},
                                                                {"z", "z"},
                                                                {"normal_x", "nx"},
                                                                {"normal_y", "ny"},
                                                                {"normal_z", "nz"}}};
  Layout out;
  for (const PointField& field : fields) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (field.name != names[i][0] && field.name != names[i][1]) continue;
      if (field.count != 1) file.refuse("field " + field.name + " holds several", "one number");
      out.offsets[i] = {out.words, out.bytes, &field};
    }
    out.words += field.count;
    out.bytes += field.count * field.size;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (out.offsets[i].field == nullptr) {
      file.refuse("no field " + std::string(names[i][0]), "x, y and z");
    }
  }
  out.has_normals = out.offsets[3].field != nullptr && out.offsets[4].field != nullptr &&
                    out.offsets[5].field != nullptr;
  return out;
}

template <class T>
float as_float(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<float>(value);
}

float value_of(const PointField& field, const char* from) {
  switch (field.kind) {
    case 'F':
      return field.size == 8 ? as_float<double>(from) : as_float<float>(from);
    case 'I':
      return field.size == 1   ? as_float<std::int8_t>(from)
             : field.size == 2 ? as_float<std::int16_t>(from)
             : field.size == 4 ? as_float<std::int32_t>(from)
                               : as_float<std::int64_t>(from);
    default:
      return field.size == 1   ? as_float<std::uint8_t>(from)
             : field.size == 2 ? as_float<std::uint16_t>(from)
             : field.size == 4 ? as_float<std::uint32_t>(from)
                               : as_float<std::uint64_t>(from);
  }
}

template <class Value>
void add_point(const Layout& layout, Value value, HostCloud& to) {
  const auto& p = layout.offsets;
  to.points.push_back({value(p[0]), value(p[1]), value(p[2])});
  if (layout.has_normals) to.normals.push_back({value(p[3]), value(p[4]), value(p[5])});
}

}  // namespace

HostCloud read_ascii_points(FileText& file, const std::vector<PointField>& fields,
                            std::size_t points) {
  const Layout layout = layout_of(file, fields);
  if (points > (file.rest().size() + 1) / (2 * layout.words)) {
    file.refuse(std::to_string(file.rest().size()) + " bytes behind the header",
                std::to_string(points) + " points of " + std::to_string(layout.words) + " words");
  }
  HostCloud out;
  std::vector<std::string_view> words;
  while (out.points.size() < points) {
    if (!file.next_line(words)) {
      file.refuse("the file ends after " + std::to_string(out.points.size()) + " points",
                  std::to_string(points));
    }
    if (words.empty()) continue;
    if (words.size() != layout.words) {
      file.refuse(std::to_string(words.size()) + " words", std::to_string(layout.words));
    }
    add_point(
        layout,
        [&](const ValueOffset& offset) {
          return static_cast<float>(file.number(words[offset.word]));
        },
        out);
  }
  return out;
}

HostCloud read_binary_points(const FileText& file, const std::vector<PointField>& fields,
                             std::size_t points) {
  const Layout layout = layout_of(file, fields);
  const std::string_view bytes = file.rest();
  if (bytes.size() / layout.bytes < points) {
    file.refuse(std::to_string(bytes.size()) + " bytes behind the header",
                std::to_string(points) + " points of " + std::to_string(layout.bytes));
  }
  HostCloud out;
  for (std::size_t i = 0; i < points; ++i) {
    const char* const record = bytes.data() + i * layout.bytes;
    add_point(
        layout,
        [&](const ValueOffset& offset) { return value_of(*offset.field, record + offset.byte); },
        out);
  }
  return out;
}

HostCloud read_compressed_points(const FileText& file, const std::vector<PointField>& fields,
                                 std::size_t points) {
  const Layout layout = layout_of(file, fields);
  std::array<std::uint32_t, 2> sizes{};  // packed, unpacked
  if (file.rest().size() < sizeof sizes) {
    file.refuse(std::to_string(file.rest().size()) + " bytes behind the header", "two sizes");
  }
  std::memcpy(sizes.data(), file.rest().data(), sizeof sizes);
  const std::string_view packed = file.rest().substr(sizeof sizes);
  if (sizes[0] > packed.size()) {
    file.refuse(std::to_string(packed.size()) + " compressed bytes", std::to_string(sizes[0]));
  }
  if (sizes[1] != points * layout.bytes || sizes[1] > k_lzf_growth_max * sizes[0]) {
    file.refuse(std::to_string(sizes[0]) + " bytes that decompress to " + std::to_string(sizes[1]),
                std::to_string(points) + " points of " + std::to_string(layout.bytes));
  }
  std::vector<char> bytes(sizes[1]);
  if (!unpack_lzf(packed.substr(0, sizes[0]), bytes)) {
    file.refuse("invalid compressed bytes", "LZF, as PCL writes it");
  }
  HostCloud out;
  for (std::size_t i = 0; i < points; ++i) {
    const auto value = [&](const ValueOffset& offset) {
      const char* const first = bytes.data() + offset.byte * points;
      return value_of(*offset.field, first + i * offset.field->size);
    };
    add_point(layout, value, out);
  }
  return out;
}

}  // namespace glint
