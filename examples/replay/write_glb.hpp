// SPDX-License-Identifier: MIT
//
// A recording as glTF 2.0, one file (.glb): a node a body, its shapes below it, one animation.
// Opens in Blender, Godot, three.js. Joints, energies and events are not in it.
#pragma once

#include <filesystem>

#include "recording.hpp"

namespace ductile::replay {

/// z is up in a recording and y in glTF: all stands under one node that turns it.
/// @throws Error where the recording is empty, or the file cannot be written; nothing is left
/// half-written.
void write_glb(const Recording& recording, const std::filesystem::path& file);

} // namespace ductile::replay
