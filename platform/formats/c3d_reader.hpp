// Reader of C3D files for marker trajectories only: 3D points in floating point, little-endian.
// Source: The C3D File Format, User Guide (Motion Lab Systems 2008), chapters "The header section",
// "The parameter section" and "Storing 3D point data".
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "platform/read_file.hpp"

namespace glint {

struct C3dTrial {
  double rate_hz = 0;
  std::vector<std::string> labels;
  // frames[f][p], not finite if the point is missing.
  std::vector<std::vector<Vector3>> frames;

  [[nodiscard]] int index_of(const std::string& label) const {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == label) return static_cast<int>(i);
    }
    return -1;
  }
};

class C3dFile {
 public:
  explicit C3dFile(const std::string& path)
      : bytes_(read_file(path, k_data_bytes_max, "a C3D file")) {}

  // Returns no frames for other kinds of files.
  [[nodiscard]] C3dTrial read() const {
    C3dTrial trial;
    if (bytes_.size() < 1024 || byte(1) != 0x50) return trial;
    const std::size_t points = word(2);
    const std::size_t analog = word(4);
    if (points == 0 || word(8) < word(6)) return trial;
    const std::size_t frames = word(8) - word(6) + 1u;
    if (number(12) >= 0) return trial;  // a positive scale: integers
    const std::size_t data = (word(16) - 1u) * k_block;
    trial.rate_hz = number(20);
    trial.labels = labels(points);
    const std::size_t stride = (points * 4 + analog) * 4;
    for (std::size_t f = 0; f < frames && data + (f + 1) * stride <= bytes_.size(); ++f) {
      std::vector<Vector3> frame;
      for (std::size_t p = 0; p < points; ++p) {
        const std::size_t at = data + f * stride + p * 16;
        const bool missing = !(number(at + 12) >= 0);
        frame.emplace_back(missing ? NAN : number(at), number(at + 4), number(at + 8));
      }
      trial.frames.push_back(frame);
    }
    return trial;
  }

 private:
  static constexpr std::size_t k_block = 512;

  [[nodiscard]] std::uint8_t byte(std::size_t at) const {
    return at < bytes_.size() ? static_cast<std::uint8_t>(bytes_[at]) : std::uint8_t{0};
  }
  [[nodiscard]] std::uint16_t word(std::size_t at) const {
    return static_cast<std::uint16_t>(byte(at) | (byte(at + 1) << 8));
  }
  [[nodiscard]] double number(std::size_t at) const {
    const std::uint32_t bits = word(at) | (static_cast<std::uint32_t>(word(at + 2)) << 16);
    return static_cast<double>(std::bit_cast<float>(bits));
  }

  // Reads POINT:LABELS: the names of all points in one block of texts of equal length.
  [[nodiscard]] std::vector<std::string> labels(std::size_t points) const {
    std::vector<std::string> result;
    std::map<int, std::string> groups;
    std::size_t at = (byte(0) - 1u) * k_block + 4;
    while (at + 4 < bytes_.size()) {
      const int length = std::abs(static_cast<std::int8_t>(byte(at)));
      const int group = static_cast<std::int8_t>(byte(at + 1));
      if (length == 0) break;
      const auto size = static_cast<std::size_t>(length);
      if (at + 4 + size > bytes_.size()) break;
      const std::string name(bytes_.begin() + static_cast<std::ptrdiff_t>(at + 2),
                             bytes_.begin() + static_cast<std::ptrdiff_t>(at + 2 + size));
      const std::size_t body = at + 2 + size;
      if (group < 0) groups[-group] = name;
      if (name == "LABELS" && groups[group] == "POINT") {
        const std::size_t dimensions = byte(body + 3);
        const std::size_t width = byte(body + 4);
        std::size_t text = body + 4 + dimensions;
        for (std::size_t p = 0; p < points; ++p, text += width) {
          std::string label;
          for (std::size_t c = 0; c < width && byte(text + c) > ' '; ++c) {
            label += static_cast<char>(byte(text + c));
          }
          result.push_back(label);
        }
        return result;
      }
      const std::size_t next = word(body);
      if (next == 0) break;
      at = body + next;
    }
    return result;
  }

  std::string bytes_;
};

}  // namespace glint
