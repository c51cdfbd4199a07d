// The bytes that output_sha256 is taken over: one record for each tool and tick.
//
// What:     PoseSample <-> 616 bytes, little endian, no padding.
//   at  size  field                              at  size  field
//    0   8    tick, ns                           32  3x8   translation x,y,z, m
//    8   8    measurement, ns                    56  4x8   rotation x,y,z,w
//   16   4    tick number *                      88  3x8   velocity, m/s
//   20   4    frame sequence *                  112  3x8   angular velocity, rad/s
//   24   1    tool                              136 36x8   covariance, row after row
//   25   1    marker mask                       424   8    sigma position, m
//   26   1    buttons                           432   8    sigma orientation, rad
//   27   1    track state                       440   8    registration rms, m
//   28   1    registration state
//   29   1    reference frame
//   30   1    reason
//   31   1    layout, k_output_record_layout     448 21x8   systematic covariance, lower half, row
//                                                         after row
//   * The low 32 bits: a reader extends them (extended_count in bits.hpp).
//   Doubles are IEEE 754 binary64; -0.0 is written as +0.0 and what is not finite as +0.0 (the core
//   makes neither NaN nor infinity; a record could not be compared with one in it).
//   CAN payloads are not inside, for they follow from a record and the cell file.
// Cost:     616 bytes moved.
// Worst:    the same for every sample.
// Accuracy: exact, but for the signs of zeros.
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

// Of layout 1 or 2. Reason::out_of_range: another layout or size, a state that is not in its list,
// or a number that is not finite; that is, no record of ours.
[[nodiscard]] Result<PoseSample> decode(std::span<const std::uint8_t> record) noexcept;

}  // namespace glint
