#include "platform/sensors/npy.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "platform/input_error.hpp"

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little);

// NumPy's format: "\x93NUMPY", version major and minor, length of the header (u16, from version 2
// on u32), then a Python dictionary with descr, fortran_order and shape.
constexpr char k_magic[] = "\x93NUMPY";
constexpr std::size_t k_magic_length = 6;

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

}  // namespace

NpyArray read_npy_float32(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened; expected a .npy file");
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (bytes.size() < 12 || std::memcmp(bytes.data(), k_magic, k_magic_length) != 0) {
    throw InputError(path + ":byte 0: no NumPy magic; expected a .npy file");
  }
  const std::size_t length_bytes = bytes[6] == 1 ? 2 : 4;
  std::uint32_t header_length = 0;
  std::memcpy(&header_length, bytes.data() + 8, length_bytes);
  const std::size_t data_at = 8 + length_bytes + header_length;
  if (data_at > bytes.size()) {
    throw InputError(path + ":byte 8: header of " + std::to_string(header_length) +
                     " bytes is longer than the file; expected a whole .npy file");
  }
  const std::string header = bytes.substr(8 + length_bytes, header_length);
  const std::string kind = value_after(header, "descr");
  if (kind.find("'<f4'") == std::string::npos || kind.find("'<f4'") > kind.find_first_not_of(' ')) {
    throw InputError(path + ":byte 10: descr is not '<f4'; expected little-endian float32");
  }
  const std::string order = value_after(header, "fortran_order");
  if (order.compare(0, order.find(','), " False") != 0) {
    throw InputError(path + ":byte 10: fortran_order is not False; expected C order");
  }
  NpyArray out;
  out.shape = shape_of(value_after(header, "shape"));
  std::size_t count = out.shape.empty() ? 0 : 1;
  for (const std::size_t n : out.shape) count *= n;
  const std::size_t found = bytes.size() - data_at;
  if (count == 0 || found / sizeof(float) != count || found % sizeof(float) != 0) {
    throw InputError(path + ":byte " + std::to_string(data_at) + ": " + std::to_string(found) +
                     " bytes of data; expected " + std::to_string(count * sizeof(float)) +
                     " by the shape");
  }
  out.values.resize(count);
  std::memcpy(out.values.data(), bytes.data() + data_at, found);
  return out;
}

std::string npy_float32_bytes(const NpyArray& array) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (const std::size_t n : array.shape) header += std::to_string(n) + ", ";
  header += ")}";
  // NumPy ends the header with a line feed so that the data begin at a multiple of 64.
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
