// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace ductile::test {

/// Axes whose z, the member's, points along `z`, by the shortest turn. Eigen's FromTwoVectors says the
/// same through a singular value decomposition, which took most of the time to compile of what used it.
inline Eigen::Matrix3d axes_along(const Eigen::Vector3d& z) {
    const Eigen::Vector3d to = z.normalized();
    const double w = std::sqrt((1 + to.z()) / 2);
    if (w < 1e-8) return Eigen::Vector3d(1, -1, -1).asDiagonal(); // half a turn
    return Eigen::Quaterniond(w, -to.y() / (2 * w), to.x() / (2 * w), 0).toRotationMatrix();
}

} // namespace ductile::test
