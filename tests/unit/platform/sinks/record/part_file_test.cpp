// Files that appear atomically when complete, among them a recording, and the lock of a folder.
#include "platform/part_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "platform/folder_lock.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint {
namespace {

TEST(PartFile, HasANameOfItsOwn) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  const PartFile first = open_part_file(path), second = open_part_file(path);
  EXPECT_EQ(first.path, path + ".part");
  EXPECT_EQ(second.path, path + ".1.part");
  ::close(first.descriptor);
  ::close(second.descriptor);
}

TEST(WriteWholeFile, ReplacesAFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  EXPECT_EQ(write_file_atomically(path, "one"), "");
  EXPECT_EQ(write_file_atomically(path, "two"), "");
  EXPECT_EQ(text_of(path), "two");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_NE(write_file_atomically(folder.file("nowhere/a"), "three"), "");
}

TEST(WriteWholeFile, WritesIntoAPipeInsteadOfReplacingIt) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_EQ(write_file_atomically(path, "figures"), "");
  std::array<char, 16> text{};
  EXPECT_EQ(::read(reader, text.data(), text.size()), 7);
  EXPECT_STREQ(text.data(), "figures");
  EXPECT_TRUE(std::filesystem::is_fifo(path));
  ::close(reader);
}

TEST(WriteWholeFile, ReplacesASymbolicLinkAndNotItsTarget) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("target")) << "kept";
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  EXPECT_EQ(write_file_atomically(folder.file("link"), "new"), "");
  EXPECT_EQ(text_of(folder.file("target")), "kept");
  EXPECT_EQ(text_of(folder.file("link")), "new");
}

void record_one_choice(const std::string& path) {
  RecordingWriter writer(path, sample_info(RecordingLevel::roi));
  writer.write_choice(sample_choice(1));
  EXPECT_TRUE(writer.close().complete()) << writer.outcome().reason;
}

TEST(Recording, KeepsTheUnfinishedFileOfACrashedRun) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  std::ofstream(path + ".part") << "of a crashed run";
  record_one_choice(path);
  RecordingReader reader(path);
  EXPECT_EQ(text_of(path + ".part"), "of a crashed run");
}

TEST(Recording, FollowsNoSymbolicLink) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap"), other = folder.file("other");
  std::ofstream(other) << "of somebody else";
  std::filesystem::create_symlink(other, path + ".part");
  std::filesystem::create_symlink(other, path);
  record_one_choice(path);
  EXPECT_EQ(std::filesystem::file_size(other), 16U);
  EXPECT_FALSE(std::filesystem::is_symlink(path));
}

TEST(Recording, TwoOfOneNameAreEachWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecordingWriter first(path, sample_info(RecordingLevel::roi));
  RecordingWriter second(path, sample_info(RecordingLevel::roi));
  for (RecordingWriter* const writer : {&first, &second}) {
    writer->write_choice(sample_choice(1));
    EXPECT_TRUE(writer->close().complete()) << writer->outcome().reason;
    RecordingReader reader(path);
    EXPECT_TRUE(reader.next());
  }
}

TEST(Recording, NeverReplacesADevice) {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(RecordingWriter(pipe, sample_info(RecordingLevel::roi)), InputError);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(FolderLock, RefusesASecondRunAndNamesTheFirstUntilItHasGone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("");
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(path);
    (void)!::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char one = 0;
  ASSERT_EQ(::read(ready[0], &one, 1), 1);
  try {
    const FolderLock lock(path);
    ADD_FAILURE() << "two runs in one folder";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("(process " + std::to_string(child) + ")"),
              std::string::npos)
        << error.what();
  }
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  { const FolderLock after_a_crash(path); }
  EXPECT_TRUE(std::filesystem::is_empty(path));
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(FolderLock, FollowsNoSymbolicLink) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("target")) << "kept";
  std::filesystem::create_symlink(folder.file("target"), folder.file(".glint.lock"));
  EXPECT_THROW(FolderLock lock(folder.file("")), InputError);
  EXPECT_EQ(text_of(folder.file("target")), "kept");
}

}  // namespace
}  // namespace glint
