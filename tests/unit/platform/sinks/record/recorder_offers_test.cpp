// Result of each kind of offer, at each level, in each lane, with and without free space.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "platform/sinks/record/bytes.hpp"
#include "platform/sinks/record/recorder.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::recorder_offers_test {
namespace {

constexpr RecordingLevel k_levels[] = {RecordingLevel::full, RecordingLevel::roi,
                                       RecordingLevel::blobs, RecordingLevel::outputs};

// Offers one message of each kind; the lane accepts all.
void offer_one_of_each(RecorderLane& lane) {
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  EXPECT_TRUE(lane.offer_frame(buffer.view({1}, {2}, 3), Rois{{Roi{10, 10, 20, 20}}, 1}));
  EXPECT_TRUE(lane.offer_head_pose(sample_head_pose(0)));
  EXPECT_TRUE(lane.offer_markers(sample_markers(2)));
  EXPECT_TRUE(lane.offer_choice(sample_choice(7)));
  const PoseSample sample = sample_output(1);
  EXPECT_TRUE(lane.offer_output(sample, record_of(sample)));
  EXPECT_TRUE(lane.offer_dropped({{1}, {2}, 3, Reason::frame_duplicate}));
  EXPECT_TRUE(lane.offer_button({{4}, Button::undo, true}));
  EXPECT_TRUE(lane.offer_robot_frame({5, {6}, RegistrationState::accepted, {}, 0.5, true}));
  EXPECT_TRUE(lane.offer_pen_buttons({8, {9}, 3}));
}

std::vector<RecordedMessage> messages_of(const std::string& path) {
  RecordingReader reader(path);
  std::vector<RecordedMessage> messages;
  while (auto message = reader.next()) messages.push_back(std::move(*message));
  return messages;
}

template <class Message>
const Message* find_in(const std::vector<RecordedMessage>& messages) {
  for (const RecordedMessage& message : messages)
    if (const auto* found = std::get_if<Message>(&message)) return found;
  return nullptr;
}

// README of platform/sinks/record: what each level keeps. The rest is accepted and ignored.
TEST(RecorderOffers, AreKeptAsTheirLevelSays) {
  for (const RecordingLevel level : k_levels) {
    SCOPED_TRACE(name_of(level));
    const TemporaryFolder folder;
    const std::string path = folder.file("run.mcap");
    {
      Recorder recorder(path, sample_info(level));
      offer_one_of_each(recorder.tick_lane());
      EXPECT_EQ(recorder.dropped(), 0u);
      EXPECT_TRUE(recorder.close().complete());
    }
    const auto messages = messages_of(path);
    const bool frames = level == RecordingLevel::full || level == RecordingLevel::roi;
    const bool inputs = level != RecordingLevel::outputs;
    EXPECT_EQ(find_in<FrameMessage>(messages) != nullptr, frames);
    EXPECT_EQ(find_in<MarkerFrame>(messages) != nullptr, level == RecordingLevel::blobs);
    EXPECT_EQ(find_in<HeadPose>(messages) != nullptr, inputs);
    EXPECT_EQ(find_in<ChoiceRecord>(messages) != nullptr, inputs);
    EXPECT_EQ(find_in<DroppedInput>(messages) != nullptr, inputs);
    EXPECT_EQ(find_in<RobotFrameRecord>(messages) != nullptr, inputs);
    EXPECT_EQ(find_in<PenButtonsRecord>(messages) != nullptr, inputs);
    EXPECT_NE(find_in<OutputMessage>(messages), nullptr);
    EXPECT_NE(find_in<ButtonEvent>(messages), nullptr);
    EXPECT_EQ(messages.size(), !inputs ? 2u : 8u);
  }
}

TEST(RecorderOffers, ArriveAsTheyWere) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    Recorder recorder(path, sample_info(RecordingLevel::full));
    offer_one_of_each(recorder.slice_lane());
  }
  const auto messages = messages_of(path);
  ASSERT_EQ(messages.size(), 8u);
  EXPECT_EQ(find_in<FrameMessage>(messages)->pixels.reflectivity_16,
            sample_frame(40, 30, 16).reflectivity_16);
  EXPECT_EQ(*find_in<ChoiceRecord>(messages), sample_choice(7));
  EXPECT_EQ(find_in<OutputMessage>(messages)->tick, sample_output(1).tick);
  EXPECT_EQ(*find_in<ButtonEvent>(messages), (ButtonEvent{{4}, Button::undo, true}));
  EXPECT_EQ(find_in<RobotFrameRecord>(messages)->version, 5u);
  EXPECT_EQ(find_in<RobotFrameRecord>(messages)->rms_m, 0.5);
  EXPECT_EQ(*find_in<PenButtonsRecord>(messages), (PenButtonsRecord{8, {9}, 3}));
}

TEST(RecorderOffers, KeepPixelsWithinTheMarginOfTheirRegion) {
  for (const int margin : {0, 3, 8}) {
    const TemporaryFolder folder;
    const std::string path = folder.file("run.mcap");
    RecorderSettings settings;
    if (margin != 8) settings.roi_margin_px = margin;  // the default
    {
      Recorder recorder(path, sample_info(RecordingLevel::roi), settings);
      offer_one_of_each(recorder.frame_lane());
    }
    const auto messages = messages_of(path);
    const auto& pixels = find_in<FrameMessage>(messages)->pixels.reflectivity_16;
    const FrameBuffer whole = sample_frame(40, 30, 16);
    for (int x = 0; x < 40; ++x) {
      const auto at = static_cast<std::size_t>(15 * 40 + x);
      const bool kept = x >= 10 - margin && x < 20 + margin;
      EXPECT_EQ(pixels[at], kept ? whole.reflectivity_16[at] : 0) << margin << ' ' << x;
    }
  }
}

// Each lane has the capacity of its own setting.
TEST(RecorderOffers, AreDroppedInTheLaneThatHasNoRoom) {
  for (int small = 0; small < 4; ++small) {
    const TemporaryFolder folder;
    RecorderSettings settings;
    std::size_t* const rooms[] = {&settings.frame_lane_bytes, &settings.tick_lane_bytes,
                                  &settings.input_lane_bytes, &settings.slice_lane_bytes};
    *rooms[small] = 64;
    Recorder recorder(folder.file("run.mcap"), sample_info(RecordingLevel::roi), settings);
    RecorderLane* const lanes[] = {&recorder.frame_lane(), &recorder.tick_lane(),
                                   &recorder.input_lane(), &recorder.slice_lane()};
    for (int lane = 0; lane < 4; ++lane)
      EXPECT_EQ(lanes[lane]->offer_choice(sample_choice(1)), lane != small) << lane << ' ' << small;
    EXPECT_EQ(recorder.dropped(), 1u);
    EXPECT_EQ(recorder.lost(), 1u);
    const RecordingOutcome outcome = recorder.close();
    EXPECT_EQ(outcome.dropped, 1u);
    EXPECT_EQ(outcome.messages, 3u);
    const RecordingOutcome again = recorder.close();
    EXPECT_EQ(again.dropped, 1u) << "the same outcome";
    EXPECT_EQ(again.messages, 3u);
    EXPECT_EQ(again.output_sha256, outcome.output_sha256);
  }
}

// An offer larger than the lane is dropped at once, even if the lane waits when full.
TEST(RecorderOffers, DoNotWaitForRoomThatThereNeverIs) {
  for (const OverflowPolicy when_full : {OverflowPolicy::drop, OverflowPolicy::wait}) {
    const TemporaryFolder folder;
    RecorderSettings settings;
    settings.when_full = when_full;
    settings.frame_lane_bytes = settings.tick_lane_bytes = 4096;
    Recorder recorder(folder.file("run.mcap"), sample_info(RecordingLevel::full), settings);
    const FrameBuffer buffer = sample_frame(40, 30, 16);
    EXPECT_FALSE(recorder.frame_lane().offer_frame(buffer.view({}, {}, 0), {}));
    EXPECT_FALSE(recorder.tick_lane().offer_frame(buffer.view({}, {}, 0), {}));
    EXPECT_EQ(recorder.dropped(), 2u) << "of all lanes";
  }
}

TEST(RecorderOffers, HoldAnOutputRecordUpToItsLimit) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    Recorder recorder(path, sample_info(RecordingLevel::outputs));
    const PoseSample lost = sample_output(1, TrackState::lost);
    EXPECT_TRUE(recorder.tick_lane().offer_output(lost, {}));
    EXPECT_TRUE(recorder.tick_lane().offer_output(lost, Bytes(k_offered_record_bytes_max, 7)));
    EXPECT_EQ(recorder.dropped(), 0u);
    EXPECT_FALSE(recorder.tick_lane().offer_output(lost, Bytes(k_offered_record_bytes_max + 1, 7)));
    EXPECT_EQ(recorder.dropped(), 1u);
    EXPECT_FALSE(recorder.close().complete());
  }
  RecordingReader reader(path, {.truncated = false, .incomplete = true});
  EXPECT_EQ(std::get<OutputMessage>(reader.next().value()).record.size(), 0u);
  EXPECT_EQ(std::get<OutputMessage>(reader.next().value()).record,
            Bytes(k_offered_record_bytes_max, 7));
  EXPECT_FALSE(reader.next());
}

TEST(RecorderOffers, AreWrittenByAThreadWithAName) {
  const TemporaryFolder folder;
  Recorder recorder(folder.file("run.mcap"), sample_info(RecordingLevel::roi));
  std::map<std::string, int> names;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    ++names[text_of(task.path() / "comm")];
  EXPECT_EQ(names["glint_record\n"], 1);
}

}  // namespace
}  // namespace glint::recorder_offers_test
