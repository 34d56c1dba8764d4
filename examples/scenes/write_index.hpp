// SPDX-License-Identifier: MIT
//
// One page that shows what the scenes left: for each what must come out beside what came out, and
// links to the replays.
#pragma once

#include <filesystem>
#include <vector>

#include "scene.hpp"

namespace ductile::scenes {

struct Shown {
    std::string about, engine;
    Run run;
};

/// Writes index.html into `folder`. @throws std::runtime_error where it cannot be written.
void write_index(const std::vector<Shown>& all, const std::filesystem::path& folder);

} // namespace ductile::scenes
