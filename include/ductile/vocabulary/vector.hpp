// SPDX-License-Identifier: MIT
//
// Vectors and matrices of space, and those of motion and force with three linear, then three angular
// entries.
#pragma once

#include <Eigen/Core>
#include <concepts>

namespace ductile {

template <std::floating_point S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <std::floating_point S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;
template <std::floating_point S>
using Vector6 = Eigen::Matrix<S, 6, 1>;
template <std::floating_point S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

} // namespace ductile
