// SPDX-License-Identifier: MIT
//
// ODE's direct solver, a World with a tolerance, contacts made whenever it asks for them.
#include <ode/ode.h>

#include <algorithm>
#include <array>

#include "ductile/ode/ode.hpp"
#include "ductile/ode/structure.hpp"
#include "ode_engine.hpp"
#include "of_ode.hpp"
#include "stage.hpp"

namespace ductile::scenes {

namespace {

class OdeStage final : public Stage {
  public:
    explicit OdeStage(const StageParameters& parameters) {
        set_gravity(parameters.gravity);
        dWorldSetAutoDisableFlag(engine_.id, 1);
        world_ = std::make_unique<ode::World>(
            engine_.id,
            ode::WorldParameters{.tolerance = parameters.tolerance, .budget = parameters.budget});
        keeps_tolerance_ = parameters.tolerance > 0;
        world_->on_contacts({.space = engine_.space, .group = engine_.contacts}, [this] {
            dSpaceCollide(engine_.space, this, [](void* stage, dGeomID a, dGeomID b) {
                static_cast<OdeStage*>(stage)->touch(a, b);
            });
        });
        if (parameters.floor) floor_ = dCreatePlane(engine_.space, 0, 0, 1, 0);
    }

    [[nodiscard]] const char* engine() const override { return "ode"; }
    [[nodiscard]] bool keeps_tolerance() const override { return keeps_tolerance_; }

    BodyNumber add(const BoxBody& box) override {
        Own& own = own_.emplace_back(Own{box.name});
        own.friction = box.friction;
        if (box.collides || box.mass == 0) {
            own.geom = box.ball ? dCreateSphere(engine_.space, box.half.x())
                                : dCreateBox(engine_.space, 2 * box.half.x(), 2 * box.half.y(),
                                             2 * box.half.z());
        }
        dMatrix3 rotation;
        dRFromAxisAndAngle(rotation, box.turned.x(), box.turned.y(), box.turned.z(),
                           norm(box.turned));
        if (box.mass > 0 || box.driven) {
            own.body = dBodyCreate(engine_.id);
            dMass mass;
            const double kg = box.driven ? 1 : box.mass; // of what is driven it does not matter
            if (box.ball) {
                dMassSetSphereTotal(&mass, kg, box.half.x());
            } else {
                dMassSetBoxTotal(&mass, kg, 2 * box.half.x(), 2 * box.half.y(), 2 * box.half.z());
            }
            dBodySetMass(own.body, &mass);
            if (box.driven) dBodySetKinematic(own.body);
            dBodySetFiniteRotationMode(own.body, 1);
            dBodySetPosition(own.body, box.at.x(), box.at.y(), box.at.z());
            dBodySetRotation(own.body, rotation);
            dBodySetLinearVel(own.body, box.velocity.x(), box.velocity.y(), box.velocity.z());
            if (own.geom != nullptr) dGeomSetBody(own.geom, own.body);
            world_->add(own.body);
        } else {
            dGeomSetPosition(own.geom, box.at.x(), box.at.y(), box.at.z());
            dGeomSetRotation(own.geom, rotation);
            if (!box.collides) dGeomDisable(own.geom);
        }
        return int(own_.size()) - 1;
    }
    BuiltStructure& build(const StructureModel& model, BodyNumber carrier,
                          const std::vector<NodeId>& on) override {
        structure_.reset();
        std::vector<ode::OwnBody> own;
        for (const NodeId node : on) own.push_back({node, body_of(carrier)});
        structure_ = std::make_unique<ode::Structure>(*world_, engine_.space, model, own);
        return *structure_;
    }
    LinkQueries& connect(const std::string& name, BodyNumber a, BodyNumber b,
                         const Vector3<double>& at, const Matrix3<double>& axes,
                         const UsualSixAxisJoint& joint) override {
        using Made = ode::PlasticJoint<UsualSixAxisJoint>;
        return make<Made>(name, a, b, at, Made::Frame{.origin = at, .axes = axes}, joint);
    }
    JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                        const Vector3<double>& at, const Vector3<double>& axis,
                        const UsualAxisJoint& joint) override {
        return turning(name, a, b, at, axis, joint);
    }
    JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                        const Vector3<double>& at, const Vector3<double>& axis,
                        const FatigueAxisJoint& joint) override {
        return turning(name, a, b, at, axis, joint);
    }
    JointQueries& slider(const std::string& name, BodyNumber a, BodyNumber b,
                         const Vector3<double>& at, const Vector3<double>& axis,
                         const UsualAxisJoint& joint) override {
        return make<ode::PlasticSlider<UsualAxisJoint>>(name, a, b, at, axis, joint);
    }

    [[nodiscard]] Vector3<double> place(BodyNumber body) const override {
        return ode::to_core(dBodyGetPosition(own_[std::size_t(body)].body));
    }
    [[nodiscard]] Vector3<double> velocity(BodyNumber body) const override {
        return ode::linear_velocity(own_[std::size_t(body)].body);
    }
    [[nodiscard]] Matrix3<double> axes(BodyNumber body) const override {
        using Rows = Eigen::Matrix<dReal, 3, 4, Eigen::RowMajor>;
        return Rows::Map(dBodyGetRotation(own_[std::size_t(body)].body)).leftCols<3>();
    }
    [[nodiscard]] double speed() const override {
        double most = 0;
        each([&most](dBodyID body) { most = std::max(most, norm(ode::linear_velocity(body))); });
        return most;
    }
    void set_velocity(BodyNumber body, const Vector3<double>& velocity) override {
        dBodyID id = own_[std::size_t(body)].body;
        dBodySetLinearVel(id, velocity.x(), velocity.y(), velocity.z());
        dBodyEnable(id);
    }
    void turn(BodyNumber body, double from, double to, double frame) override {
        dBodySetAngularVel(own_[std::size_t(body)].body, 0, 0, (to - from) / frame);
    }
    void push(BodyNumber body, const Vector3<double>& force) override {
        dBodyID id = own_[std::size_t(body)].body;
        // ODE keeps the forces of all steps that a body sleeps, for the one that wakes it
        dBodyEnable(id);
        dBodyAddForce(id, force.x(), force.y(), force.z());
    }
    void halt() override {
        each([](dBodyID body) {
            dBodySetLinearVel(body, 0, 0, 0);
            dBodySetAngularVel(body, 0, 0, 0);
        });
    }
    void set_gravity(double gravity) override {
        dWorldSetGravity(engine_.id, 0, 0, -gravity);
        each([](dBodyID body) { dBodyEnable(body); });
    }
    void keep_awake() override {
        each([](dBodyID body) { dBodySetAutoDisableFlag(body, 0); });
    }

    void step(double frame) override {
        world_->step(frame);
        if (recorder_ != nullptr) recorder_->look(*world_);
    }
    [[nodiscard]] const SteppedWorld& world() const override { return *world_; }

    void record(replay::Recorder& recorder) override {
        recorder_ = &recorder;
        if (floor_ != nullptr) replay::add_ground(recorder, floor_, "floor");
        for (const Own& own : own_) {
            if (own.body != nullptr) {
                replay::add_body(recorder, own.body, own.name);
            } else {
                replay::add_ground(recorder, own.geom, own.name);
            }
        }
        if (structure_) {
            const StructurePlan& plan = structure_->plan();
            for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
                if (!structure_->has_body(i)) continue;
                replay::add_body(recorder, structure_->body(i), plan.bodies[i].name);
            }
            for (std::size_t i = 0; i < plan.joints.size(); ++i) {
                if (!structure_->has_joint(i)) continue;
                const Vector3<double>& at = plan.joints[i].frame.origin;
                const auto& joint = *structure_->joint(i);
                const Known known = known_of(joint, plan.joints[i].joint, true);
                replay::add_joint(recorder, joint, plan.joints[i].name, {at.x(), at.y(), at.z()},
                                  facts_of(plan.joints[i].name, known.facts), known.life);
            }
        }
        for (const OwnJoint& own : joints_) {
            replay::add_joint(recorder, *own.joint, own.name, {own.at.x(), own.at.y(), own.at.z()},
                              facts_of(own.name, own.known.facts), own.known.life);
        }
    }

  private:
    [[nodiscard]] BuiltStructure& structure() override { return *structure_; }
    [[nodiscard]] const void* body_of_structure(std::size_t number) const override {
        return structure_->body(number);
    }
    [[nodiscard]] const JointQueries& joint_of_structure(std::size_t number) const override {
        return *structure_->joint(number);
    }
    struct Own {
        std::string name;
        dBodyID body = nullptr;
        dGeomID geom = nullptr;
        double friction = 0;
    };
    struct OwnJoint {
        std::string name;
        Vector3<double> at;
        Known known;
        std::unique_ptr<ode::PlasticConstraint> joint;
    };
    template <class Joint>
    JointQueries& turning(const std::string& name, BodyNumber a, BodyNumber b,
                          const Vector3<double>& at, const Vector3<double>& axis,
                          const Joint& joint) {
        const ode::HingeFrame frame{.anchor = at, .axis = axis};
        return make<ode::PlasticHinge<Joint>>(name, a, b, at, frame, joint);
    }
    template <class Made, class Frame, class Joint>
    Made& make(const std::string& name, BodyNumber a, BodyNumber b, const Vector3<double>& at,
               const Frame& frame, const Joint& joint) {
        auto made = std::make_unique<Made>(engine_.id, body_of(a), body_of(b), frame, joint);
        Made& result = *made;
        world_->add(result, name);
        const bool rotates = !std::is_same_v<Made, ode::PlasticSlider<UsualAxisJoint>>;
        joints_.push_back({name, at, known_of(result, joint, rotates), std::move(made)});
        return result;
    }
    void touch(dGeomID a, dGeomID b) {
        dBodyID on_a = dGeomGetBody(a), on_b = dGeomGetBody(b);
        if (on_a == nullptr && on_b == nullptr) return;
        if (structure_ && structure_->meet(on_a, on_b)) return;
        if (on_a != nullptr && on_b != nullptr && dAreConnected(on_a, on_b) != 0) return;
        std::array<dContact, 8> found{};
        const int count = dCollide(a, b, int(found.size()), &found[0].geom, int(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[std::size_t(i)];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = friction(a) * friction(b);
            const dJointID joint = dJointCreateContact(engine_.id, engine_.contacts, &contact);
            dJointAttach(joint, on_a, on_b);
            world_->add_contact(joint, contact);
        }
    }
    /// 1 of what is not the user's own.
    [[nodiscard]] double friction(dGeomID geom) const {
        const auto own = std::find_if(own_.begin(), own_.end(),
                                      [geom](const Own& one) { return one.geom == geom; });
        return own == own_.end() ? 1 : own->friction;
    }
    [[nodiscard]] dBodyID body_of(BodyNumber body) const {
        return body == ground ? nullptr : own_[std::size_t(body)].body;
    }
    template <class Visit>
    void each(const Visit& visit) const {
        for (const Own& own : own_) {
            if (own.body != nullptr) visit(own.body);
        }
        if (!structure_) return;
        for (std::size_t i = 0; i < structure_->plan().bodies.size(); ++i) {
            if (structure_->has_body(i)) visit(structure_->body(i));
        }
    }

    OdeEngine engine_; ///< first made, last destroyed
    bool keeps_tolerance_ = false;
    dGeomID floor_ = nullptr;
    std::vector<Own> own_;
    std::unique_ptr<ode::World> world_;
    std::unique_ptr<ode::Structure> structure_;
    std::vector<OwnJoint> joints_;
};

} // namespace

std::unique_ptr<Stage> ode_stage(const StageParameters& parameters) {
    return std::make_unique<OdeStage>(parameters);
}

} // namespace ductile::scenes
