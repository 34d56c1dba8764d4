// SPDX-License-Identifier: MIT
//
// Bodies of structure_model.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/structure/refuse.hpp"
#include "ductile/structure/structure_model.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/number_text.hpp"

namespace ductile {

DUCTILE_INLINE StructureModel::StructureModel(const StructureParameters& parameters)
    : parameters_(parameters) {
    detail::require_vector("StructureModel.up", parameters.up, true);
    parameters_.up = scaled(1 / norm(parameters.up), parameters.up);
}

DUCTILE_INLINE NodeId StructureModel::node(const Vector3<double>& at) {
    detail::require_vector("StructureModel.node.at", at, false);
    nodes_.push_back({.at = at, .footing = std::nullopt});
    return {nodes_.size() - 1};
}

DUCTILE_INLINE StructureModel::Node& StructureModel::known(const std::string& field, NodeId node) {
    if (node.index < nodes_.size()) return nodes_[node.index];
    const bool unset = node == NodeId{};
    detail::refuse(field, unset ? "no node" : detail::numbered("node", node.index),
                   "a node of this model, which has " + std::to_string(nodes_.size()));
}

DUCTILE_INLINE void StructureModel::add(std::string name, NodeId start, NodeId end,
                                        MemberSection section, MemberOptions p) {
    if (name.empty()) name = detail::numbered("member", members_.size());
    const std::string field = "StructureModel.member(" + name + ").";
    for (const Member& other : members_) {
        if (other.name == name) {
            detail::refuse("StructureModel.member.name", name, "of one member alone");
        }
    }
    const Vector3<double> from = known(field + "start", start).at;
    const Vector3<double> to = known(field + "end", end).at;
    const double length = norm(difference(to, from));
    if (!(length > 0))
        check::fail(field + "length", length, "m", "> 0: its nodes are at one place");
    if (p.pieces < 1) detail::refuse(field + "pieces", std::to_string(p.pieces), ">= 1");
    if (p.joint_length) check::positive(field + "joint_length", *p.joint_length, "m");
    if (!(p.setback >= 0 && p.setback < length / 2)) {
        check::fail(field + "setback", p.setback, "m",
                    "in [0, " + number_text(length / 2, 6) + ") m, half its length");
    }
    detail::require_vector(field + "offset", p.offset, false);
    if (p.up) {
        detail::require_vector(field + "up", *p.up, true);
        const double across = norm(cross(*p.up, difference(to, from))) / (norm(*p.up) * length);
        if (!(across > 1e-6)) detail::refuse(field + "up", detail::text(*p.up), "across its axis");
    }
    check::size_of_beam("StructureModel.member(" + name + ")", length,
                        p.mass_per_length.value_or(section.density * section.area));
    // wider than any beam and than it is long, whatever it is told to weigh
    constexpr double widest = 10;
    const double across =
        std::sqrt(std::max(section.second_moment_x, section.second_moment_y) / section.area);
    if (across > std::max(widest, length)) {
        check::fail(field + "section.radius_of_gyration", across, "m",
                    "<= 10 m, or its length: a section's dimensions are metres");
    }
    check::non_negative(field + "carried_mass", p.carried_mass, "kg");
    check::positive_or_infinite(field + "largest_bending", p.largest_bending, "rad");
    check::positive_or_infinite(field + "largest_twist", p.largest_twist, "rad");
    check::non_negative(field + "wave_damping", p.wave_damping, "s");
    check::non_negative(field + "bending_damping", p.bending_damping, "s");
    const double piece = (length - 2 * p.setback) / p.pieces;
    if (!(p.gap >= 0 && p.gap < piece / 2)) {
        check::fail(field + "gap", p.gap, "m",
                    "in [0, " + number_text(piece / 2, 6) + ") m, half a piece");
    }
    members_.push_back({std::move(name), start, end, std::move(section), std::move(p)});
}

DUCTILE_INLINE void StructureModel::support(NodeId node) {
    Node& at = known("StructureModel.support.node", node);
    if (at.footing) {
        detail::refuse("StructureModel.support.node", detail::numbered("node", node.index),
                       "one without a footing");
    }
    at.supported = true;
}

DUCTILE_INLINE void StructureModel::footing(NodeId node, const FootingParameters& parameters) {
    Node& at = known("StructureModel.footing.node", node);
    if (at.supported || at.footing) {
        detail::refuse("StructureModel.footing.node", detail::numbered("node", node.index),
                       "one without a support");
    }
    check::positive("StructureModel.footing.width", parameters.width, "m");
    check::positive("StructureModel.footing.depth", parameters.depth, "m");
    check::positive("StructureModel.footing.height", parameters.height, "m");
    check::positive("StructureModel.footing.mass", parameters.mass, "kg");
    at.footing = parameters;
}

DUCTILE_INLINE void StructureModel::mass(NodeId node, double mass) {
    Node& at = known("StructureModel.mass.node", node);
    check::positive("StructureModel.mass.mass", mass, "kg");
    at.mass += mass;
}

} // namespace ductile
