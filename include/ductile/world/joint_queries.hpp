// SPDX-License-Identifier: MIT
//
// What may be asked of a plastic joint in any engine: the same names, all const, of the last whole
// step. An engine's constraint answers the private questions at the end; the rest is here, once.
#pragma once

#include <algorithm>
#include <optional>

#include "ductile/joint/break_release.hpp"
#include "ductile/joint/joint_totals.hpp"
#include "ductile/world/joint_report.hpp"

namespace ductile {

/// Not thread-safe: an engine may book its last step when it is first asked.
class JointQueries {
  public:
    /// Accumulated plastic travel p, work-conjugate, never decreases; of coupled axes the
    /// equivalent one [m | rad].
    [[nodiscard]] double plastic_travel() const { return totals().plastic_travel; }
    /// Energy dissipated by plastic flow, D [J].
    [[nodiscard]] double absorbed_energy() const { return totals().plastic_work; }
    /// Energy that the material's damping took below the strength [J].
    [[nodiscard]] double damped_energy() const { return totals().damped; }
    /// Elastic energy, and what a back force holds [J].
    [[nodiscard]] double stored_energy() const { return totals().stored; }
    [[nodiscard]] bool broken() const { return totals().broken; }
    /// Unreliable where the solver left a row unsolved, plastic or rigid, or a contact of its
    /// island.
    [[nodiscard]] Outcome outcome() const {
        return totals().broken ? Outcome::broken : last_outcome();
    }
    /// Certificate: violation of the plastic rows in the last step, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() const {
        settle();
        return last_step().residual;
    }
    [[nodiscard]] double residual_max() const { return totals().residual_max; }
    /// Largest violation of the rigid rows in the last step, as far as the engine tells them
    /// [m/s | rad/s].
    [[nodiscard]] double rigid_residual() const {
        settle();
        return last_rigid_residual();
    }
    /// Share of the strength that the last step's forces used: 1 where it flows, 0 where broken
    /// [-].
    [[nodiscard]] double utilisation() const {
        settle();
        return last_utilisation();
    }
    /// Of the last step; where the joint did not act in it, an idle one. Speeds are those of now.
    [[nodiscard]] JointReport<double> report() const {
        settle();
        auto now = joint_report(state_totals(), last_step(), fracture(), last_outcome(),
                                last_rigid_residual());
        now.unseen_turn = last_unseen_turn();
        now.island_unsolved = last_island_unsolved();
        if (const double error = borne_error(); error > 0) {
            now.coarse = true;
            now.borne = borne_blow();
            now.step_error = std::max(now.step_error, error);
        }
        return acts() ? now : idle_report(now);
    }

  protected:
    JointQueries() = default;
    JointQueries(const JointQueries&) = default;
    JointQueries& operator=(const JointQueries&) = default;
    ~JointQueries() = default;

    [[nodiscard]] const JointTotals<double>& totals() const {
        settle();
        return state_totals();
    }
    /// Books the last step where that is still open.
    virtual void settle() const {}

  private:
    [[nodiscard]] virtual const JointTotals<double>& state_totals() const = 0;
    [[nodiscard]] virtual const Step<double>& last_step() const = 0;
    [[nodiscard]] virtual std::optional<FractureEvent<double>> fracture() const = 0;
    /// Of all rows.
    [[nodiscard]] virtual Outcome last_outcome() const { return last_step().outcome; }
    [[nodiscard]] virtual double last_rigid_residual() const { return 0; }
    [[nodiscard]] virtual double last_unseen_turn() const = 0;
    [[nodiscard]] virtual double last_island_unsolved() const = 0;
    /// As AnyLink's.
    [[nodiscard]] virtual double borne_blow() const { return 0; }
    [[nodiscard]] virtual double borne_error() const { return 0; }
    [[nodiscard]] virtual double last_utilisation() const = 0;
    /// False where the engine left the joint out of the last step.
    [[nodiscard]] virtual bool acts() const { return true; }
};

/// Of a joint between two bodies.
class PairQueries : public JointQueries {
  public:
    /// What a break handed back to the two bodies, if there was one.
    [[nodiscard]] const BreakRelease<double>& release() const {
        (void)totals();
        return release_;
    }

  protected:
    ~PairQueries() = default;

    mutable BreakRelease<double> release_;
};

} // namespace ductile
