#include "platform/sinks/record/mcap_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "platform/sinks/record/crc32.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "tests/unit/platform/sinks/record/mcap_files.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

TEST(Crc32, GivesItsCheckValueHoweverTheBytesAreCut) {
  const auto digits = bytes_of("123456789");
  for (std::size_t cut = 0; cut <= digits.size(); ++cut)
    EXPECT_EQ(crc32(crc32(0, digits.first(cut)), digits.subspan(cut)), 0xCBF43926U);
}

TEST(Mcap, GivesBackEveryMessageInTheOrderOfWriting) {
  const TemporaryFolder folder;
  test::write_file(folder.file("a.mcap"));
  McapReader reader(folder.file("a.mcap"));
  EXPECT_EQ(reader.profile(), "ros2");
  for (int i = 0; i < test::k_messages; ++i) {
    const auto message = reader.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->channel->topic, i % 3 == 0 ? "/one" : "/two");
    EXPECT_EQ(message->schema->name, i % 3 == 0 ? "pkg/msg/A" : "pkg/msg/B");
    EXPECT_EQ(message->heading.sequence, std::uint32_t(i));
    EXPECT_EQ(message->heading.log_time, std::uint64_t(1000 - i));
    EXPECT_EQ(message->heading.publish_time, 5U);
    EXPECT_EQ(Bytes(message->payload.begin(), message->payload.end()), test::payload_of(i));
  }
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.metadata().at("opening").at("a"), "1");
  EXPECT_EQ(reader.metadata().at("closing").at("b"), "2");
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachment(reader.attachments()[0]), (Bytes{1, 2, 3}));
}

TEST(Mcap, WithoutAMessageIsStillAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  McapWriter writer(path, "ros2", "glint");
  ASSERT_TRUE(writer.close("closing", {}));
  McapReader reader(path);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.file().path(), path);
  EXPECT_EQ(reader.file().size(), std::filesystem::file_size(path));
}

TEST(Mcap, OfAnotherKindIsRefusedWithPathAndByte) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_whole(path, {});
  EXPECT_EQ(test::refusal(path), path +
                                     ":byte 0: an empty file; expected the first bytes of an MCAP "
                                     "file, 89 4D 43 41 50 30 0D 0A");
  test::write_whole(path, {'#', 'R', 'O', 'S', 'B', 'A', 'G', ' ', 'V', '2'});
  EXPECT_EQ(test::refusal(path).find(path + ":byte 0: another file format"), 0U);
  EXPECT_EQ(
      test::refusal(folder.file("none.mcap")).find(folder.file("none.mcap") + ": No such file"),
      0U);
  EXPECT_NE(test::refusal("/tmp").find("not a regular file"), std::string::npos);
}

}  // namespace
}  // namespace glint
