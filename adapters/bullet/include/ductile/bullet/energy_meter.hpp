// SPDX-License-Identifier: MIT
//
// The core's energy ledger of a Bullet world (world/energy_meter.hpp): which bodies, constraints
// and contacts there are. Joints are booked by their joint feedback, contacts by the impulses of
// their manifold points. Rolling and spinning friction are not booked: where a scene uses them they
// stay unexplained.
//
//   EnergyMeter meter(world);
//   meter.before_step();
//   world.stepSimulation(dt, 0);
//   meter.after_step(dt);
//
// The meter turns on joint feedback for constraints that have none (the user's own is only read).
// Contact impulses are written back by Bullet only in SOLVER_USE_WARMSTARTING mode, its default.
// One internal tick per before/after pair: call stepSimulation with maxSubSteps 0.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "ductile/bullet/local_scope.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/energy_meter.hpp"

namespace ductile::bullet {

class EnergyMeter final : public ductile::EnergyMeter {
  public:
    /// The world must outlive the meter. Opens the ledger with what the world holds now.
    explicit EnergyMeter(btDiscreteDynamicsWorld& world);
    /// Takes the feedback it lent away from the constraints again.
    DUCTILE_INLINE ~EnergyMeter();

    /// From now on it lists these alone; null: all again.
    void set_scope(const LocalScope* scope) noexcept { scope_ = scope; }
    /// To be called for a constraint that leaves the world: takes back the feedback lent to it.
    void forget(btTypedConstraint& constraint);
    /// Energy that all rows of a constraint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by(const btTypedConstraint& constraint) const {
        return taken_by_address(&constraint);
    }

  private:
    DUCTILE_INLINE void list_bodies(std::vector<MeteredBody>& bodies) const override;
    DUCTILE_INLINE void list_plastic_joints(
        std::vector<MeteredPlasticJoint>& joints) const override;
    DUCTILE_INLINE void watch_step() override;
    DUCTILE_INLINE void list_joints(std::vector<MeteredJoint>& joints) const override;
    DUCTILE_INLINE void list_contacts(double dt,
                                      std::vector<MeteredContact>& contacts) const override;
    [[nodiscard]] DUCTILE_INLINE Vector3<double> gyroscopic_impulse(const MeteredBody& body,
                                                                    double dt) const override;
    DUCTILE_INLINE void damp(MeteredBody& body, double dt) const override;

    static void list_body(const btRigidBody& body, std::vector<MeteredBody>& bodies);
    static void list_contacts_of(const btPersistentManifold& manifold,
                                 std::vector<MeteredContact>& contacts);

    btDiscreteDynamicsWorld& world_;
    const LocalScope* scope_ = nullptr;
    std::unordered_map<const btTypedConstraint*, std::unique_ptr<btJointFeedback>> lent_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/energy_meter.ipp"
#endif
