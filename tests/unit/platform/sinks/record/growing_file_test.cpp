// Append-only file and random-access input file: preallocated space, errors, ends.
#include "platform/sinks/record/growing_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/sinks/record/crc32.hpp"
#include "platform/sinks/record/input_file.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::growing_file_test {
namespace {

template <class Doing>
std::string refusal_of(Doing doing) {
  try {
    doing();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::vector<std::string> open_files() {
  std::vector<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
    files.push_back(file.path().filename());
  return files;
}

struct stat status_of(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
  return status;
}

TEST(GrowingFile, KeepsItsBytesTheirNumberAndTheirChecksum) {
  const TemporaryFolder folder;
  GrowingFile file(folder.file("a"));
  EXPECT_EQ(file.part_path(), folder.file("a.part"));
  EXPECT_EQ(file.size(), 0u);
  const Bytes one{1, 2, 3}, two{4, 5};
  EXPECT_TRUE(file.append({one, two}));
  EXPECT_TRUE(file.append({}));
  EXPECT_TRUE(file.append({two}));
  EXPECT_EQ(file.size(), 7u);
  EXPECT_EQ(file.crc(), crc32(0, Bytes{1, 2, 3, 4, 5, 4, 5}));
  EXPECT_EQ(file.error(), "");
  EXPECT_TRUE(file.finish());
  EXPECT_EQ(text_of(std::filesystem::path(folder.file("a"))), "\1\2\3\4\5\4\5");
}

// Longer than one piece of a write.
TEST(GrowingFile, WritesLongPartsInPieces) {
  const TemporaryFolder folder;
  GrowingFile file(folder.file("a"));
  Bytes part(300'000);
  for (std::size_t i = 0; i < part.size(); ++i)
    part[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  EXPECT_TRUE(file.append({part}));
  EXPECT_TRUE(file.finish());
  EXPECT_EQ(text_of(std::filesystem::path(folder.file("a"))),
            std::string(part.begin(), part.end()));
}

TEST(GrowingFile, TakesRoomBehindItsEndAndGivesBackWhatItDidNotUse) {
  const TemporaryFolder folder;
  GrowingFile file(folder.file("a"));
  constexpr std::uint64_t k_room = 1 << 20, k_used = 100'000;
  ASSERT_TRUE(file.append({Bytes(k_used, 1)}));
  EXPECT_TRUE(file.reserve(k_room));
  const auto reserved = status_of(file.part_path());
  EXPECT_EQ(reserved.st_size, static_cast<off_t>(k_used)) << "the file has not grown";
  const auto taken = static_cast<std::uint64_t>(reserved.st_blocks) * 512;
  if (taken < k_room) GTEST_SKIP() << "this file system takes no room ahead";
  EXPECT_GE(taken, k_used + k_room);
  EXPECT_TRUE(file.finish());
  EXPECT_LT(static_cast<std::uint64_t>(status_of(folder.file("a")).st_blocks) * 512, k_room);
}

TEST(GrowingFile, RefusesToReserveWhatNoFileCanHave) {
  const TemporaryFolder folder;
  GrowingFile file(folder.file("a"));
  ASSERT_TRUE(file.append({Bytes(5, 1)}));
  EXPECT_FALSE(file.reserve(std::uint64_t{1} << 62));
  EXPECT_EQ(file.error().find(file.part_path() + ": make room at byte 5: "), 0u) << file.error();
  EXPECT_TRUE(file.append({Bytes(5, 1)})) << "the bytes themselves may still find room";
  const std::string first = file.error();
  std::filesystem::remove(file.part_path());
  EXPECT_FALSE(file.finish());
  EXPECT_EQ(file.error(), first) << "the first failure is the cause of the others";
}

TEST(GrowingFile, NamesTheFolderThatIsNotThere) {
  EXPECT_EQ(refusal_of([] { GrowingFile file("/no/such/folder/a"); }),
            "/no/such/folder/a.part: open at byte 0: No such file or directory; expected a "
            "writable folder");
  EXPECT_EQ(refusal_of([] { GrowingFile file("/dev/null"); }),
            "/dev/null: a device; expected a regular file");
}

TEST(GrowingFile, SaysWhyItDidNotGetItsName) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  GrowingFile file(folder.file("in/a"));
  ASSERT_TRUE(file.append({Bytes(9, 1)}));
  std::filesystem::remove_all(folder.file("in"));
  EXPECT_FALSE(file.finish());
  EXPECT_EQ(file.error(),
            folder.file("in/a.part") + ": rename at byte 9: No such file or directory");
}

// With and without a final name, the file closes only its own descriptor.
TEST(GrowingFile, LeavesTheOpenFilesOfTheProcessAsTheyWere) {
  const TemporaryFolder folder;
  const auto before = open_files();
  {
    GrowingFile named(folder.file("a"));
    EXPECT_TRUE(named.append({Bytes(3)}));
    EXPECT_TRUE(named.finish());
    EXPECT_EQ(open_files(), before) << "closed with its name";
  }
  {
    GrowingFile left(folder.file("b"));
    EXPECT_NE(open_files(), before);
  }
  EXPECT_EQ(open_files(), before);
  EXPECT_FALSE(std::filesystem::exists(folder.file("b")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("b.part")));
}

TEST(InputFile, ReadsAnyPartOfAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a"), text = "0123456789";
  std::ofstream(path) << text;
  const auto before = open_files();
  {
    const InputFile file(path);
    EXPECT_EQ(file.path(), path);
    EXPECT_EQ(file.size(), 10u);
    Bytes bytes;
    for (std::size_t from = 0; from <= text.size(); ++from) {
      for (std::size_t count = 0; from + count <= text.size(); ++count) {
        file.read(from, count, bytes);
        EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text.substr(from, count));
      }
    }
  }
  EXPECT_EQ(open_files(), before);
}

TEST(InputFile, NamesTheByteAtWhichTheFileEnds) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  std::ofstream(path) << "0123456789";
  const InputFile file(path);
  std::filesystem::resize_file(path, 6);
  Bytes bytes;
  const std::string refusal = path + ":byte 6: the file ends; expected the size at opening";
  EXPECT_EQ(refusal_of([&] { file.read(4, 6, bytes); }), refusal) << "after two of six bytes";
  EXPECT_EQ(refusal_of([&] { file.read(6, 1, bytes); }), refusal);
  file.read(4, 2, bytes);
  EXPECT_EQ(bytes, (Bytes{'4', '5'}));
}

TEST(InputFile, RefusesWhatIsNoFileAndNamesIt) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal_of([&] { InputFile file(folder.file("none")); }),
            folder.file("none") + ": No such file or directory; expected a recording");
  const auto before = open_files();
  EXPECT_EQ(refusal_of([&] { InputFile file(folder.file("")); }),
            folder.file("") + ": not a regular file; expected a recording");
  EXPECT_EQ(open_files(), before);
}

// A regular file of the kernel in which no byte can be read at that offset.
TEST(InputFile, NamesTheByteThatCannotBeRead) {
  const InputFile file("/proc/self/mem");
  Bytes bytes;
  EXPECT_EQ(refusal_of([&] { file.read(0, 8, bytes); }),
            "/proc/self/mem:byte 0: Input/output error; expected a readable file");
  EXPECT_EQ(refusal_of([&] { file.refuse(12, "this", "that"); }),
            "/proc/self/mem:byte 12: this; expected that");
}

}  // namespace
}  // namespace glint::growing_file_test
