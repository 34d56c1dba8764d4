// SPDX-License-Identifier: MIT
//
// What an adapter's own work costs beside the core's: filling the rows before the solve and booking
// the reaction after it, without the engine's solver. Bullet and ODE in double, joints between two
// bodies at rest that hold a third of their strength (ODE's report no force, as none was solved
// for).
//
//   bullet  buildJacobian, getInfo1, getInfo2, then the commit, as the solver and the tick do
//   ode     prepare and commit, as ode::World calls them; ODE fills the rows itself
//
// Time is per joint and step, 100 joints.
#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>
#include <ode/ode.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "ductile/ode/ode.hpp"

namespace {

using OneAxis = ductile::OneAxisJoint<ductile::Perfect<double>>;
using SixAxes = ductile::CoupledJoint<ductile::Ellipsoid<double, 6>, ductile::Perfect<double>>;

constexpr int joints = 100;
constexpr double dt = 1e-3, strength = 40;

OneAxis one_axis() { return OneAxis(ductile::Perfect<double>({.strength = strength})); }
SixAxes six_axes() {
    return SixAxes(
        ductile::Ellipsoid<double, 6>({.capacity = ductile::Vector6<double>::Constant(strength)}),
        ductile::Perfect<double>({.strength = strength}));
}

void report(benchmark::State& state) {
    state.counters["per joint"] =
        benchmark::Counter(double(joints), benchmark::Counter::kIsIterationInvariantRate |
                                               benchmark::Counter::kInvert);
}

// ---- Bullet -------------------------------------------------------------------------------------

static_assert(sizeof(btScalar) == sizeof(double));

/// Two bodies per joint; the world is there to be asked for its step and is never stepped.
class BulletPairs {
  public:
    BulletPairs() {
        world_.getSolverInfo().m_timeStep = dt;
        const btRigidBody::btRigidBodyConstructionInfo info(1, nullptr, nullptr,
                                                            btVector3(0.1, 0.1, 0.1));
        for (int i = 0; i < 2 * joints; ++i) bodies.push_back(std::make_unique<btRigidBody>(info));
    }
    [[nodiscard]] btDynamicsWorld& world() { return world_; }
    std::vector<std::unique_ptr<btRigidBody>> bodies;

  private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

/// The arrays that a solver hands to a constraint for its rows.
class Rows {
  public:
    Rows() {
        info.fps = 1 / dt;
        info.erp = 0.2;
        info.m_J1linearAxis = values_[0].data();
        info.m_J1angularAxis = values_[1].data();
        info.m_J2linearAxis = values_[2].data();
        info.m_J2angularAxis = values_[3].data();
        info.m_constraintError = values_[4].data();
        info.cfm = values_[5].data();
        info.m_lowerLimit = values_[6].data();
        info.m_upperLimit = values_[7].data();
        info.rowskip = skip;
        info.m_numIterations = 10;
        info.m_damping = 1;
    }
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;
    btTypedConstraint::btConstraintInfo2 info{};

  private:
    static constexpr int skip = 4;
    std::array<std::array<btScalar, 6 * skip>, 8> values_{};
};

/// `loaded`: the engine's constraint that carries the reaction.
template <class Constraint, class Loaded>
void bullet_steps(benchmark::State& state, const std::vector<std::unique_ptr<Constraint>>& all,
                  Loaded loaded) {
    Rows rows;
    btTypedConstraint::btConstraintInfo1 count{};
    for (auto _ : state) {
        for (const auto& constraint : all) {
            constraint->buildJacobian();
            constraint->getInfo1(&count);
            if (count.m_numConstraintRows > 0) constraint->getInfo2(&rows.info);
        }
        benchmark::ClobberMemory();
        for (std::size_t i = 0; i < all.size(); ++i) {
            loaded(i).internalSetAppliedImpulse(0.3 * strength * dt);
            benchmark::DoNotOptimize(all[i]->outcome());
        }
    }
    for (const auto& constraint : all) {
        if (constraint->outcome() != ductile::Outcome::elastic) state.SkipWithError("must hold");
    }
    report(state);
}

template <class Constraint, class Joint>
void bullet_joint(benchmark::State& state, Joint joint) {
    BulletPairs pairs;
    std::vector<std::unique_ptr<Constraint>> all;
    const btTransform frame = btTransform::getIdentity();
    for (std::size_t i = 0; i < joints; ++i) {
        all.push_back(std::make_unique<Constraint>(*pairs.bodies[2 * i], *pairs.bodies[2 * i + 1],
                                                   frame, frame, joint));
    }
    bullet_steps(state, all, [&](std::size_t i) -> btTypedConstraint& { return *all[i]; });
}

void bullet_motor(benchmark::State& state) {
    BulletPairs pairs;
    std::vector<std::unique_ptr<btHingeConstraint>> hinges;
    std::vector<std::unique_ptr<ductile::bullet::PlasticMotor<OneAxis>>> all;
    const btTransform frame = btTransform::getIdentity();
    for (std::size_t i = 0; i < joints; ++i) {
        hinges.push_back(std::make_unique<btHingeConstraint>(
            *pairs.bodies[2 * i], *pairs.bodies[2 * i + 1], frame, frame, true));
        all.push_back(
            std::make_unique<ductile::bullet::PlasticMotor<OneAxis>>(*hinges.back(), one_axis()));
        all.back()->add_to(pairs.world());
    }
    bullet_steps(state, all, [&](std::size_t i) -> btTypedConstraint& { return *hinges[i]; });
    for (auto& motor : all) motor->remove_from(pairs.world());
}

void bullet_hinge(benchmark::State& state) {
    bullet_joint<ductile::bullet::PlasticHinge<OneAxis>>(state, one_axis());
}
void bullet_slider(benchmark::State& state) {
    bullet_joint<ductile::bullet::PlasticSlider<OneAxis>>(state, one_axis());
}
void bullet_six_axes(benchmark::State& state) {
    bullet_joint<ductile::bullet::PlasticJoint<SixAxes>>(state, six_axes());
}
BENCHMARK(bullet_hinge);
BENCHMARK(bullet_slider);
BENCHMARK(bullet_six_axes);
BENCHMARK(bullet_motor);

// ---- ODE ----------------------------------------------------------------------------------------

/// Two bodies per joint.
class OdePairs {
  public:
    OdePairs() {
        static const bool once = dInitODE2(0) != 0;
        benchmark::DoNotOptimize(once);
        world = dWorldCreate();
        dMass mass;
        dMassSetParameters(&mass, 1, 0, 0, 0, 0.1, 0.1, 0.1, 0, 0, 0);
        for (int i = 0; i < 2 * joints; ++i) {
            bodies.push_back(dBodyCreate(world));
            dBodySetMass(bodies.back(), &mass);
        }
    }
    ~OdePairs() { dWorldDestroy(world); }
    OdePairs(const OdePairs&) = delete;
    OdePairs& operator=(const OdePairs&) = delete;

    dWorldID world = nullptr;
    std::vector<dBodyID> bodies;
};

/// `make(pairs, i)`: the i-th joint.
template <class Make>
void ode_joint(benchmark::State& state, Make make) {
    OdePairs pairs;
    std::vector<decltype(make(pairs, std::size_t{}))> all;
    for (std::size_t i = 0; i < joints; ++i) all.push_back(make(pairs, i));
    for (auto _ : state) {
        for (auto& joint : all) static_cast<ductile::ode::SteppedConstraint&>(*joint).prepare(dt);
        benchmark::ClobberMemory();
        for (auto& joint : all) static_cast<ductile::ode::SteppedConstraint&>(*joint).commit(dt);
        benchmark::ClobberMemory();
    }
    for (auto& joint : all) {
        if (joint->outcome() != ductile::Outcome::elastic) state.SkipWithError("must hold");
    }
    report(state);
}

const auto make_hinge = [](OdePairs& p, std::size_t i) {
    return std::make_unique<ductile::ode::PlasticHinge<OneAxis>>(
        p.world, p.bodies[2 * i], p.bodies[2 * i + 1], ductile::ode::HingeFrame{.axis = {0, 0, 1}},
        one_axis());
};
const auto make_slider = [](OdePairs& p, std::size_t i) {
    return std::make_unique<ductile::ode::PlasticSlider<OneAxis>>(
        p.world, p.bodies[2 * i], p.bodies[2 * i + 1], ductile::Vector3<double>(0, 0, 1),
        one_axis());
};
const auto make_six = [](OdePairs& p, std::size_t i) {
    return std::make_unique<ductile::ode::PlasticJoint<SixAxes>>(
        p.world, p.bodies[2 * i], p.bodies[2 * i + 1], ductile::JointFrame<double>{}, six_axes());
};
const auto make_motor = [](OdePairs& p, std::size_t i) {
    const dJointID hinge = dJointCreateHinge(p.world, nullptr);
    dJointAttach(hinge, p.bodies[2 * i], p.bodies[2 * i + 1]);
    dJointSetHingeAxis(hinge, 0, 0, 1);
    return std::make_unique<ductile::ode::PlasticMotor<OneAxis>>(ductile::ode::hinge_axis(hinge),
                                                                 one_axis());
};

BENCHMARK_CAPTURE(ode_joint, hinge, make_hinge);
BENCHMARK_CAPTURE(ode_joint, slider, make_slider);
BENCHMARK_CAPTURE(ode_joint, six_axes, make_six);
BENCHMARK_CAPTURE(ode_joint, motor, make_motor);

} // namespace
