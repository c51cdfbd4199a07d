// PCD's binary_compressed format (LZF): packed by the test, and by PCL if its clouds are available.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/lzf.hpp"
#include "temporary_folder.hpp"

namespace glint {
namespace {

// LZF compression with the longest match of at least three bytes up to 8192 bytes back.
std::string packed(const std::string& bytes) {
  std::string out, literals;
  const auto flush = [&] {
    for (std::size_t i = 0; i < literals.size(); i += 32) {
      const std::string run = literals.substr(i, 32);
      out += static_cast<char>(run.size() - 1) + run;
    }
    literals.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t best = 0, back = 0;
    for (std::size_t b = 1; b <= std::min<std::size_t>(at, 8192); ++b) {
      std::size_t n = 0;
      while (n < 264 && at + n < bytes.size() && bytes[at + n] == bytes[at + n - b]) ++n;
      if (n > best) best = n, back = b;
    }
    if (best < 3) {
      literals += bytes[at++];
      continue;
    }
    flush();
    const std::size_t length = best - 2, far = back - 1;
    out += static_cast<char>((std::min<std::size_t>(length, 7) << 5) + (far >> 8));
    if (length >= 7) out += static_cast<char>(length - 7);
    out += static_cast<char>(far & 255);
    at += best;
  }
  flush();
  return out;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Header with a field of two bytes between z and y, and a field of three numbers.
std::string head(std::size_t points) {
  return "FIELDS x z label y rgb\nSIZE 4 8 2 4 1\nTYPE F F U F U\nCOUNT 1 1 1 1 3\nPOINTS " +
         std::to_string(points) + "\nDATA binary_compressed\n";
}
std::string body(std::size_t packed_bytes, std::size_t bytes, const std::string& lzf) {
  std::string out;
  append(out, static_cast<std::uint32_t>(packed_bytes));
  append(out, static_cast<std::uint32_t>(bytes));
  return out + lzf;
}

TEST(CompressedCloud, ComesBackAsItWasPacked) {
  constexpr std::size_t count = 3000;
  HostCloud cloud;
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto f = static_cast<float>(i);
    cloud.points.push_back({std::sin(f), std::floor(f / 9), i == 7 ? NAN : -0.5f});
  }
  for (const auto& p : cloud.points) append(bytes, p[0]);
  for (const auto& p : cloud.points) append(bytes, static_cast<double>(p[2]));
  for (std::size_t i = 0; i < count; ++i) append(bytes, static_cast<std::uint16_t>(i));
  for (const auto& p : cloud.points) append(bytes, p[1]);
  bytes.append(3 * count, 'c');
  const std::string lzf = packed(bytes);
  ASSERT_LT(lzf.size(), bytes.size() / 2);
  const TemporaryFolder folder;
  const HostCloud back = read_cloud(
      folder.write("a.pcd", head(count) + body(lzf.size(), bytes.size(), lzf) + "behind it"));
  ASSERT_EQ(back.points.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(back.points[i][0], cloud.points[i][0]) << i;
    EXPECT_EQ(back.points[i][1], cloud.points[i][1]) << i;
    if (i == 7)
      EXPECT_TRUE(std::isnan(back.points[i][2]));
    else
      EXPECT_EQ(back.points[i][2], -0.5f) << i;
  }
  EXPECT_TRUE(read_cloud(folder.write("none.pcd", head(0) + body(0, 0, ""))).points.empty());
}

TEST(CompressedCloud, IsRefusedByNameWhereItsLengthsLie) {
  const TemporaryFolder folder;
  const auto expect_error = [&](const std::string& bytes, const std::string& what) {
    const std::string message =
        error_message_of([&] { (void)read_cloud(folder.write("a.pcd", bytes)); });
    EXPECT_NE(message.find("a.pcd:line 6: "), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  const std::string lzf = packed(std::string(2 * 21, 'a'));
  expect_error(head(2), "0 bytes behind the header; expected two sizes");
  expect_error(head(2) + "1234567", "7 bytes behind the header");
  expect_error(head(2) + body(lzf.size() + 1, 42, lzf), "compressed bytes; expected");
  expect_error(head(2) + body(0xffffffff, 42, lzf), "expected 4294967295");
  expect_error(head(2) + body(lzf.size(), 43, lzf), "decompress to 43; expected 2 points of 21");
  expect_error(head(3) + body(lzf.size(), 63, lzf), "invalid compressed bytes");
  expect_error(head(2) + body(lzf.size() - 1, 42, lzf), "invalid compressed bytes");
  // 16 million points and their full size, in a few bytes: the reader reserves no memory.
  expect_error(head(16'000'000) + body(lzf.size(), 336'000'000, lzf), "decompress to 336000000");
}

// Every truncation and every changed byte either unpacks to the stated size or is refused. No case
// writes (or, by the sanitizers, reads) out of bounds.
TEST(CompressedCloud, UnpacksOrRefusesWhateverItIsGiven) {
  std::string bytes;
  for (int i = 0; i < 400; ++i) bytes += static_cast<char>(i % 7 + i / 100);
  const std::string lzf = packed(bytes);
  std::string to(bytes.size(), '\0');
  ASSERT_TRUE(unpack_lzf(lzf, to));
  EXPECT_EQ(to, bytes);
  for (std::size_t n = 0; n < lzf.size(); ++n) EXPECT_FALSE(unpack_lzf(lzf.substr(0, n), to)) << n;
  std::string guarded(to.size() + 350, '#');
  int refused = 0;
  for (std::size_t n = 0; n < lzf.size(); ++n) {
    for (int value = 0; value < 256; ++value) {
      std::string changed = lzf;
      changed[n] = static_cast<char>(value);
      refused += unpack_lzf(changed, std::span(guarded).subspan(50, to.size())) ? 0 : 1;
    }
  }
  EXPECT_EQ(guarded.substr(0, 50) + guarded.substr(50 + to.size()), std::string(350, '#'));
  EXPECT_GT(refused, 256);
  const std::span<char> three = std::span(guarded).subspan(50, 3);
  EXPECT_TRUE(
      unpack_lzf("\x02"
                 "abc",
                 three));
  EXPECT_FALSE(unpack_lzf(std::string("\x20\x00", 2), three));  // refers to a byte before the first
  EXPECT_FALSE(unpack_lzf("\xe0", to));
  EXPECT_FALSE(unpack_lzf(std::string("\xe0\x00", 2), to));
}

TEST(CompressedCloud, OfPclsOwnIsRead) {
  const char* const data = std::getenv("GLINT_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data != nullptr ? data : "") / "pointclouds";
  int read = 0;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::string start(600, '\0');
      std::ifstream(entry.path(), std::ios::binary).read(start.data(), 600);
      if (start.find("DATA binary_compressed") == std::string::npos) continue;
      std::size_t finite = 0, in_view = 0;
      const HostCloud cloud = read_cloud(entry.path().string());
      for (const auto& [x, y, z] : cloud.points) {
        if (!std::isfinite(x + y + z)) continue;
        ++finite;  // inside the field of a depth camera of 60 by 50 degrees, on either side
        const float far = std::abs(z);
        in_view += far > 0.3f && far < 15 && std::abs(x) < 0.6f * far && std::abs(y) < 0.5f * far;
      }
      EXPECT_GT(finite, 1000u) << entry.path();
      EXPECT_GT(in_view, finite * 99 / 100) << entry.path();
      ++read;
    }
  }
  if (read == 0) GTEST_SKIP() << "no compressed clouds in " << folder;
}

}  // namespace
}  // namespace glint
