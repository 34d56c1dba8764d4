// SPDX-License-Identifier: MIT
//
// A member: a chain of rigid segments with a plastic section between each and the next. Sections
// that hold make one rigid body of what they join, so a member is one body until a section yields,
// and as many bodies as sections flow afterwards. What is said here does not change; state.hpp has
// what does.
//
// Frame of a member: z along it from its start, x the axis that it bends about. A member that is
// clamped at its start has a first segment of no length that is `held`: part of the ground, or of
// whatever holds it.
//
// Lumped segments. Each has half its mass at either end, inertia m s²/4 about its middle: loads
// then act at sections only, and the chain converges as 1/N² (fidelity/struck_cantilever.hpp,
// which also says why it is a little more, 0.251 m s²). The price is 2/N² too much inertia of the
// member as a whole.
//
// Symbols
//   s, m    length and mass of a segment [m], [kg]
//   M_p     plastic moment               [N m]
//   EI      bending stiffness            [N m²]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ductile/joint/usual_joints.hpp"
#include "ductile/material.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/capacity.hpp"
#include "ductile/section/section.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/number_text.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// Rigid. Plain value.
struct MemberSegment {
    double length = std::numeric_limits<double>::quiet_NaN(); ///< s [m], > 0; 0 of one that is held
    double mass = std::numeric_limits<double>::quiet_NaN(); ///< m [kg], > 0; 0 of one that is held
    /// About its middle, along the member's axes [kg m²], > 0.
    Vector3<double> inertia = Vector3<double>::Zero();
    bool held = false; ///< it does not move
};

struct MemberParameters {
    std::vector<MemberSegment> segments; ///< from the start; only the first may be held
    /// Between each segment and the next, as new: one less than segments.
    std::vector<UsualAxisJoint> sections;
    /// EI [N m²], > 0; infinite: rigid below yield, and every blow yields it (blow.hpp).
    double bending_stiffness = std::numeric_limits<double>::infinity();
    /// Of its sections in all axes, a metre long. A member bends about x alone: with these it says
    /// where it would have to bear more of something else than it can. None: that is not looked at.
    std::optional<JointCapacity<double>> all_axes = std::nullopt;
};

/// On the axis of a segment. Plain value.
struct MemberPlace {
    int segment = 0;
    Vector3<double> in_segment = Vector3<double>::Zero(); ///< from its middle, its axes [m]
};

/// Immutable.
class Member {
  public:
    /// @throws std::invalid_argument where a number is missing or out of range.
    explicit Member(MemberParameters parameters) : given_(std::move(parameters)) {
        const std::size_t count = given_.segments.size();
        if (count < 2) check::fail("Member.segments", double(count), "", "2 or more");
        if (given_.sections.size() + 1 != count) {
            check::fail("Member.sections", double(given_.sections.size()), "",
                        std::to_string(count - 1) + ", one less than segments");
        }
        check::positive_or_infinite("Member.bending_stiffness", given_.bending_stiffness, "N m^2");
        for (std::size_t i = 0; given_.all_axes && i < 6; ++i) {
            const std::string name = "[" + std::to_string(i) + "]";
            check::positive("Member.all_axes.capacity" + name, given_.all_axes->capacity[i], "");
            check::positive("Member.all_axes.stiffness" + name, given_.all_axes->stiffness[i], "");
        }
        for (std::size_t k = 0; k < count; ++k) {
            const MemberSegment& segment = given_.segments[k];
            const std::string name = "Member.segments[" + std::to_string(k) + "]";
            if (segment.held) {
                if (k > 0) check::fail(name + ".held", 1.0, "", "0: only the first may be held");
                if (segment.length != 0) check::fail(name + ".length", segment.length, "m", "0");
                if (segment.mass != 0) check::fail(name + ".mass", segment.mass, "kg", "0");
                continue;
            }
            length_ += check::positive(name + ".length", segment.length, "m");
            mass_ += check::positive(name + ".mass", segment.mass, "kg");
            for (int i = 0; i < 3; ++i) {
                check::positive(name + ".inertia", segment.inertia[i], "kg m^2");
            }
        }
        for (std::size_t i = 0; i + 1 < count; ++i) {
            if (given_.sections[i].parameters().stiffness ==
                std::numeric_limits<double>::infinity()) {
                continue;
            }
            check::fail("Member.sections[" + std::to_string(i) + "].stiffness",
                        given_.sections[i].parameters().stiffness, "N m/rad",
                        "infinite: a section that closes would lose what it stores");
        }
    }

    [[nodiscard]] int segments() const noexcept { return int(given_.segments.size()); }
    [[nodiscard]] int sections() const noexcept { return segments() - 1; }
    [[nodiscard]] const MemberSegment& segment(int k) const noexcept {
        return given_.segments[std::size_t(k)];
    }
    /// As new; between segments i and i + 1.
    [[nodiscard]] const UsualAxisJoint& section(int i) const noexcept {
        return given_.sections[std::size_t(i)];
    }
    [[nodiscard]] double bending_stiffness() const noexcept { return given_.bending_stiffness; }
    [[nodiscard]] const std::optional<JointCapacity<double>>& all_axes() const noexcept {
        return given_.all_axes;
    }
    [[nodiscard]] bool clamped() const noexcept { return given_.segments.front().held; }
    [[nodiscard]] double length() const noexcept { return length_; } ///< [m]
    [[nodiscard]] double mass() const noexcept { return mass_; }     ///< of what moves [kg]
    [[nodiscard]] double mass_per_length() const noexcept { return mass_ / length_; }
    /// Where a section is, from the start of the straight member [m].
    [[nodiscard]] double place(int i) const noexcept {
        double sum = 0;
        for (int k = 0; k <= i; ++k) sum += segment(k).length;
        return sum;
    }
    /// The segment at `place` [m] from the start, the first or last one that moves beyond the ends.
    [[nodiscard]] int segment_at(double place) const noexcept {
        int k = clamped() ? 1 : 0;
        for (double end = segment(k).length; k + 1 < segments() && place > end; ++k) {
            end += segment(k + 1).length;
        }
        return k;
    }
    /// How far a place in a segment is from the farther one of its sections [m].
    [[nodiscard]] double from_section(const MemberPlace& at) const noexcept {
        const double half = segment(at.segment).length / 2, z = at.in_segment[2];
        double far = 0;
        if (at.segment > 0) far = std::max(far, half + z);
        if (at.segment < sections()) far = std::max(far, half - z);
        return far;
    }
    /// The same, and where in it; `name`: what is asked for.
    /// @throws std::invalid_argument where that is beyond the ends.
    [[nodiscard]] MemberPlace on_axis(const char* name, double place) const {
        const double hair = 1e-9 * length_; // lengths of segments add up with round-off
        if (!(place >= -hair && place <= length_ + hair)) {
            check::between(name, place, 0.0, length_, "m", true);
        }
        const int k = segment_at(place);
        const double middle = (k > 0 ? this->place(k - 1) : 0) + segment(k).length / 2;
        return {k, {0, 0, place - middle}};
    }

  private:
    MemberParameters given_;
    double length_ = 0, mass_ = 0;
};

struct BeamParameters {
    double length = std::numeric_limits<double>::quiet_NaN(); ///< [m], > 0
    int segments = 32; ///< equal, >= 1, beside one that is held
    /// Of the last segment, in [0, 10]: into a half and what is halved again. A contact takes of a
    /// blow what the segment that it meets takes, x/(1 + x) with x = μ s/(2 G) at an end and μ s/G
    /// within the span, of a striker of mass G: 3 % of P13a's with 32 equal ones, 0.3 % with 4
    /// halvings.
    int halvings = 0;
    bool clamped = false; ///< at its start
    /// A section at its end too, before a stub of 1e-6 of its length: for a joint that keeps the
    /// end from turning.
    bool fixed_end = false;
    /// Plastic rotation at which a section breaks [rad], > 0; infinite: never.
    double largest_bending = std::numeric_limits<double>::infinity();
};

/// `count` equal lumped segments of a member of `length` [m] and `mass` [kg]; `across`: radius of
/// gyration of its section squared, about x, y, and their sum about z [m²].
[[nodiscard]] inline std::vector<MemberSegment> lumped_segments(double length, double mass,
                                                                int count,
                                                                const Vector3<double>& across) {
    constexpr double lumped = 0.251;
    const double s = length / count, m = mass / count;
    const double bent = m * s * s * (count > 1 ? lumped : 1.0 / 12);
    const MemberSegment segment{
        .length = s,
        .mass = m,
        .inertia = {bent + m * across[0], bent + m * across[1], m * across[2]}};
    return std::vector<MemberSegment>(std::size_t(count), segment);
}

/// The last of equal segments halved towards its end, `halvings` times.
[[nodiscard]] inline std::vector<MemberSegment> lumped_segments(double length, double mass,
                                                                int count, int halvings,
                                                                const Vector3<double>& across) {
    std::vector<MemberSegment> segments = lumped_segments(length, mass, count, across);
    for (int i = 0; i < halvings; ++i) {
        const MemberSegment last = segments.back();
        segments.back() = lumped_segments(last.length, last.mass, 2, across).front();
        segments.push_back(segments.back());
    }
    return segments;
}

/// A beam of one section and material that bends about the section's x axis.
/// @throws std::invalid_argument where a number is missing or out of range.
template <BiaxialSection T>
requires std::same_as<typename T::Scalar, double>
[[nodiscard]] Member beam(const T& section, const Material<double>& material,
                          const BeamParameters& parameters) {
    check::positive("Beam.length", parameters.length, "m");
    if (parameters.segments < 1) {
        check::fail("Beam.segments", double(parameters.segments), "", "1 or more");
    }
    constexpr int most_halvings = 10;
    if (parameters.halvings < 0 || parameters.halvings > most_halvings) {
        check::fail("Beam.halvings", double(parameters.halvings), "",
                    "in [0, " + std::to_string(most_halvings) + "]");
    }
    const double area = section.area(), x = section.second_moment(SectionAxis::x) / area,
                 y = section.second_moment(SectionAxis::y) / area;
    if (!(parameters.length * parameters.length > std::max(x, y))) { // metres and millimetres
        check::fail("Beam.length", parameters.length, "m",
                    "more than its section's radius of gyration, " +
                        number_text(std::sqrt(std::max(x, y)), 3) + " m");
    }
    check::size_of_beam("Beam", parameters.length, material.density() * area);
    constexpr double stub_length = 1e-6, stub_mass = 1e-3; // of the beam's
    const double stub = parameters.fixed_end ? stub_length * parameters.length : 0,
                 length = parameters.length - stub, mass = material.density() * area * length;
    MemberParameters member;
    member.segments =
        lumped_segments(length, mass, parameters.segments, parameters.halvings, {x, y, x + y});
    if (parameters.fixed_end) { // of the inertia of a segment of its mass
        MemberSegment end = lumped_segments(length, stub_mass * mass * parameters.segments,
                                            parameters.segments, {x, y, x + y})
                                .front();
        end.length = stub;
        member.segments.push_back(end);
    }
    if (parameters.clamped) {
        member.segments.insert(member.segments.begin(),
                               MemberSegment{.length = 0, .mass = 0, .held = true});
    }
    member.sections.assign(
        member.segments.size() - 1,
        section_hinge(section, material, {.largest_bending = parameters.largest_bending}));
    member.bending_stiffness = material.youngs_modulus() * section.second_moment(SectionAxis::x);
    if constexpr (FullSection<T>) {
        member.all_axes = joint_capacity(section, material, {.length = 1});
    }
    return Member(std::move(member));
}

} // namespace ductile
