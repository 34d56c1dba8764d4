// SPDX-License-Identifier: MIT
//
// A plastic constraint of any kind, as a world, an energy account, a debug drawer or a solver sees
// it.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransform.h>

#include "ductile/bullet/soft_rows.hpp"
#include "ductile/joint/pair.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/world/joint_report.hpp"
#include "ductile/world/leapfrog.hpp"

namespace ductile::bullet {

/// How a joint stands after the last tick: what there is to draw.
struct JointView {
    btTransform frame_a; ///< of the joint in A, world
    btTransform frame_b; ///< of the joint in B, world
    Outcome outcome = Outcome::elastic;
    double utilisation = 0;                                   ///< 0: no load, 1: it flows [-]
    Vector6<double> plastic_offset = Vector6<double>::Zero(); ///< order of JointAxis [m | rad]
};

/// Everything but the law. A query settles the last tick first where that is still open; hence no
/// query is const.
class PlasticConstraint : public btTypedConstraint, public SoftRows {
  public:
    using btTypedConstraint::btTypedConstraint;

    [[nodiscard]] virtual double absorbed_energy() = 0; ///< D [J]
    /// Elastic energy, and what a back force holds [J].
    [[nodiscard]] virtual double stored_energy() = 0;
    /// Of the break, if there was one.
    [[nodiscard]] virtual const BreakRelease<double>& release() = 0;
    [[nodiscard]] virtual JointView view() = 0;
    /// Of the last tick; where that was none of the constraint's, because its bodies slept or it is
    /// disabled, an idle one. Speeds are those of now.
    [[nodiscard]] virtual JointReport<double> report() = 0;
    /// How the constraint's forces act in the coming ticks; of a World that leapfrogs.
    void set_force_share(const ForceShare& share) noexcept { force_share_ = share; }
    /// True from add_to to remove_from.
    [[nodiscard]] bool in_world() const noexcept { return world_ != nullptr; }

  protected:
    /// False where the last tick left the constraint out.
    [[nodiscard]] bool acts() const {
        const auto awake = [](const btRigidBody& body) {
            return !body.isStaticOrKinematicObject() && body.isActive();
        };
        return isEnabled() && (awake(m_rbA) || awake(m_rbB));
    }

    btDynamicsWorld* world_ = nullptr; ///< where add_to put it
    ForceShare force_share_;
};

} // namespace ductile::bullet
