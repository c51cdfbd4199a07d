#include "kernels/wire/output_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "kernels/wire/bits.hpp"
#include "tests/unit/kernels/wire/hex.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace glint::output_record_test {
namespace {

using Record = std::array<std::uint8_t, k_output_record_bytes>;

Record encoded(const PoseSample& sample) {
  Record record;
  record.fill(0xEE);
  encode(sample, record);
  return record;
}

TEST(OutputRecord, ComesBackBitForBit) {
  std::mt19937 random(31);
  for (int i = 0; i < 500; ++i) {
    const PoseSample s = random_sample(random);
    const Record record = encoded(s);
    const auto back = decode(record);
    ASSERT_TRUE(back);
    EXPECT_EQ(encoded(back.value), record);
    EXPECT_EQ(back.value.tick, s.tick);
    EXPECT_EQ(back.value.measurement, s.measurement);
    EXPECT_EQ(back.value.frame_sequence, s.frame_sequence);
    EXPECT_EQ(back.value.reason, s.reason);
    EXPECT_EQ(back.value.frame, s.frame);
    EXPECT_EQ(back.value.pose.translation, s.pose.translation);
    EXPECT_EQ(back.value.pose.rotation.coeffs(), s.pose.rotation.coeffs());
    EXPECT_EQ(back.value.covariance, s.covariance);
    EXPECT_EQ(back.value.systematic, s.systematic);
    EXPECT_EQ(back.value.registration_rms_m, s.registration_rms_m);
    EXPECT_EQ(back.value.tick_number, s.tick_number);
    EXPECT_EQ(back.value.tool, s.tool);
    EXPECT_EQ(back.value.marker_mask, s.marker_mask);
    EXPECT_EQ(back.value.buttons, s.buttons);
    EXPECT_EQ(back.value.state, s.state);
    EXPECT_EQ(back.value.registration, s.registration);
    EXPECT_EQ(back.value.velocity_m_s, s.velocity_m_s);
    EXPECT_EQ(back.value.angular_velocity_rad_s, s.angular_velocity_rad_s);
    EXPECT_EQ(back.value.sigma_position_m, s.sigma_position_m);
    EXPECT_EQ(back.value.sigma_orientation_rad, s.sigma_orientation_rad);
  }
}

TEST(OutputRecord, HasItsDocumentedBytes) {
  PoseSample s;
  s.tick = {0x0102030405060708};
  s.measurement = {-2};
  s.tick_number = 0x11223344;
  s.frame_sequence = 0x55667788;
  s.tool = 9;
  s.marker_mask = 0xA5;
  s.buttons = 7;
  s.state = TrackState::predicted;
  s.registration = RegistrationState::accepted;
  s.frame = ReferenceFrame::robot;
  s.reason = Reason::bad_fit;
  s.pose.translation = Vector3(1, -2, 0.5);
  s.covariance(0, 1) = 1;
  s.registration_rms_m = 2;
  s.systematic(1, 0) = 1;
  s.systematic(5, 5) = 2;
  const Record record = encoded(s);
  const std::span<const std::uint8_t> bytes(record);
  EXPECT_EQ(hex_of(bytes.first(32)),
            "0807060504030201"
            "FEFFFFFFFFFFFFFF"
            "44332211"
            "88776655"
            "09A5070102020702");
  EXPECT_EQ(hex_of(bytes.subspan(32, 24)),
            "000000000000F03F"
            "00000000000000C0"
            "000000000000E03F");
  EXPECT_EQ(hex_of(bytes.subspan(80, 8)), "000000000000F03F");   // rotation's w
  EXPECT_EQ(hex_of(bytes.subspan(144, 8)), "000000000000F03F");  // covariance row 0, column 1
  EXPECT_EQ(hex_of(bytes.subspan(440, 8)), "0000000000000040");
  EXPECT_EQ(hex_of(bytes.subspan(456, 8)), "000000000000F03F");  // systematic row 1, column 0
  EXPECT_EQ(hex_of(bytes.subspan(608, 8)), "0000000000000040");  // row 5, column 5
}

TEST(OutputRecord, ShowsEveryFieldAndOverwritesEveryByte) {
  std::mt19937 random(32);
  Record zeros{}, ones{};
  ones.fill(0xFF);
  const PoseSample s = random_sample(random);
  encode(s, zeros);
  encode(s, ones);
  EXPECT_EQ(zeros, ones);

  // Changing any byte of a record changes the decoded sample, so decode() reads every field.
  for (std::size_t at = 0; at < k_output_record_bytes; ++at) {
    Record changed = zeros;
    changed[at] ^= 1;
    const auto back = decode(changed);
    if (back) {
      EXPECT_EQ(encoded(back.value), changed) << at;
    }
  }
}

TEST(OutputRecord, WritesOneKindOfZeroAndNothingThatIsNotANumber) {
  PoseSample plus, minus;
  minus.velocity_m_s = Vector3(-0.0, -0.0, -0.0);
  minus.covariance.setConstant(-0.0);
  minus.pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
  minus.sigma_position_m = std::numeric_limits<double>::infinity();
  EXPECT_EQ(encoded(plus), encoded(minus));
}

TEST(OutputRecord, RefusesBytesThatAreNoRecord) {
  const Record good = encoded(PoseSample{});
  ASSERT_TRUE(decode(good));
  const auto refused = [&](std::size_t at, std::uint8_t value) {
    Record bad = good;
    bad[at] = value;
    return decode(bad).reason == Reason::out_of_range;
  };
  EXPECT_TRUE(refused(24, k_tools_max));
  EXPECT_TRUE(refused(27, 4));
  EXPECT_TRUE(refused(28, 4));
  EXPECT_TRUE(refused(29, 3));
  EXPECT_TRUE(refused(30, 200));
  EXPECT_TRUE(refused(31, 1)) << "layout 1 is shorter";
  EXPECT_TRUE(refused(31, 3));
  EXPECT_FALSE(decode(std::span<const std::uint8_t>(good).first(k_output_record_bytes - 8)));
  EXPECT_FALSE(decode({}));
  Record not_a_number = good;
  not_a_number[38] = 0xF0;
  not_a_number[39] = 0x7F;
  EXPECT_FALSE(decode(not_a_number));
}

TEST(OutputRecord, RefusesANumberThatIsNotFiniteInAnyPlace) {
  const Record good = encoded(PoseSample{});
  for (std::size_t at = 32; at < k_output_record_bytes; at += 8) {
    for (const double bad :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::quiet_NaN()}) {
      Record record = good;
      put_little_endian(std::span(record).subspan(at, 8), std::bit_cast<std::uint64_t>(bad));
      EXPECT_EQ(decode(record).reason, Reason::out_of_range) << at;
    }
  }
}

// Each record size belongs to exactly one layout.
TEST(OutputRecord, RefusesALayoutOfTheOtherSize) {
  const Record newest = encoded(PoseSample{});
  for (const std::size_t size : {k_output_record_bytes, k_output_record_bytes_1}) {
    for (int layout = 0; layout < 256; ++layout) {
      Record record = newest;
      record[31] = static_cast<std::uint8_t>(layout);
      EXPECT_EQ(static_cast<bool>(decode(std::span<const std::uint8_t>(record).first(size))),
                layout == (size == k_output_record_bytes ? 2 : 1))
          << size << ' ' << layout;
    }
  }
}

// The decoder accepts the last value of each enumeration and rejects the next one.
TEST(OutputRecord, TakesEveryValueOfItsListsAndNoOther) {
  const Record good = encoded(PoseSample{});
  const std::pair<std::size_t, int> lists[] = {
      {24, k_tools_max}, {27, 4}, {28, 4}, {29, 3}, {30, static_cast<int>(k_last_reason) + 1}};
  for (const auto& [at, values] : lists) {
    for (int value = 0; value < 256; ++value) {
      Record record = good;
      record[at] = static_cast<std::uint8_t>(value);
      const auto back = decode(record);
      ASSERT_EQ(static_cast<bool>(back), value < values) << at << ' ' << value;
      if (!back) continue;
      EXPECT_EQ(encoded(back.value), record) << at;
    }
  }
}

TEST(OutputRecord, OfLayout1HasNoSystematicPart) {
  std::mt19937 random(33);
  const PoseSample s = random_sample(random);
  Record record = encoded(s);
  record[31] = 1;
  const auto old = decode(std::span<const std::uint8_t>(record).first(k_output_record_bytes_1));
  ASSERT_TRUE(old);
  EXPECT_EQ(old.value.covariance, s.covariance);
  EXPECT_EQ(old.value.registration_rms_m, s.registration_rms_m);
  EXPECT_TRUE(old.value.systematic.isZero());
}

TEST(ExtendedCount, ContinuesACountBeyondTwoToThe32) {
  constexpr std::uint64_t k_wrap = std::uint64_t{1} << 32;
  std::uint64_t newest = k_wrap - 3;
  for (std::uint64_t count = k_wrap - 2; count < k_wrap + 3; ++count) {
    newest = extended_count(static_cast<std::uint32_t>(count), newest);
    ASSERT_EQ(newest, count);
  }
  EXPECT_EQ(extended_count(0xFFFFFFFF, k_wrap + 1), k_wrap - 1) << "an older one";
  EXPECT_EQ(extended_count(7, 5 * k_wrap), 5 * k_wrap + 7);
  EXPECT_EQ(extended_count(0xFFFFFFFF, 3), 0xFFFFFFFF) << "not below 0";
}

TEST(OutputRecord, KeepsTheLow32BitsOfItsCounts) {
  PoseSample sample;
  sample.tick_number = (std::uint64_t{1} << 32) + 5;
  sample.frame_sequence = (std::uint64_t{3} << 32) + 6;
  const PoseSample back = decode(encoded(sample)).value;
  EXPECT_EQ(back.tick_number, 5u);
  EXPECT_EQ(back.frame_sequence, 6u);
  EXPECT_EQ(extended_count(5, sample.tick_number - 1), sample.tick_number);
}

}  // namespace
}  // namespace glint::output_record_test
