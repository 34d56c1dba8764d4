// SPDX-License-Identifier: MIT
//
// Bodies of interior_point.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/solve/block_form.hpp"
#include "ductile/solve/interior_point.hpp"

namespace ductile::solve {

DUCTILE_INLINE void InteriorPoint::solve(IslandSystem& system, bool contacts_held) {
    constexpr int most = 60;
    // of residual and gap; where no active set polishes it, as far as it goes
    const double enough = contacts_held ? 1e-12 : 1e-10;
    constexpr double least_share = 1e-10; // of a step: no more is to be had
    system_ = &system;
    contacts_held_ = contacts_held;
    iterations_ = 0;
    start();
    std::vector<IslandRow>& given = system.island().rows;
    const auto keep = [&] {
        best_.clear();
        for (const IslandRow& row : given) best_.push_back(row.impulse);
    };
    double best = std::numeric_limits<double>::infinity();
    int worse = 0;
    while (iterations_ < most) {
        const Left left = look();
        const double merit = std::max(left.residual, left.gap) / system.scale();
        if (std::isnan(left.residual) || std::isnan(left.gap)) break;
        if (merit < best) {
            best = merit;
            keep();
            worse = 0;
        } else if (++worse >= (best < 1e-6 ? 2 : 10)) {
            break;
        }
        if (merit <= enough) break;
        ++iterations_;
        set_weights();
        if (!system.factor()) break;
        const double first = std::min(1.0, direct(0, false));
        const double after = mean_after(first, left.products);
        const double ratio = left.mean > 0 ? std::clamp(after / left.mean, 0.0, 1.0) : 0;
        keep_predictor();
        const double target = std::max(ratio * ratio * ratio, 1e-6) * left.mean;
        double share = direct(target, true);
        if (share < 0.1 * first || share < 0.05)
            share = direct(std::max(target, 0.1 * left.mean), false);
        const double step = std::min(1.0, (1 - std::clamp(0.1 * ratio, 1e-3, 0.1)) * share);
        if (!(step > least_share)) break;
        move(step);
    }
    for (std::size_t i = 0; i < given.size(); ++i) given[i].impulse = best_[i];
    system.update_velocities();
    system.update_residuals();
    tell_sides();
}

DUCTILE_INLINE void InteriorPoint::start() {
    constexpr double narrow = 1e-9; // of what a row would do with the largest velocity: given
    Island& island = system_->island();
    const double scale = system_->scale();
    rows_.assign(island.rows.size(), {});
    blocks_.assign(island.blocks.size(), {});
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        IslandRow& given = island.rows[i];
        Row& row = rows_[i];
        const double own = system_->rows()[i].own;
        if (!system_->alone(i) || own == 0) {
            given.impulse = 0;
            continue;
        }
        row.below = std::isfinite(given.lower);
        row.above = std::isfinite(given.upper);
        const double least = scale / own;
        if (row.below && row.above) {
            given.impulse = (given.lower + given.upper) / 2;
            if (!(given.upper - given.lower > narrow * least)) continue;
        } else if (row.below) {
            given.impulse = std::max(given.impulse, given.lower + least);
        } else if (row.above) {
            given.impulse = std::min(given.impulse, given.upper - least);
        }
        row.open = true;
        row.z_lower = row.below ? scale : 0;
        row.z_upper = row.above ? scale : 0;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const BlockView view = view_of(*system_, k);
        if (held(view.block)) continue;
        Block& block = blocks_[k];
        block.multiplier = with_form(view, [&](auto form) { return form.open(view, scale); });
        block.open = block.multiplier > 0;
        if (!block.open) continue;
        block.slack = with_form(view, [&](auto form) { return form.slack(view); });
        block.cap = block.multiplier * block.slack / scale;
    }
}

DUCTILE_INLINE auto InteriorPoint::look() -> Left {
    Island& island = system_->island();
    system_->update_velocities();
    system_->update_residuals();
    Left left;
    double sum = 0;
    const auto see_residual = [&left](double r) {
        if (!(std::abs(r) <= left.residual)) left.residual = std::abs(r);
    };
    const auto see_product = [&](double product) {
        sum += product;
        ++left.products;
        if (!(product <= left.gap)) left.gap = product;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        if (!row.open) continue;
        const IslandRow& given = island.rows[i];
        const IslandSystem::Row& work = system_->rows()[i];
        row.cap = row.below && row.above ? given.upper - given.lower
                                         : system_->scale() / work.own + std::abs(given.impulse);
        row.to_lower = std::max(given.impulse - given.lower, 1e-15 * row.cap);
        row.to_upper = std::max(given.upper - given.impulse, 1e-15 * row.cap);
        see_residual(work.residual + row.z_lower - row.z_upper);
        if (row.below) see_product(row.z_lower * row.to_lower / row.cap);
        if (row.above) see_product(row.z_upper * row.to_upper / row.cap);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block& block = blocks_[k];
        if (!block.open) continue;
        const BlockView view = view_of(*system_, k);
        with_form(view, [&](auto form) {
            for (int i = 0; i < view.count(); ++i) {
                if (view.work[i].weight == 0 && !view.live(i) && i > 0) continue;
                see_residual(view.work[i].residual - block.multiplier * form.gradient(view, i));
            }
            block.slack = std::max(form.slack(view), 1e-14 * block.cap);
        });
        see_product(block.multiplier * block.slack / block.cap);
    }
    left.mean = left.products > 0 ? sum / left.products : 0;
    return left;
}

DUCTILE_INLINE void InteriorPoint::set_weights() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        IslandSystem::Row& work = system_->rows()[i];
        work.weight = 0;
        if (!row.open) continue;
        double theta = work.compliance;
        if (row.below) theta += row.z_lower / row.to_lower;
        if (row.above) theta += row.z_upper / row.to_upper;
        work.weight = 1 / theta;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Block& block = blocks_[k];
        const BlockView view = view_of(*system_, k);
        if (block.open) {
            with_form(view, [&](auto form) {
                form.set_interior_tangent(view, block.multiplier, block.slack);
            });
        } else {
            view.clear_terms();
            for (int i = 0; i < view.count(); ++i) view.work[i].weight = 0;
        }
    }
}

DUCTILE_INLINE void InteriorPoint::set_right_sides(double target, bool second) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        IslandSystem::Row& work = system_->rows()[i];
        work.right = work.residual;
        work.extra = 0;
        if (!row.open) continue;
        // of the multipliers before dx is known
        row.change_lower = row.change_upper = 0;
        const double left_lower = second ? row.first_lower * row.first_change : 0;
        const double left_upper = second ? -row.first_upper * row.first_change : 0;
        if (row.below) {
            row.change_lower = (target * row.cap - left_lower) / row.to_lower - row.z_lower;
        }
        if (row.above) {
            row.change_upper = (target * row.cap - left_upper) / row.to_upper - row.z_upper;
        }
        work.right += row.z_lower + row.change_lower - row.z_upper - row.change_upper;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block& block = blocks_[k];
        const BlockView view = view_of(*system_, k);
        if (!block.open) {
            for (int i = 0; i < view.count(); ++i) view.work[i].right = 0;
            continue;
        }
        with_form(view, [&](auto form) {
            double product = target * block.cap - block.multiplier * block.slack;
            Vector6<double> curved = Vector6<double>::Zero(); // ∇²f dx of the predictor
            if (second) {
                Vector6<double> dx = Vector6<double>::Zero();
                for (int i = 0; i < view.count(); ++i) {
                    dx[i] = rows_[std::size_t(view.block.first + i)].first_change;
                }
                curved = form.hessian(view, dx);
                product -=
                    block.first_change * block.first_slack - block.multiplier * curved.dot(dx) / 2;
            }
            block.change = product / block.slack;
            for (int i = 0; i < view.count(); ++i) {
                double& right = view.work[i].right;
                if (!view.live(i) && i > 0) {
                    right = 0;
                    continue;
                }
                right -= (block.multiplier + block.change) * form.gradient(view, i);
                if (second) right -= block.first_change * curved[i];
            }
        });
    }
}

DUCTILE_INLINE double InteriorPoint::direct(double target, bool second) {
    set_right_sides(target, second);
    system_->step();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        if (!row.open) continue;
        const double dx = system_->rows()[i].change;
        if (row.below) row.change_lower -= row.z_lower * dx / row.to_lower;
        if (row.above) row.change_upper += row.z_upper * dx / row.to_upper;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block& block = blocks_[k];
        if (!block.open) continue;
        const BlockView view = view_of(*system_, k);
        with_form(view, [&](auto form) {
            for (int i = 0; i < view.count(); ++i) {
                block.change +=
                    block.multiplier / block.slack * form.gradient(view, i) * view.work[i].change;
            }
        });
    }
    return reach();
}

DUCTILE_INLINE double InteriorPoint::reach() {
    double share = std::numeric_limits<double>::infinity();
    const auto see = [&share](double room, double change) { // room + share change >= 0
        if (change < 0) share = std::min(share, room / -change);
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        if (!row.open) continue;
        const double dx = system_->rows()[i].change;
        if (row.below) see(row.to_lower, dx);
        if (row.below) see(row.z_lower, row.change_lower);
        if (row.above) see(row.to_upper, -dx);
        if (row.above) see(row.z_upper, row.change_upper);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Block& block = blocks_[k];
        if (!block.open) continue;
        see(block.multiplier, block.change);
        const BlockView view = view_of(*system_, k);
        share = std::min(share, with_form(view, [&](auto form) { return form.reach(view); }));
    }
    return share;
}

DUCTILE_INLINE double InteriorPoint::mean_after(double share, int products) const {
    if (products == 0) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        if (!row.open) continue;
        const double dx = share * system_->rows()[i].change;
        if (row.below)
            sum += (row.z_lower + share * row.change_lower) * (row.to_lower + dx) / row.cap;
        if (row.above)
            sum += (row.z_upper + share * row.change_upper) * (row.to_upper - dx) / row.cap;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Block& block = blocks_[k];
        if (!block.open) continue;
        const BlockView view = view_of(*system_, k);
        const auto slack = [&](auto form) { // there, and back again
            for (int i = 0; i < view.count(); ++i)
                view.row[i].impulse += share * view.work[i].change;
            const double result = form.slack(view);
            for (int i = 0; i < view.count(); ++i)
                view.row[i].impulse -= share * view.work[i].change;
            return std::max(0.0, result);
        };
        sum += std::max(0.0, block.multiplier + share * block.change) * with_form(view, slack) /
               block.cap;
    }
    return sum / products;
}

DUCTILE_INLINE void InteriorPoint::keep_predictor() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        row.first_change = system_->rows()[i].change;
        row.first_lower = row.change_lower;
        row.first_upper = row.change_upper;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block& block = blocks_[k];
        if (!block.open) continue;
        const BlockView view = view_of(*system_, k);
        block.first_change = block.change;
        block.first_slack = 0;
        with_form(view, [&](auto form) {
            for (int i = 0; i < view.count(); ++i) {
                block.first_slack -= form.gradient(view, i) * view.work[i].change;
            }
        });
    }
}

DUCTILE_INLINE void InteriorPoint::move(double share) {
    Island& island = system_->island();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Row& row = rows_[i];
        island.rows[i].impulse += share * system_->rows()[i].change;
        row.z_lower += share * row.change_lower;
        row.z_upper += share * row.change_upper;
    }
    for (Block& block : blocks_) {
        if (block.open) block.multiplier += share * block.change;
    }
}

/// By which of the two factors of a product is the larger, both as velocities.
DUCTILE_INLINE void InteriorPoint::tell_sides() {
    Island& island = system_->island();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        IslandRow& given = island.rows[i];
        const double metric = system_->rows()[i].metric;
        given.side = Side::free;
        if (!row.open && std::isfinite(given.lower)) given.side = Side::lower;
        if (row.open && row.below && row.z_lower > metric * row.to_lower) given.side = Side::lower;
        if (row.open && row.above && row.z_upper > metric * row.to_upper) given.side = Side::upper;
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const Block& block = blocks_[k];
        const BlockView view = view_of(*system_, k);
        if (held(view.block)) continue;
        with_form(view,
                  [&](auto form) { form.tell(view, block.open, block.multiplier, block.slack); });
    }
}

} // namespace ductile::solve
