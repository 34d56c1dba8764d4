// SPDX-License-Identifier: MIT
//
// What of a world is divisible (divisible.hpp), as its steps see it in any engine. Where nothing
// is, an adapter's Divisibles stand; its Members take their place where a member or a structure is
// added, and a program that adds none does not compile them.
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/member/closing.hpp"
#include "ductile/world/joint_event.hpp"

namespace ductile {

/// `PlasticJoint`: the engine's. Here nothing is.
template <class PlasticJoint>
class Divisibles {
  public:
    using Joint = PlasticJoint;
    /// A section opened or closed: whose reports tell of it, which, what happened.
    using Tell = std::function<void(const void* key, int section, EventKind kind)>;

    Divisibles() = default;
    Divisibles(const Divisibles&) = delete;
    Divisibles& operator=(const Divisibles&) = delete;
    virtual ~Divisibles() = default;

    [[nodiscard]] virtual bool empty() const noexcept { return true; }
    /// Under which a joint is reported, and of which section it is; null: no member's.
    [[nodiscard]] virtual const void* key_of(const Joint& /*joint*/, int& /*section*/) const {
        return nullptr;
    }
    /// Whose body it is; null: no member's.
    [[nodiscard]] virtual const void* owner_of(const void* /*body*/) const { return nullptr; }
    [[nodiscard]] virtual bool any_open() const { return false; }
    /// Of sections that are closed [J]; as PartMotion::closed_work.
    [[nodiscard]] virtual double closed_work() const { return 0; }
    /// Of those that are whole [J]; as PartMotion::idle_work.
    [[nodiscard]] virtual double idle_work() const { return 0; }
    [[nodiscard]] virtual double unmissed_work() const { return 0; }
    /// As PartMotion::closed_share, in the step that was looked at.
    [[nodiscard]] double closed_share() const noexcept { return share_; }
    /// Forces that were applied to members act in the coming solve, too; they do not any more.
    virtual void apply_forces() {}
    virtual void drop_forces() {}
    /// After a step, or a blow, of `dt` [s] that was solved: true where sections have to open.
    [[nodiscard]] virtual bool look(double /*dt*/) { return false; }
    [[nodiscard]] virtual bool look_blow(double /*dt*/) { return false; }
    /// Joints that hold on to members what can move are off, or on again, so that bodies go as they
    /// would without these; false: there are none.
    [[nodiscard]] virtual bool switch_holds(bool /*on*/) const { return false; }
    /// So they go, until the next blow.
    virtual void see_coming() const {}
    /// What the step that stands left in vibration of members that blows opened [J].
    [[nodiscard]] virtual double count_vibration() const { return 0; }
    /// What opened and closed since the last call.
    virtual void tell(const Tell& /*tell*/) {}

  protected:
    double share_ = 0;
};

/// What there is. `None`: the adapter's Divisibles; `Course`: has `of`, the address of its
/// Divisible.
template <class None, class Course>
class DivisibleList : public None {
    using Of = decltype(Course::of);

  public:
    using typename None::Tell;

    [[nodiscard]] bool has(const std::remove_pointer_t<Of>& member) const noexcept {
        return std::any_of(members_.begin(), members_.end(),
                           [&](const Course& course) { return course.of == &member; });
    }
    [[nodiscard]] bool empty() const noexcept override { return members_.empty(); }
    [[nodiscard]] bool any_open() const override {
        return std::any_of(members_.begin(), members_.end(),
                           [](const Course& course) { return !course.of->whole(); });
    }
    [[nodiscard]] double closed_work() const override {
        double sum = 0;
        for (const Course& course : members_) sum += course.of->closed_work();
        return sum;
    }
    [[nodiscard]] double idle_work() const override {
        double sum = 0;
        for (const Course& course : members_) {
            if (course.of->whole()) sum += course.of->closed_work();
        }
        return sum;
    }
    [[nodiscard]] double unmissed_work() const override {
        double least = 0;
        for (const Course& course : members_) {
            const double work = course.of->unmissed_work();
            if (least == 0 || (work > 0 && work < least)) least = work;
        }
        return least;
    }
    [[nodiscard]] bool switch_holds(bool on) const override {
        bool any = false;
        over_holds([&any, on](const auto& hold) { any = hold.switch_on(on) || any; });
        return any;
    }
    void see_coming() const override {
        over_holds([](auto& hold) { hold.see_coming(); });
    }
    void tell(const Tell& tell) override {
        for (const Happened& entry : std::exchange(happened_, {})) {
            tell(entry.of->key_of(entry.section), entry.section, entry.kind);
        }
    }

  protected:
    /// As key_of, of one of them.
    [[nodiscard]] static const void* key_in(const Course& course, const typename None::Joint& joint,
                                            int& section) {
        section = course.of->section_of(joint);
        return section >= 0 ? course.of->key_of(section) : nullptr;
    }
    template <class Visit>
    void over_holds(const Visit& visit) const {
        for (const Course& course : members_) course.of->over_holds(visit);
    }
    void happened(const Course& course, std::span<const int> sections, EventKind kind) {
        for (const int section : sections) happened_.push_back({course.of, section, kind});
    }
    /// What it would have told.
    void forget(const std::remove_pointer_t<Of>& member) {
        std::erase_if(happened_, [&](const Happened& entry) { return entry.of == &member; });
    }

    std::vector<Course> members_;

  private:
    struct Happened {
        Of of;
        int section;
        EventKind kind;
    };
    std::vector<Happened> happened_;
};

} // namespace ductile
