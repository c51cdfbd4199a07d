// The controller's C decoder after flipped bits and a channel's faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <random>
#include <vector>

#include "kernels/wire/e2e.hpp"
#include "tests/unit/platform/sinks/can/controller_receiver.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::controller_test {
namespace {

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
    const int frames_sent = test::repetitions(50'000, 2'000);
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
