// SPDX-License-Identifier: MIT
//
// The rigid bodies and joints that an engine has to make of a StructureModel.
//
//   member   `pieces` bodies along its axis, a joint between each two, and one at either end that
//            does not carry its node; a joint is that of the section for its share of the length
//   node     a point of the ground, of a footing, of the member that carries it, or of a body of
//            the user's
//
// A joint's frame has z along the member from start to end and lies where the joint is. Its body A
// is the member's: the later piece between two, the last one at the end.
//
// A piece has the mass of its share of the length; a node's mass is a point.
//
// Freedoms are counted: 6 a body, less the axes that its joints hold. More than those of one free
// body (none where a support holds it) is a mechanism whatever the shape; fewer is no proof.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/joint/link_types.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/structure/plan_body.hpp"
#include "ductile/structure/structure_model.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// What a node or a side of a joint hangs on.
struct PlanSeat {
    enum class Kind {
        ground, ///< the static world
        body,   ///< bodies[index]
        own     ///< the user's body at node `index`
    };
    Kind kind = Kind::ground;
    std::size_t index = 0;

    bool operator==(const PlanSeat&) const = default;
};

/// A joint to be made.
struct PlanJoint {
    std::string name;
    std::size_t member;       ///< in the model
    std::size_t a;            ///< body of the member
    PlanSeat b;               ///< another body of it, or what its node hangs on
    JointFrame<double> frame; ///< world
    double length;            ///< of member that it stands for [m]
    SectionJoint<double> joint;
};

/// Where a member is found in the plan.
struct PlanMember {
    std::string name;
    std::size_t first_body, bodies;
    std::size_t first_joint, joints;
    bool start_jointed, end_jointed;
    Vector3<double> from, to; ///< ends of its axis [m]
};

struct StructurePlan {
    std::vector<PlanBody> bodies;
    std::vector<PlanJoint> joints;
    std::vector<PlanMember> members;     ///< as the model's
    std::vector<PlanSeat> seats;         ///< of the nodes
    std::vector<Vector3<double>> places; ///< of the nodes [m]
    /// Bodies that meet at a node without a joint between them: they do not collide.
    std::vector<std::pair<std::size_t, std::size_t>> neighbours;
    Vector3<double> up = Vector3<double>(0, 0, 1);

    /// [kg]
    [[nodiscard]] double mass() const noexcept;
    /// Index of a member.
    /// @throws std::invalid_argument where there is none of this name.
    [[nodiscard]] std::size_t member(std::string_view name) const;
    /// Index of the joint at an end.
    /// @throws std::invalid_argument as member(), and where the member carries its node there.
    [[nodiscard]] std::size_t joint(std::string_view member, MemberEnd end) const;
    /// Index of a member's joint by its number from the start, 0 the first.
    /// @throws std::invalid_argument as member(), and where there is none of this number.
    [[nodiscard]] std::size_t joint(std::string_view member, std::size_t number) const;
    /// Index of a member's body by its number from the start, 0 the first.
    /// @throws std::invalid_argument as member(), and where there is none of this number.
    [[nodiscard]] std::size_t body(std::string_view member, std::size_t piece = 0) const;
};

/// `own`: nodes that hang on bodies of the user's.
/// @throws std::invalid_argument where there is no member, no member ends at a node that is
/// supported or has a mass, or at one of `own`, a mass is where nothing moves, or the structure is
/// a mechanism and may not be.
[[nodiscard]] StructurePlan make_plan(const StructureModel& model,
                                      std::span<const NodeId> own = {});

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/structure/structure_plan.ipp"
#endif
