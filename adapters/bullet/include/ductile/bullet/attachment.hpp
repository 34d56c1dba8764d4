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
#include <string>

#include "ductile/member/member_course.hpp"
#include "ductile/vocabulary/linkage.hpp"

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
              const btTransform& place);
    void drop(btDiscreteDynamicsWorld& world);
    [[nodiscard]] bool acts() const { return constraint->isEnabled(); }
    [[nodiscard]] btRigidBody& other() const;
    /// In ticks: what sleeps carries on as when it was solved; between what cannot move nothing is.
    [[nodiscard]] bool is_solved() const;
    /// Of what can move: not `on`, it acts no more until that is put back; false: it is none.
    bool switch_on(bool on) const;
    void see_coming();
    /// After a solve; false: it was none of this.
    bool see();
    [[nodiscard]] const btVector3& force() const;
    [[nodiscard]] const btVector3& torque() const;
    [[nodiscard]] Wrench given() const;
    /// In a blow of `dt` [s] that was seen, of its own body or of the other; `place`: where it
    /// holds, world [m].
    [[nodiscard]] JointSide side(bool own, const Vector3<double>& place, double dt) const;

  private:
    [[nodiscard]] bool is_first() const { return &constraint->getRigidBodyA() == body; }
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/attachment.ipp"
#endif
