// SPDX-License-Identifier: MIT
//
// Anderson's acceleration of a fixed-point iteration x <- G(x): the next x is the combination of
// the last images that would leave the least of f = G(x) - x if G were affine.
//
//   γ = argmin |f_k - Δf γ|,   x_{k+1} = G(x_k) - ΔG γ,   Δ: differences of consecutive ones
//
// For an affine G it is GMRES, and done after as many steps as G has different directions to
// shrink.
//
// Limit cases: no history: x <- G(x); differences that repeat each other: the combination of least
// size.
//
// Source: Anderson (1965), doi:10.1145/321296.321305; Walker & Ni (2011), doi:10.1137/10078356X.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "ductile/numeric/ldlt.hpp"

namespace ductile::numeric {

/// Not thread-safe. Allocates where x is longer than any before.
class Anderson {
  public:
    /// Forgets: G is another from here on.
    void restart() noexcept {
        kept_ = 0;
        last_ = false;
    }

    /// `x` in: where G was asked, out: where it is to be asked next; `image` = G(x), as long.
    void advance(std::vector<double>& x, const std::vector<double>& image) {
        const std::size_t n = x.size();
        if (x_.size() != n) restart();
        f_.resize(n);
        for (std::size_t i = 0; i < n; ++i) f_[i] = image[i] - x[i];
        if (last_) keep(image);
        x_ = x;
        last_f_ = f_;
        last_image_ = image;
        last_ = true;
        x = image;
        if (kept_ == 0) return;
        Matrix a = Matrix::Zero();
        Vector b = Vector::Zero();
        for (std::size_t i = 0; i < kept_; ++i) {
            for (std::size_t j = 0; j < kept_; ++j)
                a(Eigen::Index(i), Eigen::Index(j)) = dot(df_[i], df_[j]);
            b[Eigen::Index(i)] = dot(df_[i], f_);
        }
        const double ridge = 1e-14 * a.trace(); // differences that repeat each other
        for (std::size_t i = 0; i < kept_; ++i) a(Eigen::Index(i), Eigen::Index(i)) += ridge;
        const Vector gamma = solve_semidefinite<double, int(depth)>(a, b);
        for (std::size_t k = 0; k < kept_; ++k) {
            for (std::size_t i = 0; i < n; ++i) x[i] -= gamma[Eigen::Index(k)] * dg_[k][i];
        }
    }

  private:
    static constexpr std::size_t depth = 5;
    using Matrix = Eigen::Matrix<double, int(depth), int(depth)>;
    using Vector = Eigen::Matrix<double, int(depth), 1>;

    [[nodiscard]] static double dot(const std::vector<double>& a,
                                    const std::vector<double>& b) noexcept {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    }
    void keep(const std::vector<double>& image) {
        if (kept_ == depth) {
            std::rotate(df_.begin(), df_.begin() + 1, df_.end());
            std::rotate(dg_.begin(), dg_.begin() + 1, dg_.end());
            --kept_;
        }
        df_[kept_].resize(f_.size());
        dg_[kept_].resize(f_.size());
        for (std::size_t i = 0; i < f_.size(); ++i) {
            df_[kept_][i] = f_[i] - last_f_[i];
            dg_[kept_][i] = image[i] - last_image_[i];
        }
        ++kept_;
    }

    std::array<std::vector<double>, depth> df_, dg_;
    std::vector<double> f_, x_, last_f_, last_image_;
    std::size_t kept_ = 0;
    bool last_ = false;
};

} // namespace ductile::numeric
