// SPDX-License-Identifier: MIT
//
// Bodies of shifted_lcp.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ductile/bullet/shifted_lcp.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

DUCTILE_INLINE bool ShiftedLcp::solveMLCP(const btMatrixXu& a, const btVectorXu& b, btVectorXu& x,
                                          const btVectorXu& lower, const btVectorXu& upper,
                                          const btAlignedObjectArray<int>& limit_dependency,
                                          int iterations, bool use_sparsity) {
    const int n = b.rows();
    if (n == 0) return true;
    for (btVectorXu* v : {&shift_, &pushed_, &answer_x_}) v->resize(n);
    find_open_rows(lower, upper, limit_dependency);
    for (int i = 0; i < n; ++i) {
        shift_[i] = limit_dependency[i] < 0 ? clamped(0, lower[i], upper[i]) : btScalar(0);
        answer_x_[i] = shift_[i];
    }
    if (!open_.empty() &&
        !solve_open(a, b, x, lower, upper, limit_dependency, iterations, use_sparsity)) {
        return false;
    }
    if (answer_ == Answer::exact && !settle(a, b, lower, upper, limit_dependency)) return false;
    for (int i = 0; i < n; ++i) x[i] = answer_x_[i];
    return true;
}

DUCTILE_INLINE void ShiftedLcp::find_open_rows(const btVectorXu& lower, const btVectorXu& upper,
                                               const btAlignedObjectArray<int>& limit_dependency) {
    const int n = lower.rows();
    place_.assign(std::size_t(n), closed);
    for (int i = 0; i < n; ++i) {
        const int on = limit_dependency[i];
        if (on >= 0) place_[std::size_t(on)] = 0;
        if (on >= 0 || lower[i] < upper[i]) place_[std::size_t(i)] = 0;
    }
    open_.clear();
    for (int i = 0; i < n; ++i) {
        if (place_[std::size_t(i)] == closed) continue;
        place_[std::size_t(i)] = int(open_.size());
        open_.push_back(i);
    }
}

DUCTILE_INLINE bool ShiftedLcp::solve_open(const btMatrixXu& a, const btVectorXu& b,
                                           const btVectorXu& x, const btVectorXu& lower,
                                           const btVectorXu& upper,
                                           const btAlignedObjectArray<int>& limit_dependency,
                                           int iterations, bool use_sparsity) {
    const int m = int(open_.size());
    multiply(a, shift_, pushed_);
    const btScalar unit = impulse_unit(a, b, x);
    for (btVectorXu* v : {&b_, &x_, &lower_, &upper_}) v->resize(m);
    dependency_.resizeNoInitialize(m);
    for (int k = 0; k < m; ++k) {
        const int i = open_[std::size_t(k)];
        const int on = limit_dependency[i];
        b_[k] = (b[i] - pushed_[i]) / unit;
        x_[k] = (x[i] - shift_[i]) / unit;
        lower_[k] = on < 0 ? scaled(lower[i] - shift_[i], unit) : lower[i];
        upper_[k] = on < 0 ? scaled(upper[i] - shift_[i], unit) : upper[i];
        dependency_[k] = on < 0 ? on : place_[std::size_t(on)];
    }
    if (!inner_->solveMLCP(m == b.rows() ? a : open_part(a), b_, x_, lower_, upper_, dependency_,
                           iterations, use_sparsity)) {
        return false;
    }
    for (int k = 0; k < m; ++k) {
        const int i = open_[std::size_t(k)];
        const btScalar impulse = shift_[i] + unit * x_[k];
        if (!std::isfinite(impulse)) return false;
        answer_x_[i] = limit_dependency[i] < 0 ? clamped(impulse, lower[i], upper[i]) : impulse;
    }
    return true;
}

DUCTILE_INLINE const btMatrixXu& ShiftedLcp::open_part(const btMatrixXu& a) {
    const int m = int(open_.size());
    open_a_.resize(m, m);
    for (int row = 0; row < m; ++row) {
        for (int column = 0; column < m; ++column) {
            open_a_.setElem(row, column, a(open_[std::size_t(row)], open_[std::size_t(column)]));
        }
    }
    return open_a_;
}

DUCTILE_INLINE btScalar ShiftedLcp::clamped(btScalar value, btScalar lower,
                                            btScalar upper) noexcept {
    return std::min(std::max(value, lower), upper);
}

DUCTILE_INLINE btScalar ShiftedLcp::scaled(btScalar bound, btScalar unit) noexcept {
    return clamped(std::abs(bound) < SIMD_INFINITY ? bound / unit : bound, -SIMD_INFINITY,
                   SIMD_INFINITY);
}

DUCTILE_INLINE void ShiftedLcp::multiply(const btMatrixXu& a, const btVectorXu& x,
                                         btVectorXu& result) {
    const int n = x.rows();
    for (int i = 0; i < n; ++i) result[i] = 0;
    for (int j = 0; j < n; ++j) {
        if (x[j] == 0) continue;
        for (int i = 0; i < n; ++i) result[i] += a(i, j) * x[j];
    }
}

DUCTILE_INLINE btScalar ShiftedLcp::impulse_unit(const btMatrixXu& a, const btVectorXu& b,
                                                 const btVectorXu& x) const {
    btScalar largest = 0;
    for (int i = 0; i < b.rows(); ++i) {
        const btScalar alone = a(i, i) > 0 ? std::abs(b[i] - pushed_[i]) / a(i, i) : btScalar(0);
        largest = std::max({largest, alone, std::abs(x[i] - shift_[i])});
    }
    if (!(largest > 0) || !std::isfinite(largest)) return 1;
    return std::ldexp(btScalar(1), std::ilogb(largest));
}

DUCTILE_INLINE bool ShiftedLcp::settle(const btMatrixXu& a, const btVectorXu& b,
                                       const btVectorXu& lower, const btVectorXu& upper,
                                       const btAlignedObjectArray<int>& limit_dependency) {
    multiply(a, answer_x_, pushed_);
    btScalar most = 0, scale = 0;
    for (int i = 0; i < b.rows(); ++i) {
        scale = std::max(scale, std::abs(b[i]));
        for (int j = 0; j < b.rows(); ++j) {
            if (i != j) scale = std::max(scale, std::abs(a(i, j) * answer_x_[j]));
        }
        if (limit_dependency[i] >= 0 || !(a(i, i) > 0)) continue;
        if (lower[i] < answer_x_[i] && answer_x_[i] < upper[i]) {
            scale = std::max(scale, std::abs(a(i, i) * answer_x_[i]));
        }
        const btScalar optimum = answer_x_[i] - (pushed_[i] - b[i]) / a(i, i);
        pushed_[i] = clamped(optimum, lower[i], upper[i]);
        most = std::max(most, std::abs(pushed_[i] - answer_x_[i]) * a(i, i));
    }
    if (!(most <= lcp_acceptance<btScalar> * scale)) return false;
    for (int i = 0; i < b.rows(); ++i) {
        if (limit_dependency[i] >= 0 || !(a(i, i) > 0)) continue;
        if (pushed_[i] == lower[i] || pushed_[i] == upper[i]) answer_x_[i] = pushed_[i];
    }
    return true;
}

} // namespace ductile::bullet
