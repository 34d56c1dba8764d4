// SPDX-License-Identifier: MIT
//
// A recording as bytes, small enough to travel inside a page: a gzip stream of
//
//   "ductrec4"  8 bytes
//   length      of the text that follows, 4 bytes, little-endian
//   text        JSON: what does not change, the times, and of each column its `low`, `step`,
//               `order`
//   low bytes   of all samples, column by column
//   high bytes  likewise
//
// A column is quantised to 65535 values over its range, value = low + step q, q = 65535 where it is
// not a number; then the difference to the sample before (order 1), or (order 2) to the straight
// line through the two before, as a zigzag of 16 bits. Turns have the range -1 ... 1, all other
// columns their own, but for the life used, 0 ... 1. A certificate is kept to a 254th of its range,
// but to no less than 1e-9: below that it is round-off, which takes more room than all else. What
// does not change has order 0, its value in `low` (null: not a number), and no samples.
//
// Columns, in order: of each body that moves x, y, z, w, x, y, z; of each joint utilisation,
// plastic travel, absorbed, residual, state, life, force, position; the energies; the hashes' low
// and high halves.
#pragma once

#include <string>

#include "recording.hpp"

namespace ductile::replay {

/// What is above, not yet zipped. @throws Error where the recording does not hold together
/// (`check`).
[[nodiscard]] std::string laid_down(const Recording& recording);
/// Zipped; throws likewise.
[[nodiscard]] std::string pack(const Recording& recording);

} // namespace ductile::replay
