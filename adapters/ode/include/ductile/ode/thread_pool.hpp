// SPDX-License-Identifier: MIT
//
// Lets an ODE world step on several threads, and stops them in the order ODE wants:
//
//   ductile::ode::ThreadPool threads(world, 4);   // before the first step, after the world
//   stepper.step(dt);
//
// Plastic constraints need nothing for it: they act before and after ODE's step, on the thread that
// calls it. ODE spreads islands, and stages of one island, over the threads.
//
// What the library solves has the same bits with and without threads, and so have bodies of at most
// two joints, contacts among them, that dWorldStep solves. With two threads or more it sums what
// the joints of a body give in the order in which threads come to them: of three or more the last
// digit differs from run to run. QuickStep with two or more of them loses more: its threads change
// the velocity of a shared body at once, and now and then a change is lost (seen: up to 9e-3 N s in
// a step of a forest of 32 bars, 0.04 J in 200 steps). The bodies then did not receive what the
// joints' feedback says; an energy ledger shows it as unexplained.
//
// The world and the library's initialisation have to outlive this object.
#pragma once

#include <ode/ode.h>

#include <stdexcept>

namespace ductile::ode {

class ThreadPool {
  public:
    /// `count` >= 1 threads beside the one that steps.
    /// @throws std::invalid_argument where `count` is zero, std::runtime_error where this build of
    /// ODE has no threads or the system gives none.
    ThreadPool(dWorldID world, unsigned count) : world_(world) {
        if (count == 0) throw std::invalid_argument("ThreadPool.count = 0: must be at least 1");
        implementation_ = dThreadingAllocateMultiThreadedImplementation();
        pool_ = implementation_ == nullptr
                    ? nullptr
                    : dThreadingAllocateThreadPool(count, 0, dAllocateFlagBasicData, nullptr);
        if (pool_ == nullptr) {
            if (implementation_ != nullptr) dThreadingFreeImplementation(implementation_);
            throw std::runtime_error("ThreadPool: ODE gave no threads");
        }
        dThreadingThreadPoolServeMultiThreadedImplementation(pool_, implementation_);
        dWorldSetStepThreadingImplementation(
            world_, dThreadingImplementationGetFunctions(implementation_), implementation_);
    }

    ~ThreadPool() {
        dThreadingImplementationShutdownProcessing(implementation_);
        dThreadingFreeThreadPool(pool_);
        dWorldSetStepThreadingImplementation(world_, nullptr, nullptr);
        dThreadingFreeImplementation(implementation_);
    }

    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

  private:
    dWorldID world_;
    dThreadingImplementationID implementation_ = nullptr;
    dThreadingThreadPoolID pool_ = nullptr;
};

} // namespace ductile::ode
