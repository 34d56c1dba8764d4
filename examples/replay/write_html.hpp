// SPDX-License-Identifier: MIT
//
// A recording as one page that opens from disk, without a network: the replay page, which is built
// from page/, with the packed recording inside.
#pragma once

#include <filesystem>

#include "recording.hpp"

namespace ductile::replay {

/// @param page  the replay page as built; by default the one of this build
/// @throws Error where the recording is empty, there is no page, or the file cannot be written;
/// nothing is left half-written.
void write_html(const Recording& recording, const std::filesystem::path& file,
                const std::filesystem::path& page = {});

} // namespace ductile::replay
