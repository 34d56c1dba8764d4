// SPDX-License-Identifier: MIT
//
// The ways of kinematic bodies over a frame that is done in parts (world/driven_course.hpp): from
// where the last frame left them to where they were put since. Each part sees them where they would
// be in its middle with the velocities that it began with, as it sees all bodies, with the
// velocities of its end.
//
// A step of Bullet's own reads such a body's whole way as that of its first tick, however short,
// and the angle of a short turn off the cosine of its half.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btMotionState.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/world/driven_course.hpp"

namespace ductile::bullet {

class DrivenWays {
  public:
    /// A frame of `length` > 0 [s] begins: the bodies go back to where the last one left them. Who
    /// has a motion state goes where that says.
    void begin(btDiscreteDynamicsWorld& world, btScalar length) {
        std::swap(ways_, last_);
        ways_.clear();
        length_ = length;
        const auto& objects = world.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            btRigidBody* body = btRigidBody::upcast(objects[i]);
            if (body == nullptr || !body->isKinematicObject()) continue;
            Way way{body, body->getInterpolationWorldTransform(), body->getWorldTransform(), {}};
            if (body->getMotionState() != nullptr)
                body->getMotionState()->getWorldTransform(way.to);
            const auto before = std::find_if(last_.begin(), last_.end(),
                                             [body](const Way& last) { return last.body == body; });
            if (before != last_.end()) way.course = before->course;
            btVector3 velocity, spin;
            btTransformUtil::calculateVelocity(way.from, way.to, length, velocity, spin);
            BodyState<double> mean;
            mean.velocity = to_core(velocity);
            mean.spin = to_core(spin);
            way.course.begin(mean, double(length));
            ways_.push_back(way);
        }
        place(0, 0, 0);
    }
    /// Puts the bodies where they are `time` [s] after the frame's begin, and from there on by
    /// `ahead` [s] with the velocities that they have then, which are those of the interpolation;
    /// they have the ones at `end`.
    void place(btScalar time, btScalar ahead, btScalar end) {
        for (const auto& [body, from, to, course] : ways_) {
            const btVector3 velocity = to_bullet(course.velocity(double(time)));
            const btVector3 spin = to_bullet(course.spin(double(time)));
            btTransform now = from;
            if (time >= length_ * (1 - SIMD_EPSILON)) {
                now = to;
            } else if (time > 0) {
                go(now, to_bullet(course.way(double(time))), to_bullet(course.turn(double(time))));
            }
            if (ahead > 0) go(now, velocity * ahead, spin * ahead);
            body->setWorldTransform(now);
            body->setInterpolationWorldTransform(now);
            body->setLinearVelocity(to_bullet(course.velocity(double(end))));
            body->setAngularVelocity(to_bullet(course.spin(double(end))));
            body->setInterpolationLinearVelocity(velocity);
            body->setInterpolationAngularVelocity(spin);
        }
    }
    [[nodiscard]] bool was_misread() const {
        return std::any_of(ways_.begin(), ways_.end(),
                           [](const Way& way) { return way.course.was_misread(); });
    }
    [[nodiscard]] bool empty() const noexcept { return ways_.empty(); }
    /// Calls `see(body)` for each.
    template <class See>
    void each(const See& see) const {
        for (const Way& way : ways_) see(*way.body);
    }

  private:
    static void go(btTransform& transform, const btVector3& way, const btVector3& turn) {
        transform.setOrigin(transform.getOrigin() + way);
        if (!(turn.length2() > 0)) return;
        transform.setRotation(btQuaternion(turn.normalized(), turn.length()) *
                              transform.getRotation());
    }

    struct Way {
        btRigidBody* body;
        btTransform from, to;
        DrivenCourse course;
    };

    std::vector<Way> ways_, last_;
    btScalar length_ = 1;
};

} // namespace ductile::bullet
