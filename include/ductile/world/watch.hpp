// SPDX-License-Identifier: MIT
//
// Watches the joints of a world: turns their reports into events, keeps the worst certificate, and
// counts what was unreliable. It knows joints by number and name only.
//
//   const auto post = watch.add("lamp post");
//   every step:  watch.open(time);  watch.see(post, report);  ...  watch.events()
//
// A joint that is told as unreliable or too coarsely stepped once is not told again, but counted. A
// joint that is broken when first seen (restored from a saved state) is not told as broken.
#pragma once

#include <concepts>
#include <cstddef>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/vocabulary/check.hpp"
#include "ductile/world/joint_event.hpp"

namespace ductile {

/// Worst certificate among the joints of one step, or of all steps. Plain value.
template <std::floating_point S>
struct WorstCertificate {
    S residual = 0;        ///< [m/s | rad/s]
    std::size_t joint = 0; ///< whose; meaningful where the residual is > 0
};

/// Not thread-safe. Allocates where joints are added and events occur, nowhere else.
template <std::floating_point S>
class Watch {
  public:
    using Listener = std::function<void(const JointEvent<S>&)>;
    static constexpr std::size_t nobody = std::size_t(-1); ///< no joint's number

    /// Number of the new joint; numbers are not used again.
    std::size_t add(std::string name, bool broken = false) {
        joints_.push_back({std::move(name), 0, 0, broken, false});
        return joints_.size() - 1;
    }
    /// @throws std::invalid_argument where there is no such joint.
    [[nodiscard]] const std::string& name(std::size_t joint) const { return at(joint).name; }

    /// Is called for every event as it is found, within `see`.
    void on_event(Listener listener) { listener_ = std::move(listener); }

    /// Opens a step that ends at `time` [s]: forgets the events of the last one.
    void open(double time) noexcept {
        time_ = time;
        events_.clear();
        worst_ = {};
        unreliable_ = 0;
    }

    /// The open step goes on until `time` [s]: its next part, of which each joint is seen anew.
    void go_on(double time) noexcept { time_ = time; }

    /// What a joint said of this step, or part.
    void see(std::size_t joint, const JointReport<S>& report) {
        Joint& seen = joints_.at(joint);
        if (report.residual > worst_.residual) worst_ = {report.residual, joint};
        if (report.residual > worst_ever_.residual) worst_ever_ = {report.residual, joint};
        // a joint that does nothing goes on saying what it did last
        if (report.first_yield && !seen.yielded) tell(EventKind::yielded, joint, time_, report);
        seen.yielded = report.first_yield || (seen.yielded && report.plastic_travel > 0);
        if (report.outcome == Outcome::unreliable) {
            ++unreliable_;
            if (seen.unreliable_steps++ == 0) tell(EventKind::unreliable, joint, time_, report);
        }
        if (report.coarse && seen.coarse_steps++ == 0) {
            tell(EventKind::coarse, joint, time_, report);
        }
        const bool broken = report.fracture.has_value();
        if (broken && !seen.broken) {
            tell(EventKind::broke, joint, time_ - double(report.after_break), report);
        }
        seen.broken = broken;
    }

    /// A section of a member opened or closed.
    void tell_section(std::size_t joint, EventKind kind, int section,
                      const JointReport<S>& report) {
        tell(kind, joint, time_, report, section);
    }

    /// Events of the open step, valid until the next one is opened.
    [[nodiscard]] std::span<const JointEvent<S>> events() const noexcept { return events_; }
    [[nodiscard]] const WorstCertificate<S>& worst() const noexcept { return worst_; }
    [[nodiscard]] const WorstCertificate<S>& worst_ever() const noexcept { return worst_ever_; }
    /// Joints of the open step that are unreliable, each counted once per part.
    [[nodiscard]] std::size_t unreliable() const noexcept { return unreliable_; }
    /// Steps, or parts of one, in which a joint was unreliable.
    /// @throws std::invalid_argument where there is no such joint.
    [[nodiscard]] std::size_t unreliable_steps(std::size_t joint) const {
        return at(joint).unreliable_steps;
    }
    /// Steps, or parts of one, that were too long for what the joint did.
    /// @throws std::invalid_argument where there is no such joint.
    [[nodiscard]] std::size_t coarse_steps(std::size_t joint) const {
        return at(joint).coarse_steps;
    }

  private:
    struct Joint {
        std::string name;
        std::size_t unreliable_steps = 0;
        std::size_t coarse_steps = 0;
        bool broken = false;
        bool yielded = false;
    };

    [[nodiscard]] const Joint& at(std::size_t joint) const {
        if (joint >= joints_.size()) {
            check::fail("Watch.joint", double(joint), "",
                        "below " + std::to_string(joints_.size()));
        }
        return joints_[joint];
    }

    void tell(EventKind kind, std::size_t joint, double time, const JointReport<S>& report,
              int section = -1) {
        events_.push_back({kind, joint, joints_[joint].name, time, report, section});
        if (listener_) listener_(JointEvent<S>(events_.back())); // a copy: it may add joints
    }

    std::deque<Joint> joints_; ///< stays in place when a listener adds joints
    std::vector<JointEvent<S>> events_;
    Listener listener_;
    double time_ = 0;
    WorstCertificate<S> worst_, worst_ever_;
    std::size_t unreliable_ = 0;
};

} // namespace ductile
