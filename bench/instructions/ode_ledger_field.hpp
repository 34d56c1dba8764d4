// SPDX-License-Identifier: MIT
//
// The field of ode_field.hpp with hinges that a ductile World looks after and keeps the ledger of.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <optional>
#include <vector>

#include "cost/field.hpp"
#include "ductile/ode/ode.hpp"

namespace bench::cost {

class LedgerField {
    using Hinge = ductile::ode::PlasticHinge<>;

  public:
    explicit LedgerField(const FieldSettings& settings) {
        using ductile::ode::Solver;
        dInitODE();
        engine_ = dWorldCreate();
        world_.emplace(engine_, ductile::ode::WorldParameters{
                                    .solver = settings.direct ? Solver::direct : Solver::quick,
                                    .ledger = true,
                                    .warn = nullptr});
        const int bodies = settings.chain ? settings.count + 1 : 2 * settings.count;
        for (int i = 0; i < bodies; ++i) add_body(settings, i);
        for (int i = 0; i < settings.count; ++i) add_hinge(settings, i);
    }
    ~LedgerField() {
        for (const auto& hinge : hinges_) world_->remove(*hinge);
        hinges_.clear();
        world_.reset();
        dWorldDestroy(engine_);
        dCloseODE();
    }
    LedgerField(const LedgerField&) = delete;
    LedgerField& operator=(const LedgerField&) = delete;

    void step() { world_->step(dt); }

  private:
    void add_body(const FieldSettings& settings, int i) {
        dBodyID body = dBodyCreate(engine_);
        const auto inertia = dReal(body_inertia);
        dMass mass;
        dMassSetParameters(&mass, dReal(body_mass), 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
        dBodySetMass(body, &mass);
        const int side = i % 2 == 0 ? -1 : 1, row = 300, pair = i / 2; // pairs in a square field
        if (settings.chain) {
            dBodySetPosition(body, dReal(2 * half_length * i), 0, 0);
        } else {
            dBodySetPosition(body, dReal(pair_distance * (pair % row) + side * half_length),
                             dReal(pair_distance * (pair / row)), 0);
            dBodySetAngularVel(body, 0, 0, dReal(side * pair_spin));
            dBodySetLinearVel(body, 0, dReal(pair_spin * half_length), 0);
        }
        bodies_.push_back(body);
    }

    void add_hinge(const FieldSettings& settings, int i) {
        const std::size_t first = std::size_t(settings.chain ? i : 2 * i);
        const dReal* at = dBodyGetPosition(bodies_[first]);
        hinges_.push_back(std::make_unique<Hinge>(
            engine_, bodies_[first], bodies_[first + 1],
            ductile::ode::HingeFrame{.anchor = {at[0] + half_length, at[1], at[2]},
                                     .axis = {0, 0, 1}},
            ductile::OneAxisJoint<ductile::Perfect<double>>(
                ductile::Perfect<double>({.strength = settings.strength(i)}))));
        hinges_.back()->add_to(*world_);
    }

    dWorldID engine_ = nullptr;
    std::optional<ductile::ode::World> world_;
    std::vector<dBodyID> bodies_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
};

} // namespace bench::cost
