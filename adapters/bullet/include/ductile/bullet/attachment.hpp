// SPDX-License-Identifier: MIT
//
// A constraint of Bullet's between a body of a member or structure and whatever it holds. It cannot
// change its bodies: it is made anew where these become others, and ends before they do.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <array>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "ductile/bullet/convert.hpp"
#include "ductile/member/member_course.hpp"

namespace ductile::bullet {

struct Attachment {
    /// Makes the constraint; `place`: where it is to hold, in the body.
    using Maker =
        std::function<std::unique_ptr<btTypedConstraint>(btRigidBody&, const btTransform& place)>;

    Maker maker;
    std::unique_ptr<btTypedConstraint> constraint{};
    std::unique_ptr<btJointFeedback> feedback = std::make_unique<btJointFeedback>();
    btJointFeedback told = btJointFeedback(); ///< when it was last solved
    const btRigidBody* body = nullptr;        ///< of the constraint
    bool off = false; ///< it broke, or hands switched it off, before its bodies were others
    std::array<ContactBody, 2> before{}; ///< a blow: of its body, of the other

    /// @throws std::invalid_argument, `field` first, where nothing is made, or it is not the
    /// body's.
    void make(const std::string& field, btDiscreteDynamicsWorld& world, btRigidBody& on,
              const btTransform& place) {
        if (constraint != nullptr) return;
        std::unique_ptr<btTypedConstraint> made = maker ? maker(on, place) : nullptr;
        if (made == nullptr) throw std::invalid_argument(field + ".maker: must make a constraint");
        if (&made->getRigidBodyA() != &on && &made->getRigidBodyB() != &on) {
            throw std::invalid_argument(
                field + ".maker: must make a constraint of the body that it is given");
        }
        constraint = std::move(made);
        body = &on;
        told = btJointFeedback(); // was of another body
        constraint->setJointFeedback(feedback.get());
        if (off) constraint->setEnabled(false);
        world.addConstraint(constraint.get(), true);
    }
    void drop(btDiscreteDynamicsWorld& world) {
        if (constraint == nullptr) return;
        off = !acts();
        world.removeConstraint(constraint.get());
        constraint.reset();
        body = nullptr;
    }
    [[nodiscard]] bool acts() const { return constraint->isEnabled(); }
    [[nodiscard]] btRigidBody& other() const {
        return is_first() ? constraint->getRigidBodyB() : constraint->getRigidBodyA();
    }
    /// In ticks: what sleeps carries on as when it was solved; between what cannot move nothing is.
    [[nodiscard]] bool is_solved() const {
        const auto moves = [](const btRigidBody& of) {
            return of.isActive() && !of.isStaticOrKinematicObject();
        };
        return acts() && (moves(*body) || moves(other()));
    }
    /// Of what can move: not `on`, it acts no more until that is put back; false: it is none.
    bool switch_on(bool on) const {
        if (!acts() || other().isStaticOrKinematicObject()) return false;
        constraint->setEnabled(on);
        return true;
    }
    void see_coming() { before = {contact_body(*body), contact_body(other())}; }
    /// After a solve; false: it was none of this.
    bool see() {
        if (!is_solved()) return false;
        told = *feedback;
        return true;
    }
    [[nodiscard]] const btVector3& force() const {
        return is_first() ? told.m_appliedForceBodyA : told.m_appliedForceBodyB;
    }
    [[nodiscard]] const btVector3& torque() const {
        return is_first() ? told.m_appliedTorqueBodyA : told.m_appliedTorqueBodyB;
    }
    [[nodiscard]] Wrench given() const { return {to_core(force()), to_core(torque())}; }
    /// In a blow of `dt` [s] that was seen, of its own body or of the other; `place`: where it
    /// holds, world [m].
    [[nodiscard]] JointSide side(bool own, const Vector3<double>& place, double dt) const {
        const btRigidBody& of = own ? *body : other();
        const bool a = own == is_first();
        return {
            .before = before[own ? 0 : 1],
            .after = contact_body(of),
            .arm = to_core(to_bullet(place) - of.getCenterOfMassPosition()),
            .impulse = scaled(dt, to_core(a ? told.m_appliedForceBodyA : told.m_appliedForceBodyB)),
            .moment =
                scaled(dt, to_core(a ? told.m_appliedTorqueBodyA : told.m_appliedTorqueBodyB))};
    }

  private:
    [[nodiscard]] bool is_first() const { return &constraint->getRigidBodyA() == body; }
};

} // namespace ductile::bullet
