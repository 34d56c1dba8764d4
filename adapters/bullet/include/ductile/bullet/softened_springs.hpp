// SPDX-License-Identifier: MIT
//
// Springs of btGeneric6DofSpring2Constraint, and so of btHinge2Constraint, that Bullet gives less
// than their stiffness. In a tick of h it limits them, unless setStiffness says otherwise, to
//
//   k <= m/(16 h²)    m: reduced mass of both bodies, of what turns with its arms
//
// a hundredth of a car's suspension at 1/30 s. In islands with plastic joints a spring has all of
// its stiffness in parts of frames (island_solver_turned.ipp): who comes to such a joint on springs
// is another vehicle from then on, and comes otherwise in frames of another length. So a World is
// told of the first one that does; or solves such islands at once from the start.
//
// Thread-safety: SoftenedSprings none; the functions read one constraint.
#pragma once

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace ductile::bullet {

namespace detail {

/// `tell(axis, stiffness, limited)` of its springs.
template <class Tell>
void for_springs(btTypedConstraint& constraint, const Tell& tell) {
    if (constraint.getConstraintType() != D6_SPRING_2_CONSTRAINT_TYPE) return;
    if (!constraint.isEnabled()) return;
    auto& six = static_cast<btGeneric6DofSpring2Constraint&>(constraint);
    const btTranslationalLimitMotor2& moves = *six.getTranslationalLimitMotor();
    for (int i = 0; i < 3; ++i) {
        const btRotationalLimitMotor2& turns = *six.getRotationalLimitMotor(i);
        if (moves.m_enableSpring[i] && moves.m_springStiffness[i] > 0) {
            tell(i, double(moves.m_springStiffness[i]), moves.m_springStiffnessLimited[i]);
        }
        if (turns.m_enableSpring && turns.m_springStiffness > 0) {
            tell(i + 3, double(turns.m_springStiffness), turns.m_springStiffnessLimited);
        }
    }
}

/// As Bullet has it, of a spring that turns, or moves [kg m² | kg].
[[nodiscard]] inline double reduced_mass(btGeneric6DofSpring2Constraint& six, int axis) {
    double inverse = 0;
    const auto add = [&](const btRigidBody& body, const btTransform& frame) {
        if (!(body.getInvMass() > 0)) return;
        double mass = 1 / double(body.getInvMass());
        if (axis >= 3) {
            const btVector3 arm = frame.getOrigin() - body.getCenterOfMassPosition();
            mass = mass * double(arm.length2()) +
                   1 / double((body.getInvInertiaTensorWorld() * six.getAxis(axis - 3)).length());
        }
        inverse += 1 / mass;
    };
    add(six.getRigidBodyA(), six.getCalculatedTransformA());
    add(six.getRigidBodyB(), six.getCalculatedTransformB());
    return 1 / inverse;
}

} // namespace detail

[[nodiscard]] inline bool has_springs(btTypedConstraint& constraint) {
    bool any = false;
    detail::for_springs(constraint, [&](int, double, bool) { any = true; });
    return any;
}

/// The least share of their stiffness that springs of a constraint have in a tick of `h` [s], 1:
/// all of it.
[[nodiscard]] inline double stiffness_left(btTypedConstraint& constraint, double h) {
    double least = 1;
    detail::for_springs(constraint, [&](int axis, double stiffness, bool limited) {
        if (!limited) return;
        auto& six = static_cast<btGeneric6DofSpring2Constraint&>(constraint);
        const double most = detail::reduced_mass(six, axis) / (16 * h * h);
        least = std::min(least, most / stiffness);
    });
    return least;
}

/// Which of them were softened, and came to a plastic joint then.
class SoftenedSprings {
  public:
    struct Found {
        int body, other; ///< by their places in the world; < 0: the static world
        double share;    ///< of its stiffness that it had [-]
    };

    /// One that Bullet solves in a tick of `h` [s].
    void leave(btTypedConstraint& constraint, double h) {
        if (constraint.getConstraintType() != D6_SPRING_2_CONSTRAINT_TYPE) return;
        const double share = stiffness_left(constraint, h);
        if (!(share < hardly_less)) return;
        double& least = softened_.try_emplace(&constraint, share).first->second;
        least = std::min(least, share);
    }
    /// One in an island with a plastic joint.
    void meet(btTypedConstraint& constraint) {
        if (constraint.getConstraintType() != D6_SPRING_2_CONSTRAINT_TYPE || found_) return;
        const auto at = softened_.find(&constraint);
        if (at == softened_.end()) return;
        const int a = constraint.getRigidBodyA().getWorldArrayIndex(),
                  b = constraint.getRigidBodyB().getWorldArrayIndex();
        found_ = Found{std::max(a, b), std::min(a, b), at->second};
    }
    [[nodiscard]] const std::optional<Found>& found() const noexcept { return found_; }

  private:
    static constexpr double hardly_less = 0.98;

    std::unordered_map<const btTypedConstraint*, double> softened_; ///< addresses alone
    std::optional<Found> found_;                                    ///< the first one
};

} // namespace ductile::bullet
