#include "platform/formats/npy.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little);

// NumPy's format: "\x93NUMPY", version major and minor, header length (u16; u32 from version 2),
// then a Python dictionary with descr, fortran_order and shape.
constexpr char k_magic[] = "\x93NUMPY";
constexpr std::size_t k_magic_length = 6;
constexpr std::size_t k_npy_bytes_max = 256 << 20;

std::string value_after(const std::string& header, const std::string& key) {
  const std::size_t at = header.find("'" + key + "'");
  const std::size_t colon = at == std::string::npos ? at : header.find(':', at);
  return colon == std::string::npos ? "" : header.substr(colon + 1);
}

std::vector<std::size_t> shape_of(const std::string& text) {
  std::vector<std::size_t> shape;
  const std::size_t open = text.find('('), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos) return shape;
  std::size_t number = 0;
  bool digits = false;
  for (std::size_t i = open + 1; i <= close; ++i) {
    if (text[i] >= '0' && text[i] <= '9') {
      if (number > 1'000'000'000) return {};
      number = number * 10 + static_cast<std::size_t>(text[i] - '0');
      digits = true;
    } else if (digits && (text[i] == ',' || text[i] == ')')) {
      shape.push_back(number);
      number = 0;
      digits = false;
    }
  }
  return shape;
}

struct NpyFile {
  std::string kind, bytes;  // descr; the complete file
  std::size_t data_at = 0;
  std::vector<std::size_t> shape;
};

NpyFile read_npy(const std::string& path) {
  NpyFile out;
  out.bytes = read_file(path, k_npy_bytes_max, "a .npy file");
  const std::string& bytes = out.bytes;
  if (bytes.size() < 12 || std::memcmp(bytes.data(), k_magic, k_magic_length) != 0) {
    throw InputError(path + ":byte 0: no NumPy magic; expected a .npy file");
  }
  const std::size_t length_bytes = bytes[6] == 1 ? 2 : 4;
  std::uint32_t header_length = 0;
  std::memcpy(&header_length, bytes.data() + 8, length_bytes);
  out.data_at = 8 + length_bytes + header_length;
  if (out.data_at > bytes.size()) {
    throw InputError(path + ":byte 8: header of " + std::to_string(header_length) +
                     " bytes is longer than the file; expected a complete .npy file");
  }
  const std::string header = bytes.substr(8 + length_bytes, header_length);
  const std::string descr = value_after(header, "descr");
  const std::size_t open = descr.find('\'');
  if (open != std::string::npos && open == descr.find_first_not_of(' ')) {
    out.kind = descr.substr(open + 1, descr.find('\'', open + 1) - open - 1);
  }
  const std::string order = value_after(header, "fortran_order");
  if (order.compare(0, order.find(','), " False") != 0) {
    throw InputError(path + ":byte 10: fortran_order is not False; expected C order");
  }
  out.shape = shape_of(value_after(header, "shape"));
  return out;
}

// Number of values of this size in the shape. Throws InputError unless the file has as many.
std::size_t count_of(const NpyFile& file, std::size_t value_bytes, const std::string& path) {
  const std::size_t found = file.bytes.size() - file.data_at;
  std::size_t count = file.shape.empty() ? 0 : 1;
  for (const std::size_t n : file.shape) {
    count = n == 0 || count > found / n ? found + 1 : count * n;  // above any possible count
  }
  if (count == 0 || found / value_bytes != count || found % value_bytes != 0) {
    throw InputError(path + ":byte " + std::to_string(file.data_at) + ": " + std::to_string(found) +
                     " bytes of data; expected " + std::to_string(value_bytes) +
                     " for each value of the shape");
  }
  return count;
}

template <class Value>
std::vector<double> values_of(const NpyFile& file, const std::string& path) {
  std::vector<double> values(count_of(file, sizeof(Value), path));
  for (std::size_t i = 0; i < values.size(); ++i) {
    Value value;
    std::memcpy(&value, file.bytes.data() + file.data_at + i * sizeof value, sizeof value);
    values[i] = static_cast<double>(value);
  }
  return values;
}

}  // namespace

NpyArray read_npy_float32(const std::string& path) {
  const NpyFile file = read_npy(path);
  if (file.kind != "<f4") {
    throw InputError(path + ":byte 10: descr is not '<f4'; expected little-endian float32");
  }
  NpyArray out{file.shape, std::vector<float>(count_of(file, sizeof(float), path))};
  std::memcpy(out.values.data(), file.bytes.data() + file.data_at,
              out.values.size() * sizeof(float));
  return out;
}

NpyNumbers read_npy_numbers(const std::string& path) {
  const NpyFile file = read_npy(path);
  if (file.kind == "<f4") return {file.shape, values_of<float>(file, path), false};
  if (file.kind == "<f8") return {file.shape, values_of<double>(file, path), false};
  if (file.kind == "<u2") return {file.shape, values_of<std::uint16_t>(file, path), true};
  if (file.kind == "|u1") return {file.shape, values_of<std::uint8_t>(file, path), true};
  throw InputError(path + ":byte 10: descr is '" + file.kind + "'; expected <f4, <f8, <u2 or |u1");
}

std::string npy_float32_bytes(const NpyArray& array) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (const std::size_t n : array.shape) header += std::to_string(n) + ", ";
  header += ")}";
  // The header ends with a line feed so that the data begin at a multiple of 64.
  header.append(64 - (10 + header.size() + 1) % 64, ' ');
  header += '\n';
  std::string bytes(k_magic, k_magic_length);
  bytes += {'\x01', '\x00', static_cast<char>(header.size() & 0xFF),
            static_cast<char>(header.size() >> 8)};
  bytes += header;
  const std::size_t at = bytes.size(), size = array.values.size() * sizeof(float);
  bytes.resize(at + size);
  if (size > 0) std::memcpy(bytes.data() + at, array.values.data(), size);
  return bytes;
}

}  // namespace glint
