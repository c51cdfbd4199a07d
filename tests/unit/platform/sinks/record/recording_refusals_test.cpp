// Recordings that the reader rejects or reads in part, and its messages.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "platform/input_error.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/sinks/record/topics.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::recording_refusals_test {
namespace {

// The reader's message without the path; "" if it accepts the file.
std::string error_of(const std::string& path, ReadTolerance tolerance = {}) {
  try {
    RecordingReader reader(path, tolerance);
    while (reader.next()) {
    }
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find(path), 0u) << text;
    return text.substr(path.size());
  }
  return "";
}

// A file with the metadata of a recording, one entry changed.
std::string refusal_with(const std::string& fact, const std::string& value,
                         const std::string& profile = "ros2",
                         const std::string& metadata = k_opening_metadata) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  McapTexts texts{{k_fact_format, "1"},
                  {k_fact_level, "roi"},
                  {k_fact_nominal_tick, "4000000"},
                  {k_fact_unix_offset, "-5"}};
  texts[fact] = value;
  McapWriter writer(path, profile, "glint");
  writer.add_metadata(metadata, texts);
  EXPECT_TRUE(writer.close(k_closing_metadata, {{k_fact_complete, "true"}}));
  return error_of(path);
}

TEST(RecordingRefusals, NameTheFactThatIsWrong) {
  EXPECT_EQ(refusal_with("another", "fact"), "");
  const std::string foreign =
      ":byte 0: an MCAP file of another program; expected a recording of "
      "Glint";
  EXPECT_EQ(refusal_with("another", "fact", "ros1"), foreign);
  EXPECT_EQ(refusal_with("another", "fact", "ros2", "other"), foreign);
  EXPECT_EQ(refusal_with(k_fact_format, "2"), ":byte 0: format '2'; expected format 1");
  EXPECT_EQ(refusal_with(k_fact_level, "some"),
            ": recording level 'some'; expected full, roi, blobs or outputs");
  for (const char* const fact : {k_fact_nominal_tick, k_fact_unix_offset}) {
    for (const std::string bad : {"", "4 ms", "x", "1.5", "99999999999999999999"}) {
      EXPECT_EQ(refusal_with(fact, bad),
                ":byte 0: '" + bad + "' as " + fact + "; expected a whole number of nanoseconds");
    }
  }
}

TEST(RecordingRefusals, NameWhatARecordingLost) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  const std::string expected =
      "; expected a complete recording, required for equal output; --allow-incomplete reads the "
      "rest";
  const auto write = [&](const std::string& complete, const std::string& why) {
    std::filesystem::remove(path);
    McapWriter writer(path, "ros2", "glint");
    writer.add_metadata(k_opening_metadata, {{k_fact_format, "1"},
                                             {k_fact_level, "roi"},
                                             {k_fact_nominal_tick, "1"},
                                             {k_fact_unix_offset, "2"}});
    EXPECT_TRUE(writer.close(
        k_closing_metadata,
        {{k_fact_complete, complete}, {k_fact_dropped, "3"}, {k_fact_ended_early, why}}));
  };
  write("false", "");
  EXPECT_EQ(error_of(path), ":byte 0: a recording that lost 3 messages" + expected);
  EXPECT_NE(error_of(path, {.truncated = true, .incomplete = false}), "");
  EXPECT_EQ(error_of(path, {.truncated = false, .incomplete = true}), "");
  write("false", "the disk was full");
  EXPECT_EQ(error_of(path), ":byte 0: a recording that ended early (the disk was full)" + expected);
  write("true", "");
  EXPECT_EQ(error_of(path), "");
  RecordingReader reader(path);
  EXPECT_EQ(reader.level(), RecordingLevel::roi);
  EXPECT_EQ(reader.nominal_tick(), Duration{1});
  EXPECT_EQ(reader.unix_offset(), Duration{2});
  EXPECT_EQ(reader.facts().at(k_fact_dropped), "3") << "of its end";
  EXPECT_EQ(reader.facts().at(k_fact_format), "1") << "of its beginning";
  try {
    (void)reader.attachment("cell.toml");
    ADD_FAILURE() << "there is none";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path + ":byte 0: no attachment 'cell.toml'; expected one; it has none");
  }
  EXPECT_TRUE(reader.attachment_names().empty());
}

// The file's checksums are correct; the message has five bytes.
TEST(RecordingRefusals, NameTheTopicOfAMessageThatIsNotWhole) {
  for (const std::string_view topic :
       {k_frame_topic, k_head_pose_topic, k_markers_topic, k_choice_topic, k_output_topic,
        k_dropped_topic, k_robot_frame_topic, k_pen_buttons_topic, k_button_topic,
        k_reflectivity_topic, k_depth_topic}) {
    const TemporaryFolder folder;
    const std::string path = folder.file("run.mcap");
    McapWriter writer(path, "ros2", "glint");
    writer.add_metadata(k_opening_metadata, {{k_fact_format, "1"},
                                             {k_fact_level, "full"},
                                             {k_fact_nominal_tick, "1"},
                                             {k_fact_unix_offset, "2"}});
    const auto chunk_at = writer.bytes();
    const auto other = writer.add_channel("/other", "a/msg/A", "", {});
    const auto channel = writer.add_channel(std::string(topic), "a/msg/A", "", {});
    writer.write({other, 0, 1, 1}, Bytes{1});  // of another program: ignored
    writer.write({channel, 0, 1, 1}, Bytes{0, 1, 0, 0, 5});
    EXPECT_TRUE(writer.close(k_closing_metadata, {{k_fact_complete, "true"}}));
    EXPECT_EQ(error_of(path), ":byte " + std::to_string(chunk_at) + ": a message on " +
                                  std::string(topic) +
                                  " that is incomplete; expected the fields of its type");
  }
}

// Three full frames; each message has its own chunk.
void write_frames(const std::string& path) {
  RecordingSettings settings;
  settings.chunk_bytes = 1;
  RecordingWriter writer(path, sample_info(RecordingLevel::full), settings);
  const FrameBuffer buffer = sample_frame(8, 6, 16);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const FrameLayout layout = whole_frame_layout(buffer.view({1}, {2}, i));
    std::vector<std::uint8_t> pixels(pixel_bytes(layout));
    copy_pixels(buffer.view({}, {}, 0), layout, pixels);
    writer.write_frame({layout, pixels});
  }
  EXPECT_TRUE(writer.close().complete());
}

// Offsets of the chunks, in order.
std::vector<std::size_t> chunks_of(const std::string& bytes) {
  std::vector<std::size_t> places;
  for (std::size_t at = k_mcap_magic.size(); at + k_mcap_magic.size() < bytes.size();) {
    if (bytes[at] == static_cast<char>(McapKind::chunk)) places.push_back(at);
    at += k_mcap_heading_bytes + get_little_endian(bytes_of(bytes).subspan(at + 1, 8));
  }
  return places;
}

// A lost image also loses the frame whose pixels it contains, and no other.
TEST(RecordingLosses, CountTheFrameWhosePixelsAreDamaged) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  write_frames(path);
  const std::string whole = text_of(std::filesystem::path(path));
  const std::vector<std::size_t> chunks = chunks_of(whole);
  ASSERT_EQ(chunks.size(), 9u) << "reflectivity, depth and frame, three times";
  for (std::size_t damaged = 0; damaged < 9; ++damaged) {
    std::string bytes = whole;
    bytes[chunks[damaged] + 100] = static_cast<char>(bytes[chunks[damaged] + 100] ^ 1);
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_NE(error_of(path), "");
    RecordingReader reader(path, {.truncated = true, .incomplete = false});
    std::vector<std::uint64_t> frames;
    while (const auto message = reader.next())
      frames.push_back(std::get<FrameMessage>(*message).sequence);
    std::vector<std::uint64_t> expected{0, 1, 2};
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(damaged / 3));
    EXPECT_EQ(frames, expected) << damaged;
    const RecordingLosses losses = reader.losses();
    EXPECT_EQ(losses.frames, 1) << damaged;
    EXPECT_EQ(losses.messages, 1);
    EXPECT_EQ(losses.chunks, 1);
    EXPECT_GT(losses.bytes, 100u);
    EXPECT_FALSE(losses.at_least);
    EXPECT_TRUE(losses.any());
    EXPECT_EQ(reader.gaps(), 1u);
  }
}

TEST(RecordingLosses, CountTheMarkersAsFramesWhereThereAreNoFrames) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecordingSettings settings;
  settings.chunk_bytes = 1;
  {
    RecordingWriter writer(path, sample_info(RecordingLevel::blobs), settings);
    for (int i = 0; i < 3; ++i) {
      writer.write_markers(sample_markers(1));
      writer.write_choice(sample_choice(1));
    }
  }
  const std::string whole = text_of(std::filesystem::path(path));
  const std::vector<std::size_t> chunks = chunks_of(whole);
  ASSERT_EQ(chunks.size(), 6u);
  std::string bytes = whole;
  for (const std::size_t damaged : {2, 3, 4}) {  // markers, a choice, markers
    bytes[chunks[damaged] + 100] = static_cast<char>(bytes[chunks[damaged] + 100] ^ 1);
  }
  std::ofstream(path, std::ios::binary) << bytes;
  RecordingReader reader(path, {.truncated = true, .incomplete = false});
  int read = 0;
  while (reader.next()) ++read;
  EXPECT_EQ(read, 3);
  EXPECT_EQ(reader.losses().frames, 2);
  EXPECT_EQ(reader.losses().messages, 3);
  EXPECT_EQ(reader.losses().chunks, 3);
  EXPECT_EQ(reader.gaps(), 3u);
}

TEST(RecordingLosses, HaveATextWithEachOfTheirNumbers) {
  EXPECT_EQ(text_of(RecordingLosses{3, 12, 1, 4096, true}),
            "at least 3 frames (12 messages), 4096 bytes, 1 damaged chunk");
  EXPECT_EQ(text_of(RecordingLosses{3, 12, 2, 4096, false}),
            "3 frames (12 messages), 4096 bytes, 2 damaged chunks");
  EXPECT_EQ(text_of(RecordingLosses{0, 0, 0, 5, false}), "0 frames (0 messages), 5 bytes");
  EXPECT_FALSE((RecordingLosses{}.any()));
  EXPECT_TRUE((RecordingLosses{0, 1, 0, 0, false}.any()));
  EXPECT_TRUE((RecordingLosses{0, 0, 0, 1, false}.any()));
}

// Cut after the last complete chunk: neither the ending nor the closing metadata exist.
TEST(RecordingLosses, OfAFileCutShortHideNoFactOfItsBeginning) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  write_frames(path);
  const std::string whole = text_of(std::filesystem::path(path));
  const std::vector<std::size_t> chunks = chunks_of(whole);
  std::ofstream(path, std::ios::binary) << whole.substr(0, chunks[6]);
  EXPECT_NE(error_of(path), "");
  RecordingReader reader(path, {.truncated = true, .incomplete = false});
  int frames = 0;
  while (reader.next()) ++frames;
  EXPECT_EQ(frames, 2);
  EXPECT_TRUE(reader.losses().at_least);
  EXPECT_EQ(reader.facts().at("compiler"), "g++ 12");
  EXPECT_EQ(reader.facts().count(k_fact_output_sha256), 0u);
  EXPECT_EQ(reader.attachment("rays.npy").data, (Bytes{1, 2, 3, 0, 255}));
}

// The outcome, the closing metadata and the file agree.
TEST(RecordingOutcome, IsWhatTheFileSays) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecordingWriter writer(path, sample_info(RecordingLevel::roi));
  writer.write_choice(sample_choice(1));
  writer.write_choice(sample_choice(2));
  writer.add_closing_fact("frames", "2");
  writer.count_dropped_offers(2);
  writer.count_dropped_offers(3);
  EXPECT_EQ(writer.messages_lost(), 0u);
  const RecordingOutcome outcome = writer.close();
  EXPECT_EQ(outcome.messages, 2u);
  EXPECT_EQ(outcome.dropped, 5u);
  EXPECT_EQ(outcome.lost, 0u);
  EXPECT_FALSE(outcome.ended_early);
  EXPECT_FALSE(outcome.complete());
  EXPECT_EQ(outcome.reason, "");
  EXPECT_EQ(outcome.bytes, std::filesystem::file_size(path));
  EXPECT_EQ(writer.outcome().bytes, outcome.bytes);
  EXPECT_EQ(writer.close().bytes, outcome.bytes) << "closed once";
  McapReader reader(path);
  EXPECT_EQ(reader.metadata().at(k_closing_metadata),
            (McapTexts{{"complete", "false"},
                       {"dropped", "5"},
                       {"ended_early", ""},
                       {"frames", "2"},
                       {"output_sha256", outcome.output_sha256}}));
}

TEST(RecordingOutcome, NamesTheUnfinishedFileThatHoldsTheBytes) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  RecordingWriter writer(folder.file("in/run.mcap"), sample_info(RecordingLevel::roi));
  writer.write_choice(sample_choice(1));
  std::filesystem::remove_all(folder.file("in"));
  const RecordingOutcome outcome = writer.close();
  EXPECT_TRUE(outcome.ended_early);
  EXPECT_FALSE(outcome.complete());
  EXPECT_EQ(outcome.output_sha256, "");
  EXPECT_EQ(outcome.messages, 1u);
  const std::string part = folder.file("in/run.mcap.part");
  EXPECT_EQ(outcome.reason, part + ": rename at byte " + std::to_string(outcome.bytes) +
                                ": No such file or directory; the written part stays in " + part);
}

}  // namespace
}  // namespace glint::recording_refusals_test
