// SPDX-License-Identifier: MIT
//
// Matrices that a factorisation is tried on, the same ones in every run. Eigen's answers come from
// its matrices of any size, in double, so that its factorisations are compiled once for all sizes.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>

namespace matrices {

template <class S, int Size>
struct Case {
    using Scalar = S;
    static constexpr int N = Size;
    using Vector = Eigen::Matrix<S, N, 1>;
    using Matrix = Eigen::Matrix<S, N, N>;
    static constexpr double epsilon = double(std::numeric_limits<S>::epsilon());
};

/// For Eigen's. Not inlined: where the size is known to be 1, g++ 12 warns of Eigen's packets of two.
template <class Derived>
[[gnu::noinline]] Eigen::MatrixXd of_any_size(const Eigen::MatrixBase<Derived>& a) {
    return a.template cast<double>();
}

/// Relative difference of ours to theirs.
template <class Derived>
double difference(const Eigen::MatrixBase<Derived>& ours, const Eigen::MatrixXd& theirs) {
    return (of_any_size(ours) - theirs).norm() / theirs.norm();
}

/// Entries in [-1, 1].
template <class Matrix>
Matrix random(std::mt19937& random) {
    std::uniform_real_distribution<double> entry(-1, 1);
    Matrix result;
    for (int i = 0; i < int(result.size()); ++i) {
        result.data()[i] = typename Matrix::Scalar(entry(random));
    }
    return result;
}

/// Orthogonal.
template <class S, int N>
Eigen::Matrix<S, N, N> axes(std::mt19937& with) {
    const Eigen::MatrixXd any = random<Eigen::Matrix<double, N, N>>(with);
    return Eigen::MatrixXd(any.householderQr().householderQ()).template cast<S>();
}

/// From 1 down to 1/condition, evenly in their logarithm.
template <class S, int N>
Eigen::Matrix<S, N, 1> falling(double condition) {
    Eigen::Matrix<S, N, 1> result;
    for (int i = 0; i < N; ++i) {
        result[i] = S(std::pow(condition, N > 1 ? -double(i) / (N - 1) : 0.0));
    }
    return result;
}

/// Symmetric, of the given eigenvalues along random axes.
template <class S, int N>
Eigen::Matrix<S, N, N> symmetric(const Eigen::Matrix<S, N, 1>& eigenvalues, std::mt19937& with) {
    const Eigen::Matrix<S, N, N> turned = axes<S, N>(with);
    const Eigen::Matrix<S, N, N> result = turned * eigenvalues.asDiagonal() * turned.transpose();
    return (result + result.transpose()) / 2;
}

/// Residual of A x = b in units of ε (|A||x| + |b|), of which a backward stable solution leaves
/// few.
template <class Matrix, class Vector>
double backward_error(const Matrix& a, const Vector& x, const Vector& b) {
    constexpr double epsilon = double(std::numeric_limits<typename Matrix::Scalar>::epsilon());
    const Vector left = a * x - b;
    return double(left.norm()) / (epsilon * double(a.norm() * x.norm() + b.norm()));
}

/// What "few" is, of matrices up to 6×6.
inline constexpr double few = 20;

} // namespace matrices
