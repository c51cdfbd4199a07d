#include "platform/sinks/record/recording_reader.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/sinks/record/sha256.hpp"
#include "platform/sinks/record/topics.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

PoseSample output_of_tool_3(std::uint32_t tick, TrackState state = TrackState::measured) {
  PoseSample sample = sample_output(tick, state);
  sample.tool = 3;
  return sample;
}

std::vector<RecordedMessage> all_messages(RecordingReader& reader) {
  std::vector<RecordedMessage> messages;
  while (auto message = reader.next()) messages.push_back(std::move(*message));
  return messages;
}

void write_frame(RecordingWriter& writer, const FrameBuffer& buffer, const FrameLayout& layout) {
  const Frame frame = buffer.view(layout.mid_exposure, layout.arrival, layout.sequence);
  std::vector<std::uint8_t> pixels(pixel_bytes(layout));
  copy_pixels(frame, layout, pixels);
  writer.write_frame({layout, pixels});
}

// Writes one message of each kind and two frames.
RecordingOutcome write_sample(const std::string& path, RecordingLevel level, int bits = 16) {
  RecordingWriter writer(path, sample_info(level));
  const FrameBuffer buffer = sample_frame(40, 30, bits);
  Frame frame = buffer.view({100}, {200}, 9);
  frame.stamp_sigma = {55};
  const Rois rois{{Roi{4, 5, 12, 9}, Roi{30, 20, 38, 29}}, 2};
  writer.write_choice(sample_choice(1));
  write_frame(writer, buffer, whole_frame_layout(frame));
  write_frame(writer, buffer, roi_layout(frame, rois, 1));
  writer.write_markers(sample_markers(3));
  writer.write_head_pose(sample_head_pose(1));
  writer.write_dropped({{1}, {2}, 3, Reason::frame_late});
  writer.write_output(output_of_tool_3(5), record_of(output_of_tool_3(5)));
  const PoseSample lost = output_of_tool_3(6, TrackState::lost);
  writer.write_output(lost, record_of(lost));
  writer.add_closing_fact("frames", "2");
  return writer.close();
}

TEST(Recording, GivesBackAllThatItsLevelKeepsInOrder) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  ASSERT_TRUE(write_sample(path, RecordingLevel::roi).complete());
  RecordingReader reader(path);
  EXPECT_EQ(reader.level(), RecordingLevel::roi);
  EXPECT_EQ(reader.nominal_tick(), milliseconds(4));
  EXPECT_EQ(reader.unix_offset().nanoseconds, 1'700'000'000'000'000'123);
  const auto messages = all_messages(reader);
  ASSERT_EQ(messages.size(), 7U);
  EXPECT_EQ(std::get<ChoiceRecord>(messages[0]), sample_choice(1));
  EXPECT_EQ(std::get<FrameMessage>(messages[1]).sequence, 9U);
  const auto& head = std::get<HeadPose>(messages[3]);
  EXPECT_EQ(head.time, sample_head_pose(1).time);
  EXPECT_TRUE(head.valid);
  EXPECT_EQ(head.T_world_camera.translation, sample_head_pose(1).T_world_camera.translation);
  EXPECT_EQ(head.T_world_camera.rotation.coeffs(),
            sample_head_pose(1).T_world_camera.rotation.coeffs());
  const auto& dropped = std::get<DroppedInput>(messages[4]);
  EXPECT_EQ(dropped.arrival, Time{2});
  EXPECT_EQ(dropped.sequence, 3U);
  EXPECT_EQ(dropped.reason, Reason::frame_late);
  const auto& output = std::get<OutputMessage>(messages[5]);
  EXPECT_EQ(output.tick, output_of_tool_3(5).tick);
  EXPECT_EQ(output.tool, output_of_tool_3(5).tool);
  const auto record = record_of(output_of_tool_3(5));
  EXPECT_EQ(output.record, std::vector<std::uint8_t>(record.begin(), record.end()));
}

// The file's checksums are correct, but one image message is truncated.
TEST(Recording, RefusesAPictureThatIsNotWhole) {
  const TemporaryFolder folder;
  for (const std::string_view topic : {k_reflectivity_topic, k_depth_topic}) {
    const std::string whole = folder.file("whole.mcap"), path = folder.file("cut.mcap");
    write_sample(whole, RecordingLevel::full);
    McapReader from(whole);
    McapWriter to(path, from.profile(), "test");
    std::map<std::string, std::uint16_t> channels;
    while (const auto message = from.next()) {
      const std::string& name = message->channel->topic;
      if (channels.count(name) == 0) {
        channels[name] = to.add_channel(name, message->schema->name, "", {});
      }
      McapMessageHeading heading = message->heading;
      heading.channel_id = channels[name];
      to.write(heading, message->payload.first(message->payload.size() - (name == topic)));
    }
    for (const auto& [name, texts] : from.metadata()) {
      if (name != k_closing_metadata) to.add_metadata(name, texts);
    }
    ASSERT_TRUE(to.close(k_closing_metadata, from.metadata().at(k_closing_metadata)));
    RecordingReader reader(path);
    try {
      (void)all_messages(reader);
      ADD_FAILURE() << topic << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(topic), std::string::npos) << error.what();
    }
  }
}

TEST(Recording, KeepsNothingOfARegionThatIsEmpty) {
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  const Rois rois{{Roi{4, 5, 4, 9}, Roi{30, 20, 38, 29}, Roi{9, 9, 12, 9}}, 3};
  const FrameLayout layout = roi_layout(buffer.view({}, {}, 0), rois, 2);
  EXPECT_EQ(layout.rectangle_count, 1);
  EXPECT_EQ(layout.rectangles[0].x0, 28);
}

TEST(Recording, GivesBackEveryPixelOfAWholeFrame) {
  for (const RecordingLevel level : {RecordingLevel::full, RecordingLevel::roi})
    for (const int bits : {8, 16}) {
      const TemporaryFolder folder;
      write_sample(folder.file("run.mcap"), level, bits);
      RecordingReader reader(folder.file("run.mcap"));
      (void)reader.next();
      const auto frame = std::get<FrameMessage>(reader.next().value());
      const FrameBuffer expected = sample_frame(40, 30, bits);
      EXPECT_EQ(frame.mid_exposure, Time{100});
      EXPECT_EQ(frame.view().stamp_sigma, Duration{55});
      EXPECT_EQ(frame.arrival, Time{200});
      EXPECT_EQ(frame.pixels.width, 40);
      EXPECT_EQ(frame.pixels.height, 30);
      EXPECT_EQ(frame.pixels.reflectivity_8, expected.reflectivity_8);
      EXPECT_EQ(frame.pixels.reflectivity_16, expected.reflectivity_16);
      EXPECT_EQ(frame.pixels.depth, expected.depth);
    }
}

TEST(Recording, GivesBackRegionsWithTheirMarginAndNothingElse) {
  const TemporaryFolder folder;
  write_sample(folder.file("run.mcap"), RecordingLevel::roi);
  RecordingReader reader(folder.file("run.mcap"));
  (void)reader.next();
  (void)reader.next();
  const auto frame = std::get<FrameMessage>(reader.next().value());
  const FrameBuffer whole = sample_frame(40, 30, 16);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool kept = (x >= 3 && x < 13 && y >= 4 && y < 10) || (x >= 29 && x < 39 && y >= 19);
      const auto i = static_cast<std::size_t>(y * 40 + x);
      ASSERT_EQ(frame.pixels.reflectivity_16[i], kept ? whole.reflectivity_16[i] : 0)
          << x << ',' << y;
      ASSERT_EQ(frame.pixels.depth[i], kept ? whole.depth[i] : 0) << x << ',' << y;
    }
}

TEST(Recording, GivesBackMarkersAtLevelBlobs) {
  const TemporaryFolder folder;
  write_sample(folder.file("run.mcap"), RecordingLevel::blobs);
  RecordingReader reader(folder.file("run.mcap"));
  const auto messages = all_messages(reader);
  ASSERT_EQ(messages.size(), 6U);
  const auto& read = std::get<MarkerFrame>(messages[1]);
  const MarkerFrame wrote = sample_markers(3);
  EXPECT_EQ(read.mid_exposure, wrote.mid_exposure);
  EXPECT_EQ(read.stamp_sigma, wrote.stamp_sigma);
  EXPECT_EQ(read.arrival, wrote.arrival);
  EXPECT_EQ(read.sequence, wrote.sequence);
  EXPECT_EQ(read.reason, wrote.reason);
  ASSERT_EQ(read.markers.count, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Marker& a = read.markers.items[i];
    const Marker& b = wrote.markers.items[i];
    EXPECT_EQ(a.ray, b.ray);
    EXPECT_EQ(a.surface_range_m, b.surface_range_m);
    EXPECT_EQ(a.centroid_px, b.centroid_px);
    EXPECT_EQ(a.area_px, b.area_px);
    EXPECT_EQ(a.blob, b.blob);
    EXPECT_EQ(a.flags, b.flags);
    EXPECT_EQ(a.sigma_px, b.sigma_px);
    EXPECT_EQ(a.range_sigma_m, b.range_sigma_m);
    EXPECT_EQ(a.along_x, b.along_x);
    EXPECT_EQ(a.along_y, b.along_y);
    EXPECT_EQ(a.bias_subtracted_m, b.bias_subtracted_m);
    EXPECT_EQ(a.peak, b.peak);
  }
  EXPECT_EQ(read.markers.incomplete, Reason::blobs_full);
}

TEST(Recording, KeepsOutputsAloneAtLevelOutputs) {
  const TemporaryFolder folder;
  write_sample(folder.file("run.mcap"), RecordingLevel::outputs);
  RecordingReader reader(folder.file("run.mcap"));
  const auto messages = all_messages(reader);
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<OutputMessage>(messages[1]));
}

TEST(Recording, KeepsThePensButtonsAtEveryLevel) {
  for (const RecordingLevel level : {RecordingLevel::full, RecordingLevel::roi,
                                     RecordingLevel::blobs, RecordingLevel::outputs}) {
    const TemporaryFolder folder;
    const ButtonEvent down{{12'345}, Button::draw, true}, up{{99'999}, Button::undo, false};
    {
      RecordingWriter writer(folder.file("run.mcap"), sample_info(level));
      writer.write_button(down);
      writer.write_button(up);
    }
    RecordingReader reader(folder.file("run.mcap"));
    const auto messages = all_messages(reader);
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_EQ(std::get<ButtonEvent>(messages[0]), down);
    EXPECT_EQ(std::get<ButtonEvent>(messages[1]), up);
  }
}

TEST(Recording, KeepsTheRobotsFramesToTheBitWhereTheyAreDecidedFrom) {
  RobotFrameRecord frame;
  frame.version = 7;
  frame.time = {12'345};
  frame.state = RegistrationState::accepted;
  frame.T_world_robot = {Quaternion(0.1, 0.7, 1.0 / 3, -0.2), Vector3(1.0 / 7, -2, 3)};
  frame.rms_m = 0.0041;
  frame.in_reference = true;
  for (const RecordingLevel level : {RecordingLevel::full, RecordingLevel::roi,
                                     RecordingLevel::blobs, RecordingLevel::outputs}) {
    const TemporaryFolder folder;
    {
      RecordingWriter writer(folder.file("run.mcap"), sample_info(level));
      writer.write_robot_frame(frame);
    }
    RecordingReader reader(folder.file("run.mcap"));
    const auto messages = all_messages(reader);
    if (level == RecordingLevel::outputs) {
      EXPECT_TRUE(messages.empty());
      continue;
    }
    ASSERT_EQ(messages.size(), 1U);
    const auto& back = std::get<RobotFrameRecord>(messages[0]);
    EXPECT_EQ(back.version, frame.version);
    EXPECT_EQ(back.time, frame.time);
    EXPECT_EQ(back.state, frame.state);
    EXPECT_EQ(back.in_reference, frame.in_reference);
    EXPECT_EQ(back.rms_m, frame.rms_m);
    EXPECT_EQ(back.T_world_robot.translation, frame.T_world_robot.translation);
    EXPECT_EQ(back.T_world_robot.rotation.coeffs(), frame.T_world_robot.rotation.coeffs());
  }
}

TEST(Recording, KeepsWhichButtonsAreHeldWhereTicksAreDecidedFromThem) {
  const PenButtonsRecord pressed{7, {12'345}, 5}, let_go{(std::uint64_t{1} << 40) + 3, {99'999}, 0};
  for (const RecordingLevel level : {RecordingLevel::full, RecordingLevel::roi,
                                     RecordingLevel::blobs, RecordingLevel::outputs}) {
    const TemporaryFolder folder;
    {
      RecordingWriter writer(folder.file("run.mcap"), sample_info(level));
      writer.write_pen_buttons(pressed);
      writer.write_pen_buttons(let_go);
    }
    RecordingReader reader(folder.file("run.mcap"));
    const auto messages = all_messages(reader);
    if (level == RecordingLevel::outputs) {
      EXPECT_TRUE(messages.empty());
      continue;
    }
    ASSERT_EQ(messages.size(), 2U);
    EXPECT_EQ(std::get<PenButtonsRecord>(messages[0]), pressed);
    EXPECT_EQ(std::get<PenButtonsRecord>(messages[1]), let_go);
  }
}

TEST(Recording, SaysTheHashOfItsOutputRecords) {
  const TemporaryFolder folder;
  const auto outcome = write_sample(folder.file("run.mcap"), RecordingLevel::roi);
  Sha256 hash;
  hash.add(record_of(output_of_tool_3(5)));
  hash.add(record_of(output_of_tool_3(6, TrackState::lost)));
  EXPECT_EQ(outcome.output_sha256, hash.hex());
  RecordingReader reader(folder.file("run.mcap"));
  EXPECT_EQ(reader.facts().at("output_sha256"), hash.hex());
  EXPECT_EQ(reader.facts().at("frames"), "2");
  EXPECT_EQ(reader.facts().at("compiler"), "g++ 12");
}

TEST(Recording, KeepsItsAttachmentsToTheByte) {
  const TemporaryFolder folder;
  write_sample(folder.file("run.mcap"), RecordingLevel::roi);
  RecordingReader reader(folder.file("run.mcap"));
  const Attachment rays = reader.attachment("rays.npy");
  EXPECT_EQ(rays.data, (std::vector<std::uint8_t>{1, 2, 3, 0, 255}));
  EXPECT_EQ(rays.media_type, "application/octet-stream");
  EXPECT_EQ(reader.attachment_names(), (std::vector<std::string>{"cell.toml", "rays.npy"}));
  try {
    (void)reader.attachment("other");
    ADD_FAILURE() << "expected a refusal";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no attachment 'other'; expected cell.toml, rays.npy"), std::string::npos)
        << text;
  }
}

TEST(Recording, ThatLostOffersIsRefusedUnlessAskedFor) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    RecordingWriter writer(path, sample_info(RecordingLevel::roi));
    writer.write_choice(sample_choice(1));
    writer.count_dropped_offers(3);
  }
  try {
    RecordingReader reader(path);
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lost 3 messages"), std::string::npos) << error.what();
  }
  RecordingReader reader(path, {.truncated = false, .incomplete = true});
  EXPECT_EQ(all_messages(reader).size(), 1U);
}

TEST(Recording, HasItsNameOnlyWhenItIsWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecordingWriter writer(path, sample_info(RecordingLevel::roi));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(path + ".part"));
  writer.close();
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(Recording, InAFolderThatIsNotThereIsRefused) {
  EXPECT_THROW(RecordingWriter("/nowhere/at/all/run.mcap", sample_info(RecordingLevel::roi)),
               InputError);
}

TEST(Recording, LevelIsReadByNameOrRefusedWithTheFourNames) {
  for (const auto level :
       {RecordingLevel::full, RecordingLevel::roi, RecordingLevel::blobs, RecordingLevel::outputs})
    EXPECT_EQ(recording_level(name_of(level), "cell.toml:3"), level);
  try {
    (void)recording_level("all", "cell.toml:3");
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cell.toml:3: recording level 'all'; expected full, roi, blobs or outputs");
  }
}

}  // namespace
}  // namespace glint
