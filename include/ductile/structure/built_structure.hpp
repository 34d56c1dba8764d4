// SPDX-License-Identifier: MIT
//
// A structure in an engine: what may be asked of it and done to it, the same in all. An engine's
// Structure derives from this, makes the bodies and joints of the plan, and answers the private
// questions at the end.
//
// Where a node or a member is, it is the point of its body that was there when the structure was
// made: a node moves with what it hangs on.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/joint/link_types.hpp"
#include "ductile/structure/structure_plan.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/joint_queries.hpp"

namespace ductile {

class BuiltStructure {
  public:
    [[nodiscard]] const StructurePlan& plan() const noexcept { return plan_; }

    // ---- what its joints tell

    /// Largest of all joints (JointQueries::utilisation) [-].
    [[nodiscard]] double utilisation() const;
    /// Name of the joint that has it; empty where there is no joint.
    [[nodiscard]] std::string most_used() const;
    /// Energy that all joints dissipated, and hold [J]; of those that were removed not.
    [[nodiscard]] double absorbed_energy() const;
    [[nodiscard]] double stored_energy() const;
    /// True where a joint of the plan is still there, broken or not.
    [[nodiscard]] bool has_joint(std::size_t index) const noexcept { return joint_there_[index]; }
    [[nodiscard]] bool has_body(std::size_t index) const noexcept { return body_there_[index]; }

    // ---- where it is; world [m]

    /// @throws std::invalid_argument where the node is not of the model, or what it hung on was
    /// removed.
    [[nodiscard]] Vector3<double> place(NodeId node) const;
    [[nodiscard]] Vector3<double> displacement(NodeId node) const;
    /// Downwards.
    [[nodiscard]] double sag(NodeId node) const;
    /// Of the point at `share` of a member's axis, in [0, 1] from its start.
    /// @throws std::invalid_argument where there is no such member, or that piece was removed, or
    /// `share` is out of range.
    [[nodiscard]] Vector3<double> place(std::string_view member, double share = 0.5) const;
    [[nodiscard]] Vector3<double> displacement(std::string_view member, double share = 0.5) const;
    [[nodiscard]] double sag(std::string_view member, double share = 0.5) const;

    // ---- what is done to it

    /// Applies a force at a node for the coming step, world [N]; through the parts of a frame it
    /// goes along with the node. A node that is the ground takes it.
    /// @throws std::invalid_argument as place(), and where the force is not finite.
    void apply(NodeId node, const Vector3<double>& force);
    void apply(std::string_view member, double share, const Vector3<double>& force);
    /// Takes away a member with its joints and those of all that hung on it.
    /// @throws std::invalid_argument where there is no such member, or it was removed.
    void remove(std::string_view member);
    /// Takes away the joint at an end, or that of a number from the start; nothing where it is
    /// gone.
    /// @throws std::invalid_argument as StructurePlan::joint.
    void cut(std::string_view member, MemberEnd end);
    void cut(std::string_view member, std::size_t number);
    /// From now on gravity is `factor` times that at which the structure was made, for all that the
    /// engine's world holds.
    /// @throws std::invalid_argument where it is not finite, or beyond check::reach.
    void scale_weights(double factor);

  protected:
    explicit BuiltStructure(StructurePlan plan);
    BuiltStructure(const BuiltStructure&) = delete;
    BuiltStructure& operator=(const BuiltStructure&) = delete;
    ~BuiltStructure() = default;

    /// To be called when all bodies are made, at the places of the plan as the engine rounds them.
    void made();
    /// Index of a joint or body that is there.
    /// @throws std::invalid_argument where it was removed.
    [[nodiscard]] std::size_t present_joint(std::size_t index) const;
    [[nodiscard]] std::size_t present_body(std::size_t index) const;

    /// A point that moves with a body.
    struct Point {
        PlanSeat seat;
        Vector3<double> at; ///< when it was made, world [m]
    };
    /// @throws std::invalid_argument as place().
    [[nodiscard]] Point point(NodeId node) const;
    [[nodiscard]] Point point(std::string_view member, double share) const;
    /// Where a body was when it was made.
    [[nodiscard]] const JointFrame<double>& made_at(const PlanSeat& seat) const;

  private:
    // ---- the engine's

    /// Place and axes of a body of the plan or of the user's (of the plan's kinds but ground).
    [[nodiscard]] virtual JointFrame<double> frame_of(const PlanSeat& seat) const = 0;
    /// Of a joint that the engine has now.
    [[nodiscard]] virtual const PairQueries& queries(std::size_t joint) const = 0;
    [[nodiscard]] virtual double utilisation_of(std::size_t joint) const {
        return queries(joint).utilisation();
    }
    [[nodiscard]] virtual double absorbed_by(std::size_t joint) const {
        return queries(joint).absorbed_energy();
    }
    [[nodiscard]] virtual double stored_by(std::size_t joint) const {
        return queries(joint).stored_energy();
    }
    /// Adds a force at a place to a body, which is woken.
    virtual void push(const PlanSeat& seat, const Vector3<double>& force,
                      const Vector3<double>& at) = 0;
    virtual void drop_joint(std::size_t joint) = 0;
    virtual void drop_body(std::size_t body) = 0;
    virtual void wake() = 0;
    /// `factor` of the gravity at which the structure was made.
    virtual void set_gravity(double factor) = 0;

    [[nodiscard]] Vector3<double> moved(const Point& point) const;
    void cut_joint(std::size_t index);
    void apply(const Point& point, const Vector3<double>& force);
    void over_joints(const std::function<void(std::size_t)>& visit) const;

    StructurePlan plan_;
    std::vector<bool> joint_there_, body_there_;
    std::vector<JointFrame<double>> body_made_; ///< by body
    std::vector<JointFrame<double>> own_made_;  ///< by node
};

/// A body of the user's, as the engine names it, in place of a support.
template <class Body>
struct UsersBody {
    NodeId node;
    Body body = nullptr;
};

/// One that has all its joints from the start. `JointType`: the engine's plastic joint; `Body`: how
/// it names a body, null: the static world.
template <class World, class JointType, class Body>
class JointedStructure : public BuiltStructure {
  public:
    using Joint = JointType;

    /// The joint at an end of a member, or that of a number from its start.
    /// @throws std::invalid_argument as StructurePlan::joint, and where it was removed.
    [[nodiscard]] Joint& joint(std::string_view member, MemberEnd end) const {
        return *joints_[present_joint(plan().joint(member, end))];
    }
    [[nodiscard]] Joint& joint(std::string_view member, std::size_t number) const {
        return *joints_[present_joint(plan().joint(member, number))];
    }
    /// Those of the plan, in its order; null where one was removed.
    [[nodiscard]] Joint* joint(std::size_t index) const { return joints_[index].get(); }
    [[nodiscard]] virtual Body body(std::size_t index) const = 0;

  protected:
    /// @throws std::invalid_argument as make_plan, and where a body of `own` is null.
    JointedStructure(World& world, const StructureModel& model,
                     const std::vector<UsersBody<Body>>& own)
        : BuiltStructure(plan_with(model, own)), world_(world), own_(plan().seats.size(), nullptr) {
        for (const UsersBody<Body>& one : own) own_[one.node.index] = one.body;
    }
    ~JointedStructure() = default;

    /// Who has a seat of the plan.
    [[nodiscard]] Body at(const PlanSeat& seat) const {
        if (seat.kind == PlanSeat::Kind::ground) return nullptr;
        return seat.kind == PlanSeat::Kind::own ? own_[seat.index] : body(seat.index);
    }

    World& world_;
    std::vector<std::unique_ptr<Joint>> joints_;

  private:
    static StructurePlan plan_with(const StructureModel& model,
                                   const std::vector<UsersBody<Body>>& own) {
        std::vector<NodeId> nodes;
        for (const UsersBody<Body>& one : own) {
            nodes.push_back(one.node);
            if (one.body != nullptr) continue;
            throw std::invalid_argument("Structure.own.body = null at node " +
                                        std::to_string(one.node.index) + ": must be a body");
        }
        return make_plan(model, nodes);
    }
    [[nodiscard]] const PairQueries& queries(std::size_t joint) const override {
        return *joints_[joint];
    }
    void drop_joint(std::size_t joint) override {
        world_.remove(*joints_[joint]);
        joints_[joint].reset();
    }

    std::vector<Body> own_; ///< by node
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/structure/built_structure.ipp"
#endif
