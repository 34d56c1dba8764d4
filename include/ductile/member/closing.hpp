// SPDX-License-Identifier: MIT
//
// When sections that are open close.
#pragma once

namespace ductile {

/// Where one held for long enough, or all that hold.
enum class Closing { after_step, before_blow };

} // namespace ductile
