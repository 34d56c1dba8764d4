// SPDX-License-Identifier: MIT
//
// Bodies of world.hpp that concern members and structures; what of these is open and closed, which
// of its constraints they bear, and what they met that they cannot be asked. A part of members.ipp.
#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/bullet/front_solver.hpp"

namespace ductile::bullet {

DUCTILE_INLINE Members& World::members() {
    if (front_ == nullptr) {
        throw std::invalid_argument(
            "World.add.member: must not be added to a btMultiBodyDynamicsWorld");
    }
    if (auto* const members = dynamic_cast<Members*>(members_.get())) return *members;
    auto made = std::make_unique<Members>(world_);
    made->set_ahead(members_->is_ahead());
    front_->set_direct(&made->direct());
    Members& members = *made;
    members_ = std::move(made);
    return members;
}
DUCTILE_INLINE void World::add(Divisible& structure, const std::vector<DivisionReport>& reports) {
    members().add(structure);
    for (const DivisionReport& one : reports) supervisor().add(one.key, one.name, one.ask);
}
DUCTILE_INLINE void World::remove(Divisible& structure,
                                  const std::vector<DivisionReport>& reports) {
    members().remove(structure);
    for (const DivisionReport& one : reports) supervisor().remove(one.key);
}
DUCTILE_INLINE void World::rearranged(const Divisible& structure) {
    members().rearranged(structure);
}
DUCTILE_INLINE void World::add(Member& member, std::string name) {
    Members& all = members();
    for (const auto& line : all.add(member, [this, &member] { remove(member); })) {
        supervisor().say(line);
    }
    supervisor().add(static_cast<const Divisible*>(&member), std::move(name),
                     [&all, &member] { return all.report(member); });
}
DUCTILE_INLINE void World::remove(Member& member) {
    auto* const members = dynamic_cast<Members*>(members_.get());
    if (members == nullptr || !members->has(member)) return;
    supervisor().remove(static_cast<const Divisible*>(&member));
    members->remove(member);
}

DUCTILE_INLINE void Members::note_doubts(Course& course) {
    if (!course.of->doubts()) return;
    any_doubts_ = true;
    note_bodies(std::size_t(&course - members_.data()));
}
DUCTILE_INLINE void Members::forget_doubts() {
    if (!std::exchange(any_doubts_, false)) return;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (!members_[i].of->doubts()) continue;
        members_[i].of->begin();
        note_bodies(i);
    }
}

namespace detail {

/// The least extent of what a shape is made of [m]: who goes no farther at a time is seen to pass.
[[nodiscard]] DUCTILE_INLINE btScalar thickness(const btCollisionShape& shape) {
    if (shape.isCompound()) {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        btScalar least = BT_LARGE_FLOAT;
        for (int i = 0; i < compound.getNumChildShapes(); ++i) {
            least = std::min(least, thickness(*compound.getChildShape(i)));
        }
        return least;
    }
    btVector3 low, high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    const btVector3 extent = high - low;
    return extent[extent.minAxis()];
}

/// The way of a driven body from one place to another, at one speed.
class DrivenWay {
  public:
    DrivenWay(const btRigidBody& body, const btTransform& from, const btTransform& to)
        : from_(from), shape_(*body.getCollisionShape()) {
        btTransformUtil::calculateVelocity(from, to, 1, velocity_, spin_);
        const btScalar turns = spin_.length() * ShapeReach().of(shape_);
        length_ = velocity_.length() + turns;
        btVector3 low, high;
        shape_.getAabb(from, low_, high_);
        shape_.getAabb(to, low, high);
        low_.setMin(low);
        high_.setMax(high);
        low_ -= btVector3(turns, turns, turns);
        high_ += btVector3(turns, turns, turns);
    }
    [[nodiscard]] const btVector3& low() const noexcept { return low_; }
    [[nodiscard]] const btVector3& high() const noexcept { return high_; }
    /// How often it has to be looked at not to pass `other` unseen.
    [[nodiscard]] int looks(const btCollisionShape& other) const {
        constexpr auto most = btScalar(1000), of_both = btScalar(0.4);
        const btScalar seen = of_both * (thickness(shape_) + thickness(other));
        return int(std::clamp(std::ceil(length_ / seen), btScalar(1), most));
    }
    [[nodiscard]] btTransform at(btScalar share) const {
        btTransform there;
        btTransformUtil::integrateTransform(from_, velocity_, spin_, share, there);
        return there;
    }

  private:
    const btTransform& from_;
    const btCollisionShape& shape_;
    btVector3 velocity_, spin_, low_, high_;
    btScalar length_;
};

} // namespace detail

DUCTILE_INLINE void Members::list_driven() {
    const auto last = std::exchange(driven_, {});
    for (int i = 0; i < world_.getNumCollisionObjects(); ++i) {
        btRigidBody* body = btRigidBody::upcast(world_.getCollisionObjectArray()[i]);
        if (body == nullptr || !body->isKinematicObject()) continue;
        const auto known = std::find_if(last.begin(), last.end(),
                                        [body](const auto& was) { return was.first == body; });
        driven_.emplace_back(
            body, known != last.end() ? known->second : body->getInterpolationWorldTransform());
    }
}

DUCTILE_INLINE void Members::see_driven() {
    struct Near final : btBroadphaseAabbCallback {
        std::vector<btCollisionObject*> objects;
        bool process(const btBroadphaseProxy* proxy) override {
            objects.push_back(static_cast<btCollisionObject*>(proxy->m_clientObject));
            return true;
        }
    };
    struct Touch final : btCollisionWorld::ContactResultCallback {
        bool any = false;
        btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                                 const btCollisionObjectWrapper*, int, int) override {
            any = any || point.getDistance() < 0;
            return 0;
        }
    };
    for (auto& [body, was] : driven_) {
        const btTransform now = body->getWorldTransform();
        const btTransform from = std::exchange(was, now);
        if (from == now) continue;
        const btBroadphaseProxy& proxy = *body->getBroadphaseProxy();
        const detail::DrivenWay way(*body, from, now);
        Near near;
        world_.getBroadphase()->aabbTest(way.low(), way.high(), near);
        for (btCollisionObject* object : near.objects) {
            Course* course = course_of(*object);
            if (course == nullptr || !object->isStaticObject()) continue;
            const btBroadphaseProxy& other = *object->getBroadphaseHandle();
            if ((other.m_collisionFilterGroup & proxy.m_collisionFilterMask) == 0 ||
                (proxy.m_collisionFilterGroup & other.m_collisionFilterMask) == 0) {
                continue;
            }
            Touch touch;
            const int looks = way.looks(*object->getCollisionShape());
            for (int i = looks; i > 0 && !touch.any; --i) {
                if (i < looks) body->setWorldTransform(way.at(btScalar(i) / btScalar(looks)));
                world_.contactPairTest(body, object, touch);
            }
            body->setWorldTransform(now);
            if (!touch.any) continue;
            list(*course);
            course->of->driven_through();
            note_doubts(*course);
        }
    }
}

/// What they carry would be read without these.
DUCTILE_INLINE void Members::require_known() const {
    if (!members_.empty() && !std::isfinite(double(world_.getGravity().length()))) {
        throw std::invalid_argument("World.gravity: must be finite");
    }
    for (int i = 0; !members_.empty() && i < world_.getNumConstraints(); ++i) {
        btTypedConstraint& constraint = *world_.getConstraint(i);
        if (!constraint.isEnabled()) continue;
        const PlasticConstraint* plastic = as_plastic(constraint);
        for (const btRigidBody* body : {&constraint.getRigidBodyA(), &constraint.getRigidBodyB()}) {
            const auto owner = owners_.find(body);
            if (owner == owners_.end()) continue;
            const Course& course = members_[owner->second];
            if (plastic != nullptr && course.of->section_of(*plastic) >= 0) continue;
            course.of->require_attached(constraint);
        }
    }
}

} // namespace ductile::bullet
