// MCAP files for tests: a small one of many chunks, its bytes, and the refusal of a damaged one.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "platform/input_error.hpp"
#include "platform/sinks/record/bytes.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::test {

inline constexpr int k_messages = 60;

inline Bytes payload_of(int i) { return Bytes(static_cast<std::size_t>(i % 17), std::uint8_t(i)); }

// Small chunks, so that the file has many.
inline void write_file(const std::string& path) {
  McapSettings settings;
  settings.chunk_bytes = 256;
  McapWriter writer(path, "ros2", "glint", settings);
  const auto one = writer.add_channel("/one", "pkg/msg/A", "int32 a\n", {{"key", "value"}});
  const auto two = writer.add_channel("/two", "pkg/msg/B", "int32 b\n", {});
  writer.add_metadata("opening", {{"a", "1"}});
  writer.attach("file", "text/plain", 7, Bytes{1, 2, 3});
  for (int i = 0; i < k_messages; ++i)
    writer.write({i % 3 == 0 ? one : two, std::uint32_t(i), std::uint64_t(1000 - i), 5},
                 payload_of(i));
  EXPECT_TRUE(writer.close("closing", {{"b", "2"}}));
}

inline Bytes read_whole(const std::string& path) {
  const std::string text = text_of(path);
  return {text.begin(), text.end()};
}

inline void write_whole(const std::string& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

inline int count_messages(McapReader& reader) {
  int count = 0;
  while (reader.next()) ++count;
  return count;
}

inline std::string refusal(const std::string& path, McapEnding ending = McapEnding::required) {
  try {
    McapReader reader(path, ending);
    count_messages(reader);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace glint::test
