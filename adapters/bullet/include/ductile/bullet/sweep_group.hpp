// SPDX-License-Identifier: MIT
//
// What the constraints share that solve their rows by themselves (self_solved_rows.hpp) within the
// sweeps of one sequential impulse: room for the rows, and a say in when the sweeps end.
//
// Bullet ends its sweeps over a group of islands once no row of its own changed by more than
// `m_leastSquaresResidualThreshold`, and cannot see rows that are not its own. Our own solver asks
// (`take_change`). For Bullet's a constraint that still changes something puts the threshold of the
// world out of reach, and the first to be called in the next sweep puts it back; the last sweep
// that Bullet would make in any case leaves it as it was.
//
// Not thread-safe: one for each solver that may run beside others, hence for Bullet's own only in a
// world that is known to have one solver and one thread.
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <algorithm>
#include <cstddef>
#include <typeinfo>
#include <utility>
#include <vector>

#include "ductile/joint/row_sweep.hpp"

namespace ductile::bullet {

/// Base of a solver that stands before another one and mostly leaves the work to it.
class ProxySolver {
  public:
    [[nodiscard]] virtual btConstraintSolver& usual() const noexcept = 0;

  protected:
    ~ProxySolver() = default;
};

/// True for Bullet's own sequential impulse and NNCG, alone or behind a ProxySolver: they call
/// every constraint in each sweep. What derives from them may do otherwise.
[[nodiscard]] inline bool calls_in_each_sweep(const btConstraintSolver& solver) {
    if (typeid(solver) == typeid(btSequentialImpulseConstraintSolver) ||
        typeid(solver) == typeid(btNNCGConstraintSolver)) {
        return true;
    }
    const auto* front = dynamic_cast<const ProxySolver*>(&solver);
    return front != nullptr && calls_in_each_sweep(front->usual());
}

/// True for a world that solves its islands one after the other. What derives from it may not.
[[nodiscard]] inline bool solves_in_one_thread(const btDynamicsWorld& world) {
    return typeid(world) == typeid(btDiscreteDynamicsWorld);
}

class SweepGroup {
  public:
    /// Of a solver that asks for the change itself.
    SweepGroup() = default;
    /// Of a world, whose solver info must outlive this.
    explicit SweepGroup(btContactSolverInfo& info) : info_(&info) {}

    /// Room for the rows of one constraint in one solve.
    struct Place {
        std::size_t rows = 0;
        unsigned long solve = 0; ///< 0: none yet
    };

    /// A solve begins. Only a solver that asks for the change says so.
    void begin() noexcept {
        ++solve_;
        sweep_ = -1;
        taken_ = 0;
    }
    /// Room for a constraint that will solve its rows by itself, before the first sweep; `last`:
    /// what it had before in this group. Other solves begin with the first constraint that comes
    /// after a sweep, or a second time.
    [[nodiscard]] Place take(const Place& last) {
        if (info_ != nullptr && (sweep_ >= 0 || last.solve == solve_)) begin();
        if (taken_ == rows_.size()) rows_.emplace_back();
        return {taken_++, solve_};
    }
    [[nodiscard]] RowSweep<double>& rows(const Place& place) noexcept { return rows_[place.rows]; }

    /// A constraint was called in sweep `sweep` = 0, 1, ...; `change`: largest change of velocity
    /// that one of its rows asked for, 0: nothing but round-off [m/s | rad/s].
    void called(int sweep, double change) noexcept {
        if (sweep != sweep_) {
            sweep_ = sweep;
            let_end();
        }
        if (change == 0) return;
        change_ = std::max(change_, change);
        if (info_ != nullptr) hold(sweep, change);
    }

    /// Largest change since this was last asked [m/s | rad/s].
    [[nodiscard]] double take_change() noexcept { return std::exchange(change_, 0); }

  private:
    void hold(int sweep, double change) noexcept {
        btScalar& threshold = info_->m_leastSquaresResidualThreshold;
        if (held_ || sweep + 1 >= info_->m_numIterations) return;
        if (threshold < 0 || change * change <= double(threshold)) return;
        users_threshold_ = std::exchange(threshold, btScalar(-1)); // no square is less
        held_ = true;
    }
    void let_end() noexcept {
        if (held_) info_->m_leastSquaresResidualThreshold = users_threshold_;
        held_ = false;
    }

    btContactSolverInfo* info_ = nullptr;
    btScalar users_threshold_ = 0; ///< while it is out of reach
    bool held_ = false;            ///< it is
    int sweep_ = 0;                ///< the last that anybody was called in; -1: none yet
    double change_ = 0;
    std::vector<RowSweep<double>> rows_;
    std::size_t taken_ = 0;
    unsigned long solve_ = 1;
};

} // namespace ductile::bullet
