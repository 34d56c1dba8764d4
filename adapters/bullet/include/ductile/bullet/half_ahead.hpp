// SPDX-License-Identifier: MIT
//
// Lets a world's tick see its bodies half a step ahead (frame/README.md): before the tick they are
// moved by h/2 with the velocities they have; in it, after Bullet has moved them by h with the new
// ones and before any other action, to where h/2 leads.
//
// Traps of Bullet 3.24 that this header deals with
//   - Actions run in the order of their list, to whose end Bullet adds: this one has to be first,
//     as joints book where bodies are.
//   - A body that the tick woke was not ahead; one that the tick put to sleep stays where it is.
//   - Where Bullet's continuous collision stopped a body, it goes no further than that.
//   - What overlaps deeper than m_splitImpulsePenetrationThreshold is pushed apart without a
//     velocity: that way stays.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "ductile/bullet/driven_ways.hpp"
#include "ductile/bullet/moving_bodies.hpp"

namespace ductile::bullet {

namespace detail {

/// Bullet's own list is not public.
struct ActionArray : btDiscreteDynamicsWorld {
    static auto& of(btDiscreteDynamicsWorld& world) { return world.*(&ActionArray::m_actions); }
};

/// A body that a tick moves; null for any other.
[[nodiscard]] inline btRigidBody* awake_body(btRigidBody& body) {
    return !body.isStaticOrKinematicObject() && body.isActive() ? &body : nullptr;
}

/// Its velocities take it nowhere in `h` [s]. Bullet's tick begins with them.
[[nodiscard]] inline bool stays(btRigidBody& body, btScalar h) {
    constexpr btScalar nothing = btScalar(1e-16); // [m | rad]
    const btVector3 &velocity = body.getLinearVelocity(), &spin = body.getAngularVelocity();
    if (!(std::max(velocity.length2(), spin.length2()) * h * h < nothing * nothing)) return false;
    body.setInterpolationLinearVelocity(velocity);
    body.setInterpolationAngularVelocity(spin);
    return true;
}

/// Whether the body, moved by its velocity for `time` [s] since it was at `from`, is elsewhere.
[[nodiscard]] inline bool was_pushed(const btRigidBody& body, const btTransform& from,
                                     btScalar time) {
    const btVector3 way = body.getLinearVelocity() * time;
    const btVector3 off = body.getCenterOfMassPosition() - (from.getOrigin() + way);
    const btScalar rounded = 8 * SIMD_EPSILON;
    return off.length2() > rounded * rounded * (from.getOrigin().length2() + way.length2());
}

/// Of the way of a tick of `h` [s] from `from`, how much the body went: all, unless Bullet's
/// continuous collision stopped it, which then says that it went none.
[[nodiscard]] inline btScalar share_gone(const btRigidBody& body, const btTransform& from,
                                         btScalar h) {
    if (!(body.getHitFraction() < 1)) return 1;
    const btVector3 way = body.getLinearVelocity() * h;
    const btScalar gone = way.dot(body.getCenterOfMassPosition() - from.getOrigin());
    return gone > 0 ? std::min(gone / way.length2(), btScalar(1)) : btScalar(0);
}

} // namespace detail

class HalfAhead final : public btActionInterface {
  public:
    /// Is in the world's list of actions until `leave`.
    explicit HalfAhead(btDiscreteDynamicsWorld& world) : world_(world) {
        auto& actions = detail::ActionArray::of(world_);
        actions.push_back(this);
        for (int i = actions.size() - 1; i > 0; --i) actions.swap(i, i - 1);
    }
    ~HalfAhead() override = default;
    /// To be called before this ends, unless the world has.
    void leave() {
        // not by removeAction, which puts the last of the list in its place
        auto& actions = detail::ActionArray::of(world_);
        const int here = actions.findLinearSearch(this);
        if (here == actions.size()) return;
        for (int i = here; i + 1 < actions.size(); ++i) actions.swap(i, i + 1);
        actions.pop_back();
    }
    HalfAhead(const HalfAhead&) = delete;
    HalfAhead& operator=(const HalfAhead&) = delete;

    /// Moves those of `bodies` that are awake half a step of `h` > 0 [s] ahead, for the coming
    /// tick, which begins `time` [s] after the frame that `ways` are of. True where one did move.
    bool move(std::span<btRigidBody* const> bodies, btScalar h, DrivenWays& ways, btScalar time) {
        bool any = !ways.empty();
        ways.place(time, h / 2, time + h);
        ways_ = &ways;
        end_ = time + h;
        middles_.assign(bodies.size(), {});
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            btRigidBody* body = detail::awake_body(*bodies[i]);
            if (body == nullptr) continue;
            Middle& middle = middles_[i];
            middle.body = body;
            middle.transform = body->getCenterOfMassTransform();
            if (detail::stays(*body, h)) continue;
            middle.transform = detail::moved(*body, middle.transform, h / 2);
            body->setCenterOfMassTransform(middle.transform);
            any = true;
        }
        moved_ = true;
        return any;
    }
    /// The rest of the way, in the tick; the same bodies.
    void finish(std::span<btRigidBody* const> bodies, btScalar h) {
        if (!std::exchange(moved_, false)) return;
        ways_->place(end_, 0, end_);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            btRigidBody* body = detail::awake_body(*bodies[i]);
            if (body == nullptr || detail::stays(*body, h)) continue;
            const btTransform& here = body->getCenterOfMassTransform();
            const bool known = i < middles_.size() && middles_[i].body == body;
            const btScalar hit =
                known ? detail::share_gone(*body, middles_[i].transform, h) : btScalar(1);
            const btScalar share = std::min(btScalar(0.5), hit);
            if (known && !detail::was_pushed(*body, middles_[i].transform, hit * h)) {
                body->setCenterOfMassTransform(
                    detail::moved(*body, middles_[i].transform, share * h));
            } else {
                body->setCenterOfMassTransform(detail::moved(*body, here, (share - hit) * h));
            }
        }
    }

    void updateAction(btCollisionWorld* /*world*/, btScalar h) override {
        finish(MovingBodies::all(world_), h);
    }
    void debugDraw(btIDebugDraw* /*drawer*/) override {}

  private:
    struct Middle {
        const btRigidBody* body = nullptr; ///< null: it was not moved
        btTransform transform = btTransform::getIdentity();
    };

    btDiscreteDynamicsWorld& world_;
    std::vector<Middle> middles_; ///< in the order of the bodies
    bool moved_ = false;
    DrivenWays* ways_ = nullptr;
    btScalar end_ = 0; ///< of the tick, in its frame [s]
};

} // namespace ductile::bullet
