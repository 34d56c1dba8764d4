// SPDX-License-Identifier: MIT
//
// The part of an adapter's World that knows no engine: whom it asks after each step, what it tells,
// and the clock.
//
//   every step:  open();  each part: engine's step, look(time);  close()
//
// Of a joint it knows an address, a name, and whom to ask for its report.
//
// Limit case: without joints it is a clock.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/joint_event.hpp"
#include "ductile/world/joint_warning.hpp"
#include "ductile/world/watch.hpp"

namespace ductile {

/// Takes one line, without its end.
using Warn = std::function<void(const std::string&)>;

void warn_on_stderr(const std::string& line);

/// Not thread-safe.
class Supervisor {
  public:
    using Report = JointReport<double>;
    using Ask = std::function<Report()>;
    using Event = JointEvent<double>;
    using Listener = Watch<double>::Listener;

    /// An empty `warn`: nothing is said.
    explicit Supervisor(Warn warn);
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;

    // ---- joints

    /// One of which nothing can become, until it is said otherwise, is not asked.
    void set_idle(const void* joint, bool idle);

    /// Number of the joint in the watch. An empty `name`: "joint 3", with its number.
    /// @throws std::invalid_argument where it is here already.
    std::size_t add(const void* joint, std::string name, Ask ask);
    /// Also from within a listener. What is not here is left alone.
    void remove(const void* joint);
    /// Of a joint in the watch; Watch::nobody where it is not here.
    [[nodiscard]] std::size_t number(const void* joint) const;
    [[nodiscard]] bool knows(const void* joint) const;

    // ---- what it tells

    [[nodiscard]] const Watch<double>& watch() const noexcept { return watch_; }
    [[nodiscard]] std::span<const Event> events() const noexcept { return watch_.events(); }
    void on_event(Listener listener) { listener_ = std::move(listener); }
    [[nodiscard]] double time() const noexcept { return time_; }
    /// The end of a frame, its parts having summed up to it but for round-off [s].
    void set_time(double time) noexcept { time_ = time; }
    /// One line of its own.
    void say(const std::string& line) const {
        if (warn_) warn_(line);
    }

    /// From now on steps are frames with a tolerance.
    void set_in_frames() noexcept { in_frames_ = true; }

    // ---- around a step

    /// Forgets the events of the last step.
    void open() noexcept { watch_.open(time_); }

    /// Asks all joints after a step, or a part of one, that ended at `time` [s]; those alone of
    /// which `whom` where that is given.
    void look(double time, const std::function<bool(const void*)>& whom = {});

    /// A section of a member, which is here like a joint, opened or closed.
    void tell_section(const void* member, EventKind kind, int section);

    /// All parts of the step have been looked at.
    void close();

  private:
    struct Entry {
        const void* joint; ///< null: removed while all were asked
        std::size_t number;
        Ask ask;
        bool idle = false;
    };

    /// A listener may throw.
    struct Looking {
        explicit Looking(bool& flag) : flag_(flag) { flag_ = true; }
        ~Looking() { flag_ = false; }
        Looking(const Looking&) = delete;
        Looking& operator=(const Looking&) = delete;
        bool& flag_;
    };

    void forget_removed() noexcept;

    /// At the end where it is not here.
    [[nodiscard]] std::vector<Entry>::iterator find(const void* joint);
    [[nodiscard]] std::size_t place(const void* joint) const;

    std::vector<Entry> joints_;
    mutable std::size_t next_ = 0; ///< place that was asked for last: again, or the one behind it
    int idle_ = 0;                 ///< of the joints
    Watch<double> watch_;
    Warn warn_;
    JointWarning unreliable_{unreliable_warning, unreliable_advice};
    JointWarning coarse_{coarse_warning, coarse_advice};
    Listener listener_;
    double time_ = 0;
    std::size_t added_ = 0;
    bool looking_ = false, removed_ = false, in_frames_ = false;
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/supervisor.ipp"
#endif
