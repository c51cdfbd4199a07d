#include "platform/sinks/record/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "platform/sinks/record/bytes.hpp"

namespace glint {
namespace {

std::string hash_of(std::string_view text) {
  Sha256 hash;
  hash.add(bytes_of(text));
  return hash.hex();
}

// Test vectors of FIPS 180-4 (SHA256.pdf, SHA_All.pdf).
TEST(Sha256, GivesTheDigestsOfTheStandard) {
  EXPECT_EQ(hash_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash_of(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheBytesAreCut) {
  const std::string text(200, 'x');
  for (std::size_t first = 0; first <= text.size(); ++first) {
    Sha256 hash;
    hash.add(bytes_of(text).first(first));
    (void)hash.digest();
    hash.add(bytes_of(text).subspan(first));
    ASSERT_EQ(hash.hex(), hash_of(text)) << "cut at " << first;
  }
}

TEST(Sha256, EndsAtEveryLengthWithinABlock) {
  std::vector<std::string> hashes;
  for (std::size_t length = 0; length < 130; ++length)
    hashes.push_back(hash_of(std::string(length, '\0')));
  EXPECT_EQ(hashes[55], "02779466cdec163811d078815c633f21901413081449002f24aa3e80f0b88ef7");
  EXPECT_EQ(hashes[56], "d4817aa5497628e7c77e6b606107042bbba3130888c5f47a375e6179be789fbb");
  EXPECT_EQ(hashes[64], "f5a5fd42d16a20302798ef6ed309979b43003d2320d9f0e8ea9831a92759fb4b");
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

}  // namespace
}  // namespace glint
