// SPDX-License-Identifier: MIT
//
// What the World of every adapter is: the course of a step and what is told after it. An adapter
// derives from it, knows its engine's joints and bodies, and says how that engine
//
//   goes one step            do_step
//   goes the parts of one    begin_frame
//
// Not thread-safe.
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "ductile/frame/frame_control.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/world/kept_joint.hpp"
#include "ductile/world/ledger.hpp"
#include "ductile/world/supervisor.hpp"

namespace ductile {

class SteppedWorld : private JointKeeper {
  public:
    // ---- stepping

    /// One step of `dt` > 0 [s]; a frame, where the world has a tolerance.
    /// @throws std::invalid_argument where the step is not finite or not positive, or not one that
    /// this engine can do (of its own World). The world stays as it was.
    void step(double dt) {
        check::positive("World.step.dt", dt, "s");
        supervisor_.open();
        look_at_structures();
        if (frames_) {
            do_frame(dt, time() + dt);
        } else {
            go(dt, time() + dt);
        }
    }

    // ---- frames with a tolerance

    /// Of the last step, where the world has a tolerance.
    /// @throws std::logic_error where it has none.
    [[nodiscard]] const FrameReport& frame() const { return frames().last(); }
    /// Of all steps; run().believed() says whether their answer is to be believed.
    /// @throws std::logic_error where the world has no tolerance.
    [[nodiscard]] const RunReport& run() const { return frames().run(); }

    // ---- what it tells

    /// Since this object was made [s].
    [[nodiscard]] double time() const noexcept { return supervisor_.time(); }
    /// @throws std::logic_error where none is kept.
    [[nodiscard]] const Ledger<double>& ledger() const {
        const Ledger<double>* kept = kept_ledger();
        if (kept == nullptr) {
            throw std::logic_error(
                "World.ledger: there is none: not asked for, or not to be had of such a world");
        }
        return *kept;
    }
    [[nodiscard]] bool keeps_ledger() const noexcept { return kept_ledger() != nullptr; }
    /// Of the last step(), valid until the next one.
    [[nodiscard]] std::span<const JointEvent<double>> events() const noexcept {
        return supervisor_.events();
    }
    /// Is called for every event at the end of the step, or its part; it may add and remove joints,
    /// not step.
    void on_event(Supervisor::Listener listener) { supervisor_.on_event(std::move(listener)); }
    /// Worst certificate of the last step(); watch().name() says whose.
    [[nodiscard]] const WorstCertificate<double>& worst() const noexcept { return watch().worst(); }
    [[nodiscard]] const Watch<double>& watch() const noexcept { return supervisor_.watch(); }

  protected:
    explicit SteppedWorld(Warn warn) : supervisor_(std::move(warn)) {}
    ~SteppedWorld() = default;

    [[nodiscard]] Supervisor& supervisor() noexcept { return supervisor_; }
    /// Around what an adapter keeps of a joint.
    using JointKeeper::keep;
    using JointKeeper::let_go;
    using JointKeeper::set_rest_damping;
    /// From the next step on a step is a frame.
    void start_in_frames(const FrameParameters& parameters) {
        frames_.emplace(parameters);
        supervisor_.set_in_frames();
    }
    /// A part of `h` [s], or a blow of none, stands; of all joints, or those of which `whom`.
    void part_stands(double h, const std::function<bool(const void*)>& whom = {}) {
        supervisor_.look(time() + h, whom);
        look_at_structures();
    }

  private:
    // ---- the engine's

    /// Called before each step of `dt` [s].
    /// @throws what makes it impossible; nothing has changed then.
    virtual void require_possible(double dt) = 0;
    virtual void do_step(double dt) = 0;
    /// A frame of `length` [s] begins, with the bodies and the forces on them as they are. Asked
    /// for where start_in_frames was called.
    [[nodiscard]] virtual PartEngine& begin_frame(double /*length*/) {
        throw std::logic_error("World.tolerance: must not be asked of this engine");
    }
    virtual void end_frame() {}
    /// True where a body of this address is known to be in the engine's world; null is not.
    [[nodiscard]] virtual bool has_body(const void* body) const = 0;
    /// Null: none is kept.
    [[nodiscard]] virtual const Ledger<double>* kept_ledger() const noexcept = 0;

    /// A step may throw.
    struct Stepping {
        explicit Stepping(bool& flag) : flag_(flag) { flag_ = true; }
        ~Stepping() { flag_ = false; }
        Stepping(const Stepping&) = delete;
        Stepping& operator=(const Stepping&) = delete;
        bool& flag_;
    };

    void joint_stepped() final {
        if (!stepping_ && !told_of_engine_.exchange(true)) {
            supervisor_.say(
                "ductile: the engine was stepped beside World::step, which clock, events and "
                "ledger miss; step through World::step alone");
        }
    }

    void go(double dt, double end) {
        require_possible(dt);
        {
            const Stepping guard(stepping_);
            do_step(dt);
        }
        supervisor_.look(end);
        look_at_structures();
        (void)tell_of_ledger();
        supervisor_.close();
        tell_of_forgotten();
    }

    void do_frame(double length, double end) {
        require_possible(length);
        {
            const Stepping guard(stepping_);
            frames_->frame(begin_frame(length), length);
            end_frame();
        }
        frames_->count_unreliable(supervisor_.watch().unreliable());
        supervisor_.set_time(end);
        if (const Ledger<double>* kept = kept_ledger()) {
            frames_->tell_contacts(tell_of_ledger() ? kept->brought_in()
                                                    : std::numeric_limits<double>::quiet_NaN());
        }
        supervisor_.close();
        tell_of_forgotten();
    }

    /// False where what it tells is no number.
    bool tell_of_ledger() {
        const Ledger<double>* kept = kept_ledger();
        if (kept == nullptr || std::isfinite(kept->unexplained())) return true;
        if (!std::exchange(told_of_ledger_, true)) {
            std::ostringstream line;
            line << "ductile: the ledger is no number from t = " << time()
                 << " s on; look for what moved or pushed a body so";
            supervisor_.say(line.str());
        }
        return false;
    }

    [[nodiscard]] const FrameControl& frames() const {
        if (!frames_) throw std::logic_error("World.frame: there is none: no tolerance was given");
        return *frames_;
    }

    void tell_of_forgotten() {
        const auto forgotten =
            WaitingJoints::all().take([this](const void* body) { return has_body(body); });
        for (std::size_t i = 0; i < forgotten; ++i) {
            supervisor_.say(
                "ductile: a joint of a body of this world was never added, and does nothing: "
                "World::add it");
        }
    }

    Supervisor supervisor_;
    std::optional<FrameControl> frames_;
    bool stepping_ = false, told_of_ledger_ = false;
    std::atomic<bool> told_of_engine_ = false; ///< that it is stepped by others
};

} // namespace ductile
