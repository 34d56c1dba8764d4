// SPDX-License-Identifier: MIT
//
// A plastic constraint of any kind, as a world, an energy account, a debug drawer or a solver sees
// it, and its life in a world.
//
// Committing. The constraint books each internal tick by itself: at the tick's end where it was
// added by `add_to` (which registers an action), otherwise when Bullet opens the next tick or when
// somebody asks it for a result, whichever comes first. Nothing has to be called by hand. A tick in
// which the bodies slept, or the constraint was disabled, was not solved and is not booked.
//   Only with `add_to` may bodies be moved by hand (not only given velocities) between a tick and
//   what comes first.
//
// Hands. What somebody moves by hand between two ticks, or while the constraint is switched off, is
// no deformation: plastic axes keep their strain, their rest position goes along, and rigid axes
// are pulled together again. A kinematic body is not moved by hand but along its way
// (driven_body.hpp).
//
// Collisions. The joint stands for the material between its two bodies: while it holds they do not
// collide with each other, from add_to on and unless that was told otherwise. Contacts there would
// fight its rows: two boxes whose faces met made three times the energy that they had. After a
// break, or once it has left, they collide, when no other joint parts them. Bullet's addConstraint
// alone has them collide.
//
// Ends. A constraint that ends leaves Bullet's world, and every World that looks after it: so
// Bullet's world has to outlive it, or it has to be removed before.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "ductile/bullet/driven_body.hpp"
#include "ductile/bullet/island_rows.hpp"
#include "ductile/bullet/joint_view.hpp"
#include "ductile/bullet/tick_account.hpp"
#include "ductile/frame/part_row.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/joint_queries.hpp"
#include "ductile/world/kept_joint.hpp"

namespace ductile::bullet {

/// Tells a PlasticConstraint from all of Bullet's: none of its own.
inline constexpr auto plastic_constraint_type = btTypedConstraintType(int(MAX_CONSTRAINT_TYPE) + 1);

/// Everything but the joint.
class PlasticConstraint : public btTypedConstraint,
                          public IslandRows,
                          public KeptJoint,
                          public TickMember {
  public:
    DUCTILE_INLINE ~PlasticConstraint() override;

    /// Adds the constraint and its booking at the end of each tick to a world; only the booking
    /// where Bullet's own addConstraint was called before.
    /// `disable_collisions_between_bodies`: until it breaks or leaves; false: they collide, as two
    /// that are apart and may close a gap, or what Bullet was told stands. Not said: true, but of a
    /// PlasticMotor, of whose hinge the user has said it.
    /// @throws std::invalid_argument where it is in a world already.
    void add_to(btDynamicsWorld& world, std::optional<bool> disable_collisions_between_bodies = {});
    void remove_from(btDynamicsWorld& world);

    [[nodiscard]] virtual const PairQueries& queries() const noexcept = 0;
    [[nodiscard]] virtual JointView view() const = 0;
    /// @throws std::logic_error where a body that can move is in no world. Asked in every tick, and
    /// by World before it.
    void require_bodies_in_world() const;
    /// In the coming ticks the bodies are half a step ahead (half_ahead.hpp).
    void set_ahead(bool ahead) noexcept { ahead_ = ahead; }
    [[nodiscard]] bool is_ahead() const noexcept { return ahead_; }
    // ---- a structure's side (world/structures.hpp)

    [[nodiscard]] bool is_awake_member() const override { return is_awake(); }
    [[nodiscard]] DUCTILE_INLINE std::array<const void*, 2> moving_bodies() const override;
    DUCTILE_INLINE void keep_awake() override;

    // ---- parts of a frame (world_parts.hpp)

    /// The bodies are about to be moved half a step ahead: what hands did to them is seen now.
    virtual void begin_part() = 0;
    /// Keeps all that a tick may change, for one put_all_back or more.
    virtual void keep_all() = 0;
    /// Everything is as it was at the last `keep_all`, bit for bit; the bodies are already.
    virtual void put_all_back() = 0;
    /// Adds what the last tick did along the plastic axes; `joint`: its number.
    virtual void list_part_rows(std::size_t joint, std::vector<PartRow>& rows) const = 0;

    /// True from add_to to remove_from, whoever else took the constraint out.
    [[nodiscard]] bool in_world() const noexcept { return world_ != nullptr; }

  protected:
    PlasticConstraint(btRigidBody& a, btRigidBody& b);
    /// Body A (0) or B (1) as the joint has to see it at the start of a tick [s], and, once, at its
    /// end; `late`: some time after it.
    [[nodiscard]] BodyState<double> at_start(int side, double tick, bool with_mass);
    [[nodiscard]] BodyState<double> at_end(int side, bool late);
    /// This tick left the joint out.
    void lose_driven();
    /// The bodies were put where they are, by hand.
    void find_driven();
    /// False where the last tick left the constraint out.
    [[nodiscard]] bool is_awake() const;
    /// Switches the constraint, and what Bullet was told of its bodies' collisions, off or on.
    void let_go();
    void hold_again();
    /// Of `keep_all` and `put_all_back`, what all kinds have.
    void keep_life();
    void put_life_back();

    btDynamicsWorld* world_ = nullptr; ///< where add_to put it
    bool ahead_ = false;               ///< the bodies are half a step ahead where rows are solved

  private:
    [[nodiscard]] DUCTILE_INLINE std::size_t island() const override;
    [[nodiscard]] bool is_among_constraints_of(const btDynamicsWorld& world) const;
    /// Whether its bodies collide while it holds, where nobody said it.
    [[nodiscard]] virtual bool collides_unasked() const noexcept { return false; }
    /// They do not from now on, and contacts that they have end.
    void part_bodies();
    /// Where it ends: its bodies may have ended before.
    void abandon_world();

    struct EndOfTick final : btActionInterface {
        explicit EndOfTick(PlasticConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.end_tick_of_world(); }
        DUCTILE_INLINE void debugDraw(btIDebugDraw* drawer) override;
        PlasticConstraint& owner_;
    };
    [[nodiscard]] btRigidBody& body(int side) const { return side == 0 ? m_rbA : m_rbB; }

    EndOfTick end_of_tick_{*this};
    std::array<std::unique_ptr<DrivenBody>, 2> driven_; ///< of bodies that are kinematic
    bool parts_bodies_ = false;                         ///< let_go has to be undone by hold_again
    /// What keep_life keeps.
    struct KeptLife {
        std::array<std::unique_ptr<DrivenBody>, 2> driven;
        btScalar impulse = 0;
        bool enabled = true;
    };
    KeptLife kept_life_;
};

/// Null for any other constraint.
[[nodiscard]] inline PlasticConstraint* as_plastic(btTypedConstraint& constraint) noexcept {
    return constraint.getConstraintType() == plastic_constraint_type
               ? static_cast<PlasticConstraint*>(&constraint)
               : nullptr;
}

/// At the constraint's own size of drawing (setDbgDrawSize); see draw.hpp.
void draw(PlasticConstraint& constraint, btIDebugDraw& drawer);

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/plastic_constraint.ipp"
#endif
