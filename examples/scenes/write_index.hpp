// SPDX-License-Identifier: MIT
//
// One page that shows what the scenes left: for each its picture in the gallery, what must come out
// beside what came out, what its World does not vouch for, and links to the replays. The Charpy
// test is on it where run.sh left it.
#pragma once

#include <filesystem>
#include <vector>

#include "scene.hpp"

namespace ductile::scenes {

struct Shown {
    std::string about, engine;
    Run run;
};

/// Writes index.html into `folder`; what it has of other scenes stays. Of nothing: leaves none.
/// @throws std::runtime_error where it cannot be written.
void write_index(const std::vector<Shown>& all, const std::filesystem::path& folder);

} // namespace ductile::scenes
