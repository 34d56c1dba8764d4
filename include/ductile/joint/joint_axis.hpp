// SPDX-License-Identifier: MIT
//
// The six axes of a joint, in the order of JointCapacity: x and y lie in the section, z runs along
// the member.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace ductile {

/// Three forces, then three moments.
enum class JointAxis {
    shear_x,
    shear_y,
    axial,
    bending_x,
    bending_y,
    torsion,
};

inline constexpr std::array all_joint_axes{JointAxis::shear_x,   JointAxis::shear_y,
                                           JointAxis::axial,     JointAxis::bending_x,
                                           JointAxis::bending_y, JointAxis::torsion};

/// 0 ... 5.
[[nodiscard]] constexpr std::size_t index(JointAxis axis) noexcept { return std::size_t(axis); }

/// True where the axis turns and its row is a moment.
[[nodiscard]] constexpr bool turns(JointAxis axis) noexcept {
    return index(axis) >= index(JointAxis::bending_x);
}

[[nodiscard]] constexpr std::string_view to_string(JointAxis axis) noexcept {
    constexpr std::array<std::string_view, 6> names{"shear_x",   "shear_y",   "axial",
                                                    "bending_x", "bending_y", "torsion"};
    return names[index(axis)];
}

} // namespace ductile
