// SPDX-License-Identifier: MIT
//
// Vectors and matrices of space, and those of motion and force with three linear, then three
// angular entries.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace ductile {

template <std::floating_point S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <std::floating_point S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;
template <std::floating_point S>
using Vector6 = Eigen::Matrix<S, 6, 1>;
template <std::floating_point S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

// ---- plain functions
//
// The same as Eigen's expressions, by value, and each compiled once: every further shape of an
// expression costs whoever includes this library some hundredths of a second.

template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline S dot(const Vector3<S>& a, const Vector3<S>& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <std::floating_point S>
[[nodiscard]] inline S norm(const Vector3<S>& v) noexcept {
    return std::sqrt(dot(v, v));
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> sum(const Vector3<S>& a,
                                                        const Vector3<S>& b) noexcept {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> difference(const Vector3<S>& a,
                                                               const Vector3<S>& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> scaled(std::type_identity_t<S> factor,
                                                           const Vector3<S>& v) noexcept {
    return {factor * v[0], factor * v[1], factor * v[2]};
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> cross(const Vector3<S>& a,
                                                          const Vector3<S>& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <std::floating_point S>
[[nodiscard]] inline bool is_zero(const Vector3<S>& v) noexcept {
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}
/// True where every entry is finite, without a branch.
template <std::floating_point S, int Rows, int Columns>
[[nodiscard]] inline bool is_finite(const Eigen::Matrix<S, Rows, Columns>& m) noexcept {
    S zero = 0;
    for (int i = 0; i < Rows * Columns; ++i) zero += m.data()[i] * 0;
    return zero == 0;
}

/// Column i of m.
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> column(const Matrix3<S>& m, int i) noexcept {
    return {m(0, i), m(1, i), m(2, i)};
}
/// m v
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> times(const Matrix3<S>& m,
                                                          const Vector3<S>& v) noexcept {
    return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2],
            m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
            m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}
/// mᵀ v
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> transposed_times(const Matrix3<S>& m,
                                                                     const Vector3<S>& v) noexcept {
    return {m(0, 0) * v[0] + m(1, 0) * v[1] + m(2, 0) * v[2],
            m(0, 1) * v[0] + m(1, 1) * v[1] + m(2, 1) * v[2],
            m(0, 2) * v[0] + m(1, 2) * v[1] + m(2, 2) * v[2]};
}
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> transposed(const Matrix3<S>& m) noexcept {
    Matrix3<S> result;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) result(i, j) = m(j, i);
    }
    return result;
}
/// a b
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> times(const Matrix3<S>& a, const Matrix3<S>& b) noexcept {
    Matrix3<S> result;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            result(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
        }
    }
    return result;
}
/// a bᵀ
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> times_transposed(const Matrix3<S>& a,
                                                 const Matrix3<S>& b) noexcept {
    Matrix3<S> result;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            result(i, j) = a(i, 0) * b(j, 0) + a(i, 1) * b(j, 1) + a(i, 2) * b(j, 2);
        }
    }
    return result;
}
/// aᵀ b
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> transposed_times(const Matrix3<S>& a,
                                                 const Matrix3<S>& b) noexcept {
    Matrix3<S> result;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            result(i, j) = a(0, i) * b(0, j) + a(1, i) * b(1, j) + a(2, i) * b(2, j);
        }
    }
    return result;
}
/// a b aᵀ: what b is seen along axes that a turns it to.
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> sandwiched(const Matrix3<S>& a, const Matrix3<S>& b) noexcept {
    return times_transposed(times(a, b), a);
}
/// a diag(d) aᵀ, exactly symmetric.
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> sandwiched(const Matrix3<S>& a,
                                           const Vector3<S>& diagonal) noexcept {
    Matrix3<S> result;
    for (int i = 0; i < 3; ++i) {
        const S x = a(i, 0) * diagonal[0], y = a(i, 1) * diagonal[1], z = a(i, 2) * diagonal[2];
        for (int j = 0; j <= i; ++j) {
            result(i, j) = result(j, i) = x * a(j, 0) + y * a(j, 1) + z * a(j, 2);
        }
    }
    return result;
}
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> sum(const Matrix3<S>& a, const Matrix3<S>& b) noexcept {
    Matrix3<S> result;
    for (int i = 0; i < 9; ++i) result.data()[i] = a.data()[i] + b.data()[i];
    return result;
}
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> difference(const Matrix3<S>& a, const Matrix3<S>& b) noexcept {
    Matrix3<S> result;
    for (int i = 0; i < 9; ++i) result.data()[i] = a.data()[i] - b.data()[i];
    return result;
}
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> scaled(std::type_identity_t<S> factor,
                                       const Matrix3<S>& m) noexcept {
    Matrix3<S> result;
    for (int i = 0; i < 9; ++i) result.data()[i] = factor * m.data()[i];
    return result;
}
/// [v]ₓ, so that [v]ₓ w = v × w.
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> skew(const Vector3<S>& v) noexcept {
    Matrix3<S> result = Matrix3<S>::Zero();
    result(0, 1) = -v[2];
    result(0, 2) = v[1];
    result(1, 0) = v[2];
    result(1, 2) = -v[0];
    result(2, 0) = -v[1];
    result(2, 1) = v[0];
    return result;
}

/// First and last three of six: force and moment, velocity and turning.
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> linear(const Vector6<S>& six) noexcept {
    return {six[0], six[1], six[2]};
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> angular(const Vector6<S>& six) noexcept {
    return {six[3], six[4], six[5]};
}
template <std::floating_point S>
[[nodiscard, gnu::always_inline]] inline Vector6<S> twist_of(const Vector3<S>& linear,
                                                             const Vector3<S>& angular) noexcept {
    Vector6<S> result;
    for (int i = 0; i < 3; ++i) {
        result[i] = linear[i];
        result[3 + i] = angular[i];
    }
    return result;
}
template <std::floating_point S>
[[nodiscard]] inline S dot(const Vector6<S>& a, const Vector6<S>& b) noexcept {
    S result = 0;
    for (int i = 0; i < 6; ++i) result += a[i] * b[i];
    return result;
}
/// The 3×3 block of m whose first entry is (row, column).
template <std::floating_point S>
[[nodiscard]] inline Matrix3<S> block(const Matrix6<S>& m, int row, int column) noexcept {
    Matrix3<S> result;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) result(i, j) = m(row + i, column + j);
    }
    return result;
}
template <std::floating_point S>
inline void set_block(Matrix6<S>& m, int row, int column, const Matrix3<S>& block) noexcept {
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) m(row + i, column + j) = block(i, j);
    }
}

} // namespace ductile
