// SPDX-License-Identifier: MIT
//
// Contacts of known geometry in Bullet, made where Bullet makes its own: pairs come from the
// broadphase, points from `touch` instead of the bodies' shapes, whoever asks, a tick or somebody
// who wants to know what is near. Shapes are for the broadphase alone: they have to hold all that
// may touch. What is not paired here does not collide.
//
// A tick makes a contact as edge_contact.hpp says (`reach`), or, ahead, as soon as it is nearer
// than the thickness of the thinner part: its row then lets it close and no further.
//
// Not thread-safe.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <new>
#include <utility>
#include <vector>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/convert.hpp"
#include "edge_contact.hpp"

namespace charpy {

/// `a` carries the edge or point, `b` the face; both outlive the contacts.
struct BulletContact {
    const btRigidBody* a = nullptr;
    const btRigidBody* b = nullptr;
    double thickness = 0; ///< of the thinner part, along the normal [m]
    double friction = 0;
    double restitution = 0;
    /// Points nearer than a margin [m], as the bodies are.
    std::function<EdgeContact(double margin)> touch;
    /// Of the two, as they are [m/s]; empty where nothing approaches.
    std::function<double()> closing_speed = {};
};

class BulletContacts final : public btCollisionDispatcher, private btOverlapFilterCallback {
  public:
    explicit BulletContacts(btCollisionConfiguration* configuration)
        : btCollisionDispatcher(configuration) {}

    /// To be called before bodies come into the world.
    void filter(btOverlappingPairCache& cache) { cache.setOverlapFilterCallback(this); }
    /// Returns its number.
    std::size_t add(BulletContact contact) {
        pairs_[key(contact.a, contact.b)].push_back(contacts_.size());
        contacts_.push_back(std::move(contact));
        manifolds_.push_back(nullptr);
        return contacts_.size() - 1;
    }
    /// How contacts are made from now on.
    void make_ahead(bool ahead) { ahead_ = ahead; }
    /// What direct solvers need where contacts are redundant: their pivoting stalls where
    /// symmetric ones reach their bound at once, so no two are quite alike.
    void make_unlike(bool unlike) { unlike_ = unlike; }

    /// True where the last tick had the contact.
    [[nodiscard]] bool made(std::size_t contact) const {
        return manifolds_[contact] != nullptr && manifolds_[contact]->getNumContacts() > 0;
    }
    /// True where it pushed.
    [[nodiscard]] bool pushed(std::size_t contact) const {
        for (int k = 0; made(contact) && k < manifolds_[contact]->getNumContacts(); ++k) {
            if (manifolds_[contact]->getContactPoint(k).getAppliedImpulse() > 0) return true;
        }
        return false;
    }

    // ---- Bullet's side

    bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
        return pairs_.contains(key(a, b));
    }
    btCollisionAlgorithm* findAlgorithm(const btCollisionObjectWrapper* a,
                                        const btCollisionObjectWrapper* b, btPersistentManifold*,
                                        ebtDispatcherQueryType query) override {
        const std::vector<std::size_t>& which =
            pairs_.at(key(a->getCollisionObject(), b->getCollisionObject()));
        static_assert(sizeof(Algorithm) <= sizeof(btConvexConvexAlgorithm)); // what the pool holds
        void* room = allocateCollisionAlgorithm(int(sizeof(Algorithm)));
        return new (room) Algorithm(*this, which, query == BT_CONTACT_POINT_ALGORITHMS);
    }

  private:
    using Key = std::pair<const btCollisionObject*, const btCollisionObject*>;

    class Algorithm final : public btCollisionAlgorithm {
      public:
        Algorithm(BulletContacts& owner, const std::vector<std::size_t>& which, bool of_ticks)
            : owner_(owner), which_(which), of_ticks_(of_ticks) {
            for (const std::size_t i : which_) {
                const BulletContact& contact = owner_.contacts_[i];
                if (of_ticks_) owner_.manifolds_[i] = owner_.getNewManifold(contact.a, contact.b);
            }
        }
        ~Algorithm() override {
            for (const std::size_t i : which_) {
                if (of_ticks_) owner_.releaseManifold(std::exchange(owner_.manifolds_[i], nullptr));
            }
        }
        Algorithm(const Algorithm&) = delete;
        Algorithm& operator=(const Algorithm&) = delete;

        void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                              const btDispatcherInfo& info, btManifoldResult* result) override {
            for (const std::size_t i : which_) {
                if (of_ticks_) {
                    owner_.fill(i, double(info.m_timeStep));
                } else {
                    owner_.tell(i, *result);
                }
            }
        }
        btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*,
                                       const btDispatcherInfo&, btManifoldResult*) override {
            return 1;
        }
        void getAllContactManifolds(btManifoldArray& manifolds) override {
            for (const std::size_t i : which_) {
                if (of_ticks_) manifolds.push_back(owner_.manifolds_[i]);
            }
        }

      private:
        BulletContacts& owner_;
        const std::vector<std::size_t>& which_;
        bool of_ticks_;
    };

    [[nodiscard]] static Key key(const btCollisionObject* a, const btCollisionObject* b) {
        return std::less<>()(a, b) ? Key{a, b} : Key{b, a};
    }
    [[nodiscard]] bool needBroadphaseCollision(btBroadphaseProxy* a,
                                               btBroadphaseProxy* b) const override {
        return pairs_.contains(key(static_cast<btCollisionObject*>(a->m_clientObject),
                                   static_cast<btCollisionObject*>(b->m_clientObject)));
    }

    /// This tick's points of a contact; impulses carry over for warm starting.
    void fill(std::size_t index, double dt) {
        const BulletContact& contact = contacts_[index];
        btPersistentManifold& manifold = *manifolds_[index];
        const double closing = contact.closing_speed ? contact.closing_speed() : 0;
        const EdgeContact found = contact.touch(
            ahead_ ? contact.thickness
                   : reach(manifold.getNumContacts() > 0, contact.thickness, closing, dt));
        std::array<btScalar, 2> impulse{};
        for (int k = 0; k < std::min(found.count, manifold.getNumContacts()); ++k) {
            impulse[std::size_t(k)] = manifold.getContactPoint(k).m_appliedImpulse;
        }
        manifold.clearManifold();
        for (int k = 0; k < found.count; ++k) {
            constexpr double hair = 1e-6, unequal = 0.37; // [m/s], [-]
            const double unlike = hair * (1 + unequal * double(2 * index + std::size_t(k))) * dt;
            add_point(contact, manifold, found.points[std::size_t(k)], impulse[std::size_t(k)],
                      unlike_ ? unlike : 0);
        }
    }
    void add_point(const BulletContact& contact, btPersistentManifold& manifold,
                   const ContactPoint& point, btScalar impulse, double unlike) const {
        using ductile::bullet::to_bullet;
        const btVector3 on_a = to_bullet(point.position);
        const btVector3 on_b = to_bullet(point.position - point.gap * point.normal);
        // ahead, what is apart yet has to close first
        const bool rebounds = !(ahead_ && point.gap > ductile::bullet::closed_gap) &&
                              rebound(contact.restitution, closing_speed(contact, point)) > 0;
        btManifoldPoint entry(contact.a->getCenterOfMassTransform().invXform(on_a),
                              contact.b->getCenterOfMassTransform().invXform(on_b),
                              to_bullet(point.normal),
                              btScalar((rebounds ? 0 : point.gap) + unlike));
        entry.m_positionWorldOnA = on_a;
        entry.m_positionWorldOnB = on_b;
        entry.m_combinedFriction = btScalar(contact.friction);
        entry.m_combinedRestitution = btScalar(rebounds ? contact.restitution : 0);
        entry.m_appliedImpulse = impulse;
        manifold.addManifoldPoint(entry);
    }
    /// How fast the edge closes in on the face at a point of contact [m/s].
    static double closing_speed(const BulletContact& contact, const ContactPoint& point) {
        if (contact.restitution == 0) return 0;
        const btVector3 at = ductile::bullet::to_bullet(point.position);
        const auto velocity = [&at](const btRigidBody& body) {
            return body.getVelocityInLocalPoint(at - body.getCenterOfMassPosition());
        };
        return ductile::bullet::to_core(velocity(*contact.b) - velocity(*contact.a))
            .dot(point.normal);
    }

    /// Points of a contact that are nearer than asked for.
    void tell(std::size_t index, btManifoldResult& result) const {
        using ductile::bullet::to_bullet;
        const BulletContact& contact = contacts_[index];
        btPersistentManifold between(contact.a, contact.b, 0, 0, 0); // says which body is A
        result.setPersistentManifold(&between);
        const EdgeContact found = contact.touch(double(result.m_closestPointDistanceThreshold));
        for (int k = 0; k < found.count; ++k) {
            const ContactPoint& point = found.points[std::size_t(k)];
            result.addContactPoint(to_bullet(point.normal),
                                   to_bullet(point.position - point.gap * point.normal),
                                   btScalar(point.gap));
        }
        result.setPersistentManifold(nullptr);
    }

    std::vector<BulletContact> contacts_;
    std::vector<btPersistentManifold*> manifolds_; ///< null where the bodies are far apart
    std::map<Key, std::vector<std::size_t>> pairs_;
    bool ahead_ = false, unlike_ = false;
};

} // namespace charpy
