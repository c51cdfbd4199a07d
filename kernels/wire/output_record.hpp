// Serialisation of a PoseSample to the output record, one for each tool and tick; output_sha256 is
// the hash of these bytes.
//
// What:     PoseSample <-> 616 bytes, little endian, no padding.
//   at  size  field                              at  size  field
//    0   8    tick, ns                           32  3x8   translation x,y,z, m
//    8   8    measurement, ns                    56  4x8   rotation x,y,z,w
//   16   4    tick number *                      88  3x8   velocity, m/s
//   20   4    frame sequence *                  112  3x8   angular velocity, rad/s
//   24   1    tool                              136 36x8   covariance, row by row
//   25   1    marker mask                       424   8    sigma position, m
//   26   1    buttons                           432   8    sigma orientation, rad
//   27   1    track state                       440   8    registration rms, m
//   28   1    registration state
//   29   1    reference frame
//   30   1    reason
//   31   1    layout, k_output_record_layout     448 21x8   systematic covariance, lower half, row
//                                                         by row
//   * The low 32 bits: a reader extends them (extended_count in bits.hpp).
//   Doubles are IEEE 754 binary64. -0.0 and non-finite values are written as +0.0. (The core
//   produces neither NaN nor infinity; a record with one could not be compared.)
//   CAN payloads are not included, because they follow from a record and the cell file.
// Cost:     616 bytes moved.
// Worst:    data independent.
// Accuracy: exact, except for the sign of zero.
// Source:   the layout is Glint's own. A change of it gets a new layout number. Layout 1
//           ends before the systematic covariance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/result.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

inline constexpr std::size_t k_output_record_bytes = 616;
inline constexpr std::uint8_t k_output_record_layout = 2;
inline constexpr std::size_t k_output_record_bytes_1 = 448;  // of layout 1

void encode(const PoseSample& sample,
            std::span<std::uint8_t, k_output_record_bytes> record) noexcept;

// Decodes layout 1 or 2. Returns Reason::out_of_range for another layout or size, an unknown
// enumerator or tool, or a number that is not finite.
[[nodiscard]] Result<PoseSample> decode(std::span<const std::uint8_t> record) noexcept;

}  // namespace glint
