// SPDX-License-Identifier: MIT
//
// What a structure is, without an engine: nodes, members of a section and a material between them,
// supports, masses.
//
//   StructureModel portal;
//   const NodeId a = portal.node({0, 0, 0}), b = portal.node({0, 0, 4});
//   const NodeId c = portal.node({6, 0, 4}), d = portal.node({6, 0, 0});
//   portal.member("left", a, b, heb, steel);
//   portal.member("right", d, c, heb, steel);
//   portal.member("beam", b, c, ipe, steel, {.setback = 0.1, .carried_mass = 3000});
//   portal.support(a);
//   portal.support(d);
//   bullet::Structure made(world, portal);      // or ode::Structure made(world, space, portal)
//
// structure_plan.hpp says which bodies and joints become of it.
//
// Axes of a member. z runs from its start to its end, x and y are those of its section: bending
// about x is that about the strong axis of an I section. y points up as far as it can, so that a
// beam bends about x under its weight. In a member along the vertical y is the world's y (its z
// where the vertical is y). `up` of the member chooses another.
//
// Who carries a node. Where members meet at a node without a support, the steepest of them that are
// not freed there carries it, of equally steep ones the first: the node is a part of its last body,
// without a joint, and the others are jointed to that. So a column carries the beams, and the
// column above if it is added before that. Where all are freed the steepest one carries.
//
// Setback and offset say where a member is jointed: its axis is that between the nodes moved by
// `offset`, less `setback` at either end, as a beam ends at the face of a column. What lies between
// the node and the joint is rigid. Weight is counted from node to node.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/joint/joint_axis.hpp"
#include "ductile/material.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/section.hpp"
#include "ductile/structure/joint_stations.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile {

/// A node of the model that made it.
struct NodeId {
    std::size_t index = std::numeric_limits<std::size_t>::max();
    bool operator==(const NodeId&) const = default;
};

/// Either end of a member, in the order in which it was given its nodes.
enum class MemberEnd { start, end };

struct StructureParameters {
    /// True: members are elastic below yield; false: rigid.
    bool elastic = true;
    /// The vertical, any length [-].
    Vector3<double> up = Vector3<double>(0, 0, 1);
    /// True: members may be freed until parts of the structure move freely.
    bool mechanism = false;
};

/// All but nodes, section and material; the defaults are a plain member.
struct MemberOptions {
    int pieces = 1; ///< rigid bodies along it, >= 1
    /// Of member that every joint stands for [m], > 0; none: its share of the length, so that the
    /// stiffness is the member's (joint_stations.hpp).
    std::optional<double> joint_length = std::nullopt;
    JointSpacing spacing = JointSpacing::gauss;
    double setback = 0; ///< of either end from its node, along the axis [m], >= 0
    Vector3<double> offset = Vector3<double>::Zero(); ///< of the axis from the nodes, world [m]
    /// Where the section's y points, as far as it can, world; none: see above.
    std::optional<Vector3<double>> up = std::nullopt;
    /// What either end does not pass on, such as {bending_x, bending_y} for a pin. The joint keeps
    /// a billionth of the stiffness there.
    std::vector<JointAxis> free_at_start{};
    std::vector<JointAxis> free_at_end{};
    std::optional<double> mass_per_length = std::nullopt; ///< [kg/m], > 0; none: rho A
    double carried_mass = 0; ///< that lies on it, spread evenly [kg], >= 0
    /// Plastic rotation by bending, by twist, at which a joint breaks [rad], > 0; infinity: never.
    double largest_bending = std::numeric_limits<double>::infinity();
    double largest_twist = std::numeric_limits<double>::infinity();
    /// Of elastic joints (SectionJointParameters) [s], >= 0.
    double wave_damping = 1e-4, bending_damping = 3e-6;
    double gap = 0;       ///< by which shapes end before the joints [m], >= 0
    bool collides = true; ///< whether it has a shape that others touch
    /// True: the inertia of a piece is that of its box, as engines do it; false: of a bar of this
    /// section.
    bool box_inertia = false;
};

/// A block that lies loose on the ground, its top at the node.
struct FootingParameters {
    /// Along the world's x and y where up is z [m], > 0.
    double width = std::numeric_limits<double>::quiet_NaN();
    double depth = std::numeric_limits<double>::quiet_NaN();
    double height = std::numeric_limits<double>::quiet_NaN(); ///< along up [m], > 0
    double mass = std::numeric_limits<double>::quiet_NaN();   ///< [kg], > 0
};

/// A section as a member knows it, whatever its shape.
struct MemberSection {
    double area = 0;                                                 ///< A [m²]
    double second_moment_x = 0, second_moment_y = 0, product = 0;    ///< I_x, I_y, I_xy [m⁴]
    double lowest_x = 0, highest_x = 0, lowest_y = 0, highest_y = 0; ///< fibres [m]
    double density = 0;                                              ///< rho [kg/m³]
    std::function<SectionJoint<double>(const SectionJointParameters<double>&)> joint;
};

/// Not thread-safe.
class StructureModel {
  public:
    struct Member {
        std::string name;
        NodeId start, end;
        MemberSection section;
        MemberOptions parameters;
    };
    struct Node {
        Vector3<double> at = Vector3<double>::Zero(); ///< world [m]
        double mass = 0;                              ///< [kg]
        bool supported = false;
        std::optional<FootingParameters> footing;
    };

    /// @throws std::invalid_argument where `up` is not finite or zero.
    explicit StructureModel(const StructureParameters& parameters = {});

    /// A node at a place in the world [m].
    /// @throws std::invalid_argument where it is not finite.
    NodeId node(const Vector3<double>& at);

    /// A straight member from one node to another. An empty `name`: "member" and its number.
    /// @throws std::invalid_argument where the name is taken, a node is not of this model, the two
    /// are one or at one place, or a parameter is out of range.
    template <FullSection T>
    requires std::same_as<typename T::Scalar, double>
    void member(std::string name, NodeId start, NodeId end, const T& section,
                const Material<double>& material, MemberOptions parameters = {}) {
        add(std::move(name), start, end,
            {.area = section.area(),
             .second_moment_x = section.second_moment(SectionAxis::x),
             .second_moment_y = section.second_moment(SectionAxis::y),
             .product = section.product_of_inertia(),
             .lowest_x = section.lowest(SectionAxis::y),
             .highest_x = section.highest(SectionAxis::y),
             .lowest_y = section.lowest(SectionAxis::x),
             .highest_y = section.highest(SectionAxis::x),
             .density = material.density(),
             .joint =
                 [section, material](const SectionJointParameters<double>& joint) {
                     return section_joint(section, material, joint);
                 }},
            std::move(parameters));
    }

    /// The node is the ground; members are clamped there but for what they are freed of.
    /// @throws std::invalid_argument where it is not of this model or stands on a footing.
    void support(NodeId node);
    /// The node stands on a loose block, to which members are clamped but for what they are freed
    /// of.
    /// @throws std::invalid_argument where it is not of this model or is supported already, or a
    /// parameter is out of range.
    void footing(NodeId node, const FootingParameters& parameters);
    /// A point mass at the node [kg], > 0; several add up.
    /// @throws std::invalid_argument where it is not of this model or out of range.
    void mass(NodeId node, double mass);

    [[nodiscard]] const StructureParameters& parameters() const noexcept { return parameters_; }
    [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
    [[nodiscard]] const std::vector<Member>& members() const noexcept { return members_; }

  private:
    void add(std::string name, NodeId start, NodeId end, MemberSection section,
             MemberOptions parameters);
    /// @throws std::invalid_argument where it is not of this model.
    [[nodiscard]] Node& known(const std::string& field, NodeId node);

    StructureParameters parameters_;
    std::vector<Node> nodes_;
    std::vector<Member> members_;
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/structure/structure_model.ipp"
#endif
