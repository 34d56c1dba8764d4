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
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "ductile/frame/frame_control.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/kept_joint.hpp"
#include "ductile/world/ledger.hpp"
#include "ductile/world/supervisor.hpp"

namespace ductile {

class SteppedWorld : private JointKeeper {
  public:
    // ---- stepping

    /// One step of `dt` > 0 [s]; a frame, where the world has a tolerance.
    /// @throws std::invalid_argument where the step is not finite or not positive, or not one that
    /// this engine can do (of its own World), std::logic_error within a step. The world stays as it
    /// was.
    void step(double dt);

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
    [[nodiscard]] const Ledger<double>& ledger() const;
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
    void start_in_frames(const FrameParameters& parameters);
    /// A part of `h` [s], or a blow of none, stands; of all joints, or those of which `whom`.
    void part_stands(double h, const std::function<bool(const void*)>& whom = {});

  private:
    // ---- the engine's

    /// Called before each step of `dt` [s].
    /// @throws what makes it impossible; nothing has changed then.
    virtual void require_possible(double dt) = 0;
    virtual void do_step(double dt) = 0;
    /// A frame of `length` [s] begins, with the bodies and the forces on them as they are. Asked
    /// for where start_in_frames was called.
    [[nodiscard]] DUCTILE_INLINE virtual PartEngine& begin_frame(double /*length*/);
    /// True where nothing was awake in the last frame, and nothing is: the engine then went through
    /// this one of `length` [s], in which nothing is solved.
    [[nodiscard]] virtual bool sleep_through(double /*length*/) { return false; }
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

    DUCTILE_INLINE void joint_stepped() final;

    void go(double dt, double end);

    void do_frame(double length, double end);

    /// False where what it tells is no number.
    bool tell_of_ledger();

    [[nodiscard]] const FrameControl& frames() const;

    void tell_of_forgotten();

    Supervisor supervisor_;
    std::optional<FrameControl> frames_;
    bool stepping_ = false, told_of_ledger_ = false;
    std::atomic<bool> told_of_engine_ = false; ///< that it is stepped by others
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/stepped_world.ipp"
#endif
