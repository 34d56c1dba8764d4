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

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/vocabulary/check.hpp"
#include "ductile/world/joint_event.hpp"
#include "ductile/world/joint_warning.hpp"
#include "ductile/world/watch.hpp"

namespace ductile {

/// Takes one line, without its end.
using Warn = std::function<void(const std::string&)>;

inline void warn_on_stderr(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

/// Not thread-safe.
class Supervisor {
  public:
    using Report = JointReport<double>;
    using Ask = std::function<Report()>;
    using Event = JointEvent<double>;
    using Listener = Watch<double>::Listener;

    /// An empty `warn`: nothing is said.
    explicit Supervisor(Warn warn) : warn_(std::move(warn)) {
        watch_.on_event([this](const Event& event) {
            if (event.kind == EventKind::unreliable) unreliable_.add(event);
            if (event.kind == EventKind::coarse) coarse_.add(event);
            if (listener_) listener_(event);
        });
    }
    Supervisor(const Supervisor&) = delete;
    Supervisor& operator=(const Supervisor&) = delete;

    // ---- joints

    /// One of which nothing can become, until it is said otherwise, is not asked.
    void set_idle(const void* joint, bool idle) {
        const auto found = find(joint);
        if (found != joints_.end()) found->idle = idle;
    }

    /// Number of the joint in the watch. An empty `name`: "joint 3", with its number.
    /// @throws std::invalid_argument where it is here already.
    std::size_t add(const void* joint, std::string name, Ask ask) {
        if (find(joint) != joints_.end()) {
            throw std::invalid_argument("World.add.joint: must not be in the world already");
        }
        if (name.empty()) name = "joint " + std::to_string(added_);
        const std::size_t number = watch_.add(std::move(name), ask().fracture.has_value());
        joints_.push_back({joint, number, std::move(ask)});
        return added_ = number + 1, number;
    }
    /// Also from within a listener. What is not here is left alone.
    void remove(const void* joint) {
        const auto found = find(joint);
        if (found == joints_.end()) return;
        found->joint = nullptr;
        removed_ = true;
        if (!looking_) forget_removed();
    }
    /// Of a joint in the watch; Watch::nobody where it is not here.
    [[nodiscard]] std::size_t number(const void* joint) const {
        const auto found =
            std::find_if(joints_.begin(), joints_.end(),
                         [joint](const Entry& entry) { return entry.joint == joint; });
        return found != joints_.end() ? found->number : Watch<double>::nobody;
    }
    [[nodiscard]] bool knows(const void* joint) const {
        return std::any_of(joints_.begin(), joints_.end(),
                           [joint](const Entry& entry) { return entry.joint == joint; });
    }

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
    void look(double time, const std::function<bool(const void*)>& whom = {}) {
        time_ = time;
        watch_.go_on(time);
        const Looking guard(looking_);
        const std::size_t here = joints_.size(); // a listener may add more
        for (std::size_t i = 0; i < here; ++i) {
            if (joints_[i].joint == nullptr || joints_[i].idle) continue;
            if (whom && !whom(joints_[i].joint)) continue;
            const Report report = joints_[i].ask();
            watch_.see(joints_[i].number, report);
        }
    }

    /// A section of a member, which is here like a joint, opened or closed.
    void tell_section(const void* member, EventKind kind, int section) {
        const auto found = find(member);
        if (found == joints_.end()) return;
        watch_.tell_section(found->number, kind, section, found->ask());
    }

    /// All parts of the step have been looked at.
    void close() {
        forget_removed();
        for (JointWarning* warning : {&unreliable_, &coarse_}) {
            if (warning->due() && warn_) warn_(warning->line(in_frames_));
        }
    }

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

    void forget_removed() noexcept {
        if (!std::exchange(removed_, false)) return;
        std::erase_if(joints_, [](const Entry& entry) { return entry.joint == nullptr; });
    }

    [[nodiscard]] std::vector<Entry>::iterator find(const void* joint) {
        return std::find_if(joints_.begin(), joints_.end(),
                            [joint](const Entry& entry) { return entry.joint == joint; });
    }

    std::vector<Entry> joints_;
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
