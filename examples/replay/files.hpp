// SPDX-License-Identifier: MIT
//
// Files that are there as a whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace ductile::replay {

/// @throws Error where it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);
/// Beside it first, then renamed. @throws Error where it cannot be written.
void write_file(const std::filesystem::path& file, std::string_view bytes);

} // namespace ductile::replay
