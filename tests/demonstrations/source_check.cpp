// Is there a source of the new kind: found by its beginning, opened by a cell, named in messages?
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "platform/sources/open_source.hpp"

namespace {

using namespace glint;

constexpr const char* k_file = "frames.raw";

void write_frames(int frames, const CameraModel& model) {
  std::ofstream file(k_file, std::ios::binary);
  file << "RAWFRAME";
  const std::size_t pixels = 2 * static_cast<std::size_t>(model.width * model.height);
  for (int n = 1; n <= frames; ++n) {
    const std::int64_t time_ns = 22'222'222 * n;
    const std::vector<std::uint16_t> planes(pixels, static_cast<std::uint16_t>(100 * n));
    file.write(reinterpret_cast<const char*>(&time_ns), 8);
    file.write(reinterpret_cast<const char*>(planes.data()),
               static_cast<std::streamsize>(2 * pixels));
  }
}

std::string message_of(Cell cell) {
  try {
    (void)open_source(cell);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no message";
}

}  // namespace

int main() {
  Cell cell = default_cell();
  cell.realtime = false;
  write_frames(3, cell.camera.model);
  std::printf("kind %s\n", kind_at(k_file).c_str());
  cell.source.kind = kind_at(k_file);
  cell.source.path = k_file;
  cell.source.position = "cell.toml:4: source";
  const auto source = open_source(cell);
  source->start({});
  int sum = 0;
  for (ArrivedFrame arrived; source->wait(arrived);) {
    sum += arrived.frame.reflectivity_16.pixels[0] + arrived.frame.depth.pixels[9];
    source->release_pixels(arrived);
  }
  std::printf("%s, sum %d\n", source->report().text.c_str(), sum);
  cell.source.kind = "raw";
  std::printf("%s\n", message_of(cell).c_str());
  std::ofstream(k_file, std::ios::app) << "x";
  cell.source.kind = "raw_frames";
  std::printf("%s\n", message_of(cell).c_str());
}
