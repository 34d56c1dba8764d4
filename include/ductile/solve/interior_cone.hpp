// SPDX-License-Identifier: MIT
//
// A block on its way through the interior (interior_point.hpp), as a second-order cone: an
// ellipsoid and a contact alike.
//
//   s = A x,   s0 >= |s1|     ellipsoid: s = (1, x/P),   contact: s = (n, t/f)
//   r + Aᵀ z = 0,   z0 >= |z1|,   s∘z = τ c (1, 0),   a∘b = (a·b, a0 b1 + b0 a1)
//
// With the scaling of Nesterov and Todd, λ = W z = W⁻¹ s, a step is
//
//   dz = p - H ds,   H = W⁻² = (2 (w0, -w1)(w0, -w1)ᵀ - diag(1, -1, ...))/η²
//   p = -z + τ c s⁻¹ - W⁻¹ (λ \ (W⁻¹ ds)∘(W dz)),   the last from the predictor
//
// and the tangent of the rows (C + Aᵀ H A)⁻¹, by the block's form. Newton's own step with the
// constraint as |x/P|² <= 1 does not see how it is curved: near a limit load, where forces move
// along a surface at next to no cost, it goes in circles.
//
// Symbols as in interior_point.hpp.
//
// Source: Nesterov & Todd (1997), doi:10.1287/moor.22.1.1; Vandenberghe (2010), The CVXOPT linear
// and quadratic cone program solvers, section 4.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ductile/solve/block_form.hpp"

namespace ductile::solve {

/// One block. Plain value.
class InteriorCone {
  public:
    /// Where it begins, in the middle; closed where it is too small to matter.
    void open(const BlockView& v, double scale) noexcept {
        first_ = v.block.kind == BlockKind::contact ? 0 : 1;
        size_ = v.count() + first_;
        for (int k = 0; k < v.count(); ++k) a_[std::size_t(k + first_)] = share(v, k);
        const double multiplier = with_form(v, [&](auto form) { return form.open(v, scale); });
        open_ = multiplier > 0;
        z_.fill(0);
        z_[0] = multiplier;
        look(v);
        cap_ = product_after(0) * (open_ ? 1 / scale : 1);
    }
    [[nodiscard]] bool is_open() const noexcept { return open_; }

    /// Reads s.
    void look(const BlockView& v) noexcept {
        s_.fill(0);
        s_[0] = 1;
        for (int k = 0; k < v.count(); ++k) at(s_, k) = at(a_, k) * v.row[k].impulse;
    }
    /// r + Aᵀ z of a row [m/s | rad/s].
    [[nodiscard]] double left(const BlockView& v, int row) const noexcept {
        const double a = at(a_, row);
        return a > 0 ? v.work[row].residual + a * at(z_, row) : 0;
    }
    /// s·z over c [m/s].
    [[nodiscard]] double product() const noexcept { return product_after(0) / cap_; }
    [[nodiscard]] double product_after(double share) const noexcept {
        double sum = 0;
        for (std::size_t k = 0; k < std::size_t(size_); ++k) {
            sum += (s_[k] + share * ds_[k]) * (z_[k] + share * dz_[k]);
        }
        return sum;
    }
    [[nodiscard]] double cap() const noexcept { return cap_; }

    void set_tangent(const BlockView& v) noexcept {
        ds_.fill(0);
        dz_.fill(0);
        scale();
        with_form(v, [&](auto form) { form.set_cone_tangent(v, 1 / (eta_ * eta_), w_.data()); });
    }
    /// Towards a product of `target` c; `second`: with what the predictor left out.
    void set_right(const BlockView& v, double target, bool second) noexcept {
        const double inverse = target * cap_ / determinant(s_);
        for (std::size_t k = 0; k < std::size_t(size_); ++k) {
            p_[k] = (k == 0 ? inverse : -inverse) * s_[k] - z_[k];
        }
        if (second) {
            const Vector left_out =
                scaled(divided(times(scaled(ds_first_, -1), scaled(dz_first_, 1))), -1);
            for (std::size_t k = 0; k < std::size_t(size_); ++k) p_[k] -= left_out[k];
        }
        for (int k = 0; k < v.count(); ++k) {
            const double a = at(a_, k);
            v.work[k].right = a > 0 ? v.work[k].residual + a * (at(z_, k) + at(p_, k)) : 0;
        }
    }
    /// Changes of s and z for that of the rows.
    void follow(const BlockView& v) noexcept {
        ds_[0] = 0;
        for (int k = 0; k < v.count(); ++k) at(ds_, k) = at(a_, k) * v.work[k].change;
        for (int k = 0; k < v.count(); ++k) { // H ds as the rows' equation has it
            const IslandSystem::Row& row = v.work[k];
            const double a = at(a_, k), h = row.rest - row.compliance * row.change;
            at(dz_, k) = a > 0 ? at(p_, k) - h / a : 0;
        }
        if (first_ == 0) return;
        double along = 0, of_normal = 0; // w·D, whose digits are lost in D's
        const Vector6<double>& normal = v.tangent.terms[0].direction;
        for (int k = 0; k < v.count(); ++k) {
            along += normal[k] * v.work[k].rest;
            of_normal += normal[k] * at(w_, k) * at(a_, k);
        }
        const double h = 1 / (eta_ * eta_);
        dz_[0] = p_[0] + 2 * h * w_[0] * along / (1 + 2 * h * of_normal);
    }
    void keep_predictor() noexcept {
        ds_first_ = ds_;
        dz_first_ = dz_;
    }
    /// Share of the changes that reaches the boundary.
    [[nodiscard]] double reach() const noexcept { return std::min(reach(s_, ds_), reach(z_, dz_)); }
    void move(double share) noexcept {
        for (std::size_t k = 0; k < std::size_t(size_); ++k) z_[k] += share * dz_[k];
    }
    void tell(const BlockView& v) const noexcept {
        with_form(v, [&](auto form) { form.tell(v, open_, z_[0]); });
    }

  private:
    using Vector = std::array<double, 7>;

    [[nodiscard]] static double share(const BlockView& v, int row) noexcept {
        if (v.block.kind == BlockKind::contact && row == 0) return v.work[0].own > 0 ? 1 : 0;
        return v.live(row) ? 1 / v.size(row) : 0;
    }
    [[nodiscard]] double& at(Vector& x, int row) const noexcept {
        return x[std::size_t(row + first_)];
    }
    [[nodiscard]] const double& at(const Vector& x, int row) const noexcept {
        return x[std::size_t(row + first_)];
    }
    /// x0² - |x1|².
    [[nodiscard]] double determinant(const Vector& x) const noexcept {
        constexpr double round_off = 1e-15;
        double square = 0;
        for (std::size_t k = 1; k < std::size_t(size_); ++k) square += x[k] * x[k];
        const double length = std::sqrt(square);
        return std::max(x[0] - length, round_off * x[0]) * (x[0] + length);
    }
    /// w, η and λ.
    void scale() noexcept {
        const double of_s = std::sqrt(determinant(s_)), of_z = std::sqrt(determinant(z_));
        double along = 0;
        for (std::size_t k = 0; k < std::size_t(size_); ++k) along += s_[k] * z_[k];
        const double gamma = std::sqrt((1 + along / (of_s * of_z)) / 2);
        w_.fill(0);
        for (std::size_t k = 0; k < std::size_t(size_); ++k) {
            w_[k] = (s_[k] / of_s + (k == 0 ? 1 : -1) * z_[k] / of_z) / (2 * gamma);
        }
        eta_ = std::sqrt(of_s / of_z);
        lambda_ = scaled(z_, 1);
    }
    /// W x, or W⁻¹ x where `way` is -1.
    [[nodiscard]] Vector scaled(const Vector& x, int way) const noexcept {
        const double factor = way > 0 ? eta_ : 1 / eta_;
        double along = 0;
        for (std::size_t k = 1; k < std::size_t(size_); ++k) along += w_[k] * x[k];
        const double across = way * x[0] + along / (1 + w_[0]);
        Vector result{};
        result[0] = factor * (w_[0] * x[0] + way * along);
        for (std::size_t k = 1; k < std::size_t(size_); ++k) {
            result[k] = factor * (x[k] + across * w_[k]);
        }
        return result;
    }
    [[nodiscard]] Vector times(const Vector& a, const Vector& b) const noexcept {
        Vector result{};
        for (std::size_t k = 0; k < std::size_t(size_); ++k) {
            result[0] += a[k] * b[k];
            if (k > 0) result[k] = a[0] * b[k] + b[0] * a[k];
        }
        return result;
    }
    /// λ \ q.
    [[nodiscard]] Vector divided(const Vector& q) const noexcept {
        double along = lambda_[0] * q[0];
        for (std::size_t k = 1; k < std::size_t(size_); ++k) along -= lambda_[k] * q[k];
        Vector result{};
        result[0] = along / determinant(lambda_);
        for (std::size_t k = 1; k < std::size_t(size_); ++k) {
            result[k] = (q[k] - result[0] * lambda_[k]) / lambda_[0];
        }
        return result;
    }
    /// Largest t with x + t dx in the cone.
    [[nodiscard]] double reach(const Vector& x, const Vector& dx) const noexcept {
        double a = dx[0] * dx[0], b = x[0] * dx[0]; // a t² + 2 b t + c >= 0
        for (std::size_t k = 1; k < std::size_t(size_); ++k) {
            a -= dx[k] * dx[k];
            b -= x[k] * dx[k];
        }
        const double c = determinant(x), inside = b * b - a * c;
        double share = std::numeric_limits<double>::infinity();
        if (inside >= 0 && (a < 0 || b < 0)) {
            const double root = std::sqrt(inside);
            share = b > 0 ? (b + root) / -a : c / (root - b);
        }
        return dx[0] < 0 ? std::min(share, x[0] / -dx[0]) : share;
    }

    bool open_ = false;
    int first_ = 0, size_ = 0; ///< component of the first row; components
    double cap_ = 1, eta_ = 1; ///< c, η
    Vector a_{}, s_{}, z_{};   ///< A, s, z
    Vector w_{}, lambda_{};    ///< of the scaling
    Vector p_{}, ds_{}, dz_{}, ds_first_{}, dz_first_{};
};

} // namespace ductile::solve
