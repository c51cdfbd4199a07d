// The controller's C decoder, judged by the encoder of kernels/wire and by what a channel did.
#include "platform/sinks/can/controller/glint_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/e2e.hpp"
#include "kernels/wire/node_frames.hpp"
#include "tests/unit/kernels/wire/samples.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::controller_test {
namespace {

constexpr std::uint64_t k_cycle_us = 4000;
constexpr double k_half = 0.5 + 1e-6;

glint_settings settings_of(CanFormat format) {
  return {.base = k_can_base_default,
          .fd = format == CanFormat::fd,
          .cycle_us = k_cycle_us,
          .speed_max = 2000,
          .age_max = 1000,
          .measured_max = 100'000,
          .heartbeat = 0x720};
}

std::vector<CanFrame> frames_of(const PoseSample& sample, CanFormat format) {
  CanFrames frames;
  add_pose_frames(sample, {format, k_can_base_default}, frames);
  return {frames.frames().begin(), frames.frames().end()};
}

glint_frame c_frame(const CanFrame& frame) {
  return {frame.identifier, frame.fd, frame.length, frame.data.data()};
}

// A pen on a circle of 100 mm, one turn in 4 s, measured 8 ms before the tick.
PoseSample circle(std::uint64_t tick) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(tick) / 1000;
  PoseSample sample;
  sample.tick_number = tick;
  sample.tick = {static_cast<std::int64_t>(tick) * 4'000'000};
  sample.measurement = sample.tick - microseconds(8000);
  sample.state = TrackState::measured;
  sample.pose.translation = {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.5};
  sample.sigma_position_m = 1e-3;
  sample.sigma_orientation_rad = 1e-3;
  return sample;
}

class Receiver {
 public:
  explicit Receiver(CanFormat format) : format_(format) {
    const glint_settings settings = settings_of(format);
    glint_init(&controller, &settings);
  }
  glint_verdict send(const PoseSample& sample, std::uint64_t now_us) {
    glint_verdict verdict = GLINT_IGNORED;
    for (const CanFrame& frame : frames_of(sample, format_)) verdict = send(frame, now_us);
    return verdict;
  }
  glint_verdict send(const CanFrame& frame, std::uint64_t now_us) {
    const glint_frame received = c_frame(frame);
    return glint_receive(&controller, &received, now_us);
  }
  // Sends ticks [0, ticks), and enables: the next tick's time is ticks * k_cycle_us.
  void start(std::uint64_t ticks) {
    for (std::uint64_t tick = 0; tick < ticks; ++tick) send(circle(tick), tick * k_cycle_us);
    ASSERT_TRUE(glint_enable(&controller, (ticks - 1) * k_cycle_us));
  }
  glint_controller controller{};

 private:
  CanFormat format_;
};

class ControllerOf : public testing::TestWithParam<CanFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, ControllerOf, testing::Values(CanFormat::classic, CanFormat::fd),
                         [](const auto& format) {
                           return format.param == CanFormat::fd ? "Fd" : "Classic";
                         });

TEST_P(ControllerOf, DecodesWhatWasEncoded) {
  const bool fd = GetParam() == CanFormat::fd;
  std::mt19937 random(311);
  for (int i = 0; i < 2000; ++i) {
    const PoseSample sample = random_sample(random);
    glint_set set{};
    for (const CanFrame& frame : frames_of(sample, GetParam())) {
      const glint_frame received = c_frame(frame);
      const std::uint32_t base = k_can_base_default + k_can_tool_stride * sample.tool;
      ASSERT_EQ(glint_decode(&received, frame.identifier - base, &set), GLINT_PARTIAL);
    }
    ASSERT_TRUE(set.has_position && set.has_rotation);
    const double position_step = fd ? 1e-6 : 50e-6;
    const double age_step = fd ? 1e-4 : 2e-4;
    const double largest_sigma = fd ? 0xFFFF : 0x3FF;
    Quaternion turn(set.rotation[3], set.rotation[0], set.rotation[1], set.rotation[2]);
    EXPECT_NEAR(turn.norm(), 0x1p30, fd ? 2 : 0x1p30 * 4e-5);
    turn.normalize();
    EXPECT_LE(turn.angularDistance(sample.pose.rotation), fd ? 1e-8 : 6.5e-5);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(std::abs(set.position_um[axis] * 1e-6 - sample.pose.translation[axis]),
                k_half * position_step);
      EXPECT_LE(std::abs(set.velocity[axis] * 1e-4 - sample.velocity_m_s[axis]), k_half * 1e-4);
      EXPECT_LE(std::abs(set.angular_velocity[axis] * 1e-3 - sample.angular_velocity_rad_s[axis]),
                k_half * 1e-3);
    }
    const double sigma = sample.sigma_position_m / 1e-5;
    EXPECT_NEAR(set.sigma_position, std::min(sigma, largest_sigma), k_half);
    EXPECT_NEAR(set.age * 1e-4, sample.age().seconds(), k_half * age_step);
    EXPECT_EQ(set.state, static_cast<int>(sample.state));
    EXPECT_EQ(set.registration, static_cast<int>(sample.registration));
    EXPECT_EQ(set.markers, std::popcount(sample.marker_mask));
    EXPECT_EQ(set.buttons, sample.buttons);
    EXPECT_EQ(set.counter, sample.tick_number % (fd ? 256 : 15));
  }
}

TEST_P(ControllerOf, RefusesOtherLengthsAndFormats) {
  for (const CanFrame& frame : frames_of(circle(3), GetParam())) {
    const std::uint32_t message = frame.identifier - k_can_base_default;
    glint_set set{};
    glint_frame shorter = c_frame(frame);
    --shorter.length;
    EXPECT_EQ(glint_decode(&shorter, message, &set), GLINT_WRONG_FORMAT);
    glint_frame other = c_frame(frame);
    other.fd = !other.fd;
    EXPECT_EQ(glint_decode(&other, message, &set), GLINT_WRONG_FORMAT);
    const glint_frame of_another_tool{frame.identifier + 16, frame.fd, frame.length,
                                      frame.data.data()};
    EXPECT_EQ(glint_decode(&of_another_tool, message, &set), GLINT_WRONG_CHECK);
  }
}

// Of the heartbeats, only "stopped" matters, and only one with the right length.
TEST_P(ControllerOf, StopsByTheHeartbeatOfAStoppedNodeUntilItIsEnabled) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 49 * k_cycle_us;
  for (const CanNodeState state :
       {CanNodeState::boot_up, CanNodeState::operational, CanNodeState::pre_operational}) {
    EXPECT_EQ(r.send(heartbeat_frame(32, state), now), GLINT_IGNORED);
  }
  EXPECT_EQ(r.send(heartbeat_frame(33, CanNodeState::stopped), now), GLINT_IGNORED);
  CanFrame longer = heartbeat_frame(32, CanNodeState::stopped);
  longer.length = 2;
  EXPECT_EQ(r.send(longer, now), GLINT_WRONG_FORMAT);
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_FOLLOW);
  EXPECT_EQ(r.send(heartbeat_frame(32, CanNodeState::stopped), now), GLINT_NODE_STOPPED);
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_STOP);
  EXPECT_EQ(r.send(circle(50), now + k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(glint_cycle(&r.controller, now + k_cycle_us), GLINT_STOP) << "a set enables nothing";
  EXPECT_TRUE(glint_enable(&r.controller, now + k_cycle_us));
  EXPECT_EQ(glint_cycle(&r.controller, now + k_cycle_us), GLINT_FOLLOW);
}

TEST_P(ControllerOf, FollowsUntilThreeCyclesAreMissedAndStopsAfterFive) {
  Receiver r(GetParam());
  EXPECT_FALSE(glint_enable(&r.controller, 0)) << "nothing was received";
  r.start(50);
  const std::uint64_t last = 49 * k_cycle_us;
  EXPECT_EQ(glint_cycle(&r.controller, last + 3 * k_cycle_us), GLINT_FOLLOW);
  EXPECT_EQ(glint_cycle(&r.controller, last + 3 * k_cycle_us + 1), GLINT_RAMP);
  EXPECT_EQ(glint_cycle(&r.controller, last + 5 * k_cycle_us - 1), GLINT_RAMP);
  EXPECT_EQ(glint_cycle(&r.controller, last + 5 * k_cycle_us), GLINT_STOP);
  EXPECT_EQ(r.send(circle(54), last + 5 * k_cycle_us), GLINT_JUMPED) << "4 sets are missing";
  EXPECT_EQ(r.send(circle(55), last + 6 * k_cycle_us), GLINT_JUMPED);
  EXPECT_EQ(r.send(circle(56), last + 7 * k_cycle_us), GLINT_ACCEPTED) << "the third in order";
  EXPECT_EQ(glint_cycle(&r.controller, last + 7 * k_cycle_us), GLINT_STOP) << "until enabled";
  EXPECT_TRUE(glint_enable(&r.controller, last + 7 * k_cycle_us));
  EXPECT_EQ(glint_cycle(&r.controller, last + 7 * k_cycle_us), GLINT_FOLLOW);
}

TEST_P(ControllerOf, FollowsAgainAfterARamp) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 53 * k_cycle_us;
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_RAMP) << "ticks 50 to 53 are missing";
  EXPECT_EQ(r.send(circle(52), now), GLINT_ACCEPTED) << "the counter advanced by 3";
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_FOLLOW);
}

TEST_P(ControllerOf, StopsAfterATenthOfASecondOfPredictions) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t last = 49 * k_cycle_us;
  for (std::uint64_t tick = 50; tick < 80; ++tick) {
    PoseSample sample = circle(tick);
    sample.state = TrackState::predicted;
    const std::uint64_t now = tick * k_cycle_us;
    EXPECT_EQ(r.send(sample, now), GLINT_ACCEPTED);
    EXPECT_EQ(glint_cycle(&r.controller, now), now - last < 100'000 ? GLINT_FOLLOW : GLINT_STOP);
  }
  EXPECT_FALSE(glint_enable(&r.controller, 80 * k_cycle_us));
}

TEST_P(ControllerOf, RejectsOldLostAndImplausiblePoses) {
  Receiver r(GetParam());
  r.start(50);
  PoseSample old = circle(50);
  old.measurement = old.measurement - microseconds(100'000);
  EXPECT_EQ(r.send(old, 50 * k_cycle_us), GLINT_TOO_OLD);
  PoseSample lost = circle(51);
  lost.state = TrackState::lost;
  EXPECT_EQ(r.send(lost, 51 * k_cycle_us), GLINT_NO_POSE);
  // Three cycles of 2 m/s and 3 x 1 mm allow 27 mm along each axis.
  PoseSample far = circle(52);
  far.pose.translation.y() = r.controller.accepted.position_um[1] * 1e-6 + 0.02705;
  EXPECT_EQ(r.send(far, 52 * k_cycle_us), GLINT_IMPLAUSIBLE);
  EXPECT_EQ(glint_cycle(&r.controller, 52 * k_cycle_us), GLINT_FOLLOW) << "of tick 49";
  PoseSample near = far;
  near.tick_number = 53;
  near.tick = near.tick + microseconds(4000);
  near.measurement = near.measurement + microseconds(4000);
  EXPECT_EQ(r.send(near, 53 * k_cycle_us), GLINT_ACCEPTED) << "four cycles allow 35 mm";
}

TEST_P(ControllerOf, RejectsAPoseThatDoesNotFitItsFields) {
  Receiver r(GetParam());
  r.start(50);
  PoseSample outside = circle(50);
  outside.pose.translation.x() = 3000;
  EXPECT_EQ(r.send(outside, 50 * k_cycle_us), GLINT_NO_POSE);
  PoseSample unturned = circle(51);
  unturned.pose.rotation = Quaternion(0, 0, 0, 0);
  EXPECT_EQ(r.send(unturned, 51 * k_cycle_us), GLINT_NO_POSE);
}

TEST(Controller, AcceptsTheFiveMessagesOfASetInAnyOrder) {
  Receiver r(CanFormat::classic);
  r.start(50);
  std::vector<CanFrame> frames = frames_of(circle(50), CanFormat::classic);
  std::ranges::reverse(frames);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(r.send(frames[i], 50 * k_cycle_us), GLINT_PARTIAL);
  EXPECT_EQ(r.send(frames[4], 50 * k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(frames[4], 50 * k_cycle_us), GLINT_PARTIAL) << "one message again";
  EXPECT_EQ(r.send(circle(51), 51 * k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(r.controller.count[GLINT_INCOMPLETE], 1U);
}

TEST_P(ControllerOf, AcceptsNoSetThatAGatewayDeliversLate) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 50 * k_cycle_us;
  for (std::uint64_t tick = 40; tick < 50; ++tick)
    EXPECT_NE(r.send(circle(tick), now), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(circle(50), now), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(circle(53), now), GLINT_JUMPED) << "three sets in no time";
}

// Share of the patterns of `flips` flipped bits in a frame that its checksum does not detect, by
// enumeration: the checksum is linear, so a pattern is undetected if its bits' syndromes add to 0.
double undetected_share(CanFormat format, int flips) {
  CanFrame frame = frames_of(circle(7), format).front();
  const int bits = 8 * frame.length;
  std::vector<std::uint32_t> syndromes;
  const auto check = [&](const CanFrame& f) {  // of the encoder: protects, and compares
    CanFrame again = f;
    if (f.fd)
      protect_p05({again.data.data(), again.length}, 0x1A8, f.data[2]);
    else
      protect_p01({again.data.data(), again.length}, 0x1A0, P01Mode::both, f.data[1] & 0xFU);
    return static_cast<std::uint32_t>((again.data[0] ^ f.data[0]) |
                                      (f.fd ? (again.data[1] ^ f.data[1]) << 8 : 0));
  };
  for (int bit = 0; bit < bits; ++bit) {
    CanFrame flipped = frame;
    flipped.data[static_cast<std::size_t>(bit / 8)] ^= static_cast<std::uint8_t>(1U << bit % 8);
    syndromes.push_back(check(flipped));
  }
  // Number of sets of `k` bits with each sum, bit by bit.
  const std::size_t sums = format == CanFormat::fd ? 65536 : 256;
  std::vector<std::vector<double>> count(static_cast<std::size_t>(flips) + 1,
                                         std::vector<double>(sums));
  count[0][0] = 1;
  double patterns = 1;
  for (const std::uint32_t syndrome : syndromes) {
    for (std::size_t k = static_cast<std::size_t>(flips); k > 0; --k)
      for (std::size_t sum = 0; sum < sums; ++sum) count[k][sum] += count[k - 1][sum ^ syndrome];
  }
  for (int k = 0; k < flips; ++k) patterns *= static_cast<double>(bits - k) / (k + 1);
  return count[static_cast<std::size_t>(flips)][0] / patterns;
}

// Flips different bits.
void flip(CanFrame& frame, int flips, std::mt19937& random) {
  std::vector<int> bits(static_cast<std::size_t>(8 * frame.length));
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = static_cast<int>(i);
  for (int i = 0; i < flips; ++i) {
    std::uniform_int_distribution<std::size_t> pick(static_cast<std::size_t>(i), bits.size() - 1);
    std::swap(bits[static_cast<std::size_t>(i)], bits[pick(random)]);
    const int bit = bits[static_cast<std::size_t>(i)];
    frame.data[static_cast<std::size_t>(bit / 8)] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

TEST_P(ControllerOf, AcceptsFlippedBitsNoMoreOftenThanTheChecksumsEnumeration) {
  std::mt19937 random(20);
  for (const int flips : {1, 2, 3, 4, 5, 6}) {
    const double share = undetected_share(GetParam(), flips);
    const int frames_sent = test::repetitions(50'000, 5'000);
    int undetected = 0;
    for (int i = 0; i < frames_sent; ++i) {
      std::vector<CanFrame> frames = frames_of(circle(random() % 100'000), GetParam());
      CanFrame& frame = frames[random() % frames.size()];
      flip(frame, flips, random);
      glint_set set{};
      const glint_frame received = c_frame(frame);
      // A counter of 15 is refused beyond the checksum.
      undetected +=
          glint_decode(&received, frame.identifier - k_can_base_default, &set) == GLINT_PARTIAL;
    }
    std::printf("%s, %d flipped bits: %d of %d undetected; enumeration %.3g\n",
                GetParam() == CanFormat::fd ? "P05" : "P01", flips, undetected, frames_sent,
                share * frames_sent);
    if (flips <= (GetParam() == CanFormat::fd ? 3 : 2)) {
      EXPECT_EQ(undetected, 0);
    }
    EXPECT_LE(undetected, share * frames_sent + 4 * std::sqrt(share * frames_sent + 1));
  }
}

// What a channel does to one set, 1 % each.
enum class Fault { none, drop, repeat, reorder, delay, freeze, flip };

TEST_P(ControllerOf, AcceptsEachSetOnceAndNoOlderOneAmongSixKindsOfFaults) {
  constexpr std::uint64_t k_sets = 100'000;
  const std::uint64_t counters = GetParam() == CanFormat::fd ? 256 : 15;
  Receiver r(GetParam());
  std::mt19937 random(91);
  std::deque<std::pair<std::uint64_t, std::uint64_t>> delayed;  // due tick, sent tick
  std::array<int, 7> faults{};
  std::uint64_t newest = 0, frozen_until = 0, frozen = 0;
  int accepted = 0, older = 0, wrapped = 0, stops = 0;
  const auto note = [&](glint_verdict verdict, std::uint64_t sent, std::uint64_t arrived) {
    if (verdict != GLINT_ACCEPTED) return;
    ++accepted;
    const Vector3 truth = circle(sent).pose.translation;
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(r.controller.accepted.position_um[axis] * 1e-6, truth[axis], 26e-6);
    // After a delay of almost one turn, the counter of profile 1 is that of the next set:
    // README.md.
    if (arrived - sent >= counters - 3) {
      ++wrapped;
      return;
    }
    older += sent <= newest && newest != 0;
    newest = std::max(newest, sent);
  };
  for (std::uint64_t tick = 1; tick < k_sets; ++tick) {
    const std::uint64_t now = tick * k_cycle_us;
    const unsigned draw = random() % 100;
    Fault fault = draw < 6 ? static_cast<Fault>(draw + 1) : Fault::none;
    if (tick < frozen_until) fault = Fault::freeze;
    ++faults[static_cast<std::size_t>(fault)];
    std::vector<CanFrame> frames = frames_of(circle(tick), GetParam());
    switch (fault) {
      case Fault::none:
      case Fault::drop:
        if (fault == Fault::drop) frames.erase(frames.begin() + random() % frames.size());
        break;
      case Fault::repeat:
        note(r.send(circle(tick - 1), now), tick - 1, tick);
        break;
      case Fault::reorder:
        std::ranges::shuffle(frames, random);
        break;
      case Fault::delay:
        delayed.emplace_back(tick + 1 + random() % 20, tick);
        continue;
      case Fault::freeze:
        if (tick >= frozen_until) {
          frozen = tick - 1;
          frozen_until = tick + 1 + random() % 20;
        }
        note(r.send(circle(frozen), now), frozen, frozen);
        continue;
      case Fault::flip:
        flip(frames[random() % frames.size()], 1 + static_cast<int>(random() % 2), random);
        break;
    }
    for (const CanFrame& frame : frames) note(r.send(frame, now), tick, tick);
    std::erase_if(delayed, [&](const auto& late) {
      if (late.first > tick) return false;
      const std::uint64_t phase = random() % k_cycle_us;
      note(r.send(circle(late.second), now + phase), late.second, tick);
      return true;
    });
    if (glint_cycle(&r.controller, now) == GLINT_STOP) {
      ++stops;
      (void)glint_enable(&r.controller, now);
    }
  }
  std::printf(
      "%s: %d of %d sets without a fault, %d accepted, %d older, %d delayed by a counter's turn, "
      "%d cycles stopped\n",
      GetParam() == CanFormat::fd ? "P05" : "P01", faults[0], static_cast<int>(k_sets), accepted,
      older, wrapped, stops);
  EXPECT_EQ(older, 0);
  EXPECT_GT(accepted, 0.9 * faults[0]) << "correct sets are used";
  EXPECT_LE(accepted, static_cast<int>(k_sets));
  EXPECT_LE(wrapped, 0.001 * static_cast<double>(k_sets));
  for (const int count : faults) EXPECT_GT(count, 500);
}

}  // namespace
}  // namespace glint::controller_test
