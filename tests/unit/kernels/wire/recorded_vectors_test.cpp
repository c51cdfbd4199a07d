// Wire formats against recorded check values of an independent implementation, if they are
// available.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "kernels/wire/crc.hpp"
#include "kernels/wire/e2e.hpp"
#include "tests/unit/kernels/wire/hex.hpp"

namespace glint::recorded_vectors_test {
namespace {

using Row = std::vector<std::string>;

std::vector<Row> rows_of(const std::string& name) {
  const char* const folder = std::getenv("GLINT_TEST_DATA");
  std::vector<Row> rows;
  if (folder == nullptr) return rows;
  std::ifstream file(std::string(folder) + "/can/" + name);
  std::string line;
  std::getline(file, line);  // column names
  while (std::getline(file, line)) {
    Row row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  return rows;
}

std::optional<unsigned> crc_named(const std::string& name, std::span<const std::uint8_t> bytes) {
  if (name == "crc8_sae_j1850") return crc8_j1850(bytes);
  if (name == "crc8_h2f") return crc8_h2f(bytes);
  if (name == "crc16_ccitt_false") return crc16_ccitt_false(bytes);
  return {};
}

TEST(RecordedVectors, GiveTheSameChecksums) {
  const auto rows = rows_of("autosar_crc_vectors.csv");
  if (rows.empty()) GTEST_SKIP() << "autosar_crc_vectors.csv is not here";
  int compared = 0;
  for (const Row& row : rows) {
    ASSERT_EQ(row.size(), 3U);
    const auto crc = crc_named(row[0], bytes_of(row[1]));
    if (!crc) continue;
    EXPECT_EQ(*crc, std::stoul(row[2], nullptr, 16)) << row[0] << ' ' << row[1];
    ++compared;
  }
  EXPECT_EQ(compared, 21);
}

bool is_valid(const Row& row) {
  const auto frame = bytes_of(row[5]);
  if (row[0] == "P01") {
    const auto data_id = static_cast<std::uint16_t>(std::stoul(row[1], nullptr, 16));
    const P01Mode mode = row[2] == "BOTH"  ? P01Mode::both
                         : row[2] == "ALT" ? P01Mode::alternating
                         : row[2] == "LOW" ? P01Mode::low
                                           : P01Mode::nibble;
    return check_p01(frame, data_id, mode);
  }
  P02DataIds list{};
  if (row[1] == "00..0F")
    for (std::uint8_t i = 0; i < list.size(); ++i) list[i] = i;
  return check_p02(frame, list);
}

TEST(RecordedVectors, AreJudgedAlike) {
  const auto rows = rows_of("autosar_e2e_vectors.csv");
  if (rows.empty()) GTEST_SKIP() << "autosar_e2e_vectors.csv is not here";
  for (const Row& row : rows) {
    ASSERT_EQ(row.size(), 7U);
    EXPECT_EQ(is_valid(row), row[6][0] == '1') << row[0] << ' ' << row[2] << ' ' << row[5];
  }
  EXPECT_EQ(rows.size(), 16U);
}

}  // namespace
}  // namespace glint::recorded_vectors_test
