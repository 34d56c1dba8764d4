// SPDX-License-Identifier: MIT
//
// Bullet's default solver, ten iterations, a default World.
#include <btBulletDynamicsCommon.h>

#include <algorithm>

#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/structure.hpp"
#include "of_bullet.hpp"
#include "stage.hpp"

namespace ductile::scenes {

namespace {

class BulletStage final : public Stage {
  public:
    explicit BulletStage(const StageParameters& parameters) {
        engine_.setGravity(btVector3(0, 0, -parameters.gravity));
        bullet::WorldParameters of_world;
        of_world.tolerance = parameters.tolerance;
        of_world.budget = parameters.budget;
        world_ = std::make_unique<bullet::World>(engine_, of_world);
        keeps_tolerance_ = parameters.tolerance > 0;
        if (parameters.floor) {
            // not a plane, which holds a box that slides by one corner a tick: 50 t at 10 m/s tilt
            // and sink by 4 cm a second
            const btVector3 half(500, 500, 10);
            shapes_.push_back(std::make_unique<btBoxShape>(half));
            floor_ = &own(0, "floor", btVector3(0, 0, -half.z()));
            floor_->setFriction(1);
        }
    }
    ~BulletStage() override {
        joints_.clear();
        structure_.reset();
        for (const auto& body : bodies_) engine_.removeRigidBody(body.get());
    }

    [[nodiscard]] const char* engine() const override { return "bullet"; }
    [[nodiscard]] bool keeps_tolerance() const override { return keeps_tolerance_; }

    BodyNumber add(const BoxBody& box) override {
        if (box.ball) {
            shapes_.push_back(std::make_unique<btSphereShape>(box.half.x()));
        } else {
            shapes_.push_back(std::make_unique<btBoxShape>(bullet::to_bullet(box.half)));
            constexpr double hardly = 1e-4; // of all else Bullet rounds the edges by 4 cm [m]
            if (box.sharp) shapes_.back()->setMargin(hardly);
        }
        btRigidBody& body = own(box.mass, box.name, bullet::to_bullet(box.at), box.collides);
        if (const btVector3 turned = bullet::to_bullet(box.turned); turned.length() > 0) {
            btTransform pose = body.getWorldTransform();
            pose.setRotation(btQuaternion(turned, turned.length()));
            body.setCenterOfMassTransform(pose);
        }
        body.setFriction(box.friction);
        body.setLinearVelocity(bullet::to_bullet(box.velocity));
        if (box.driven) {
            body.setCollisionFlags(body.getCollisionFlags() |
                                   btCollisionObject::CF_KINEMATIC_OBJECT);
            body.setActivationState(DISABLE_DEACTIVATION);
        }
        return int(bodies_.size()) - 1;
    }
    BuiltStructure& build(const StructureModel& model, BodyNumber carrier,
                          const std::vector<NodeId>& on) override {
        structure_.reset();
        std::vector<bullet::OwnBody> own;
        for (const NodeId node : on) own.push_back({node, &body_of(carrier)});
        structure_ = std::make_unique<bullet::Structure>(*world_, model, own);
        return *structure_;
    }
    LinkQueries& connect(const std::string& name, BodyNumber a, BodyNumber b,
                         const Vector3<double>& at, const Matrix3<double>& axes,
                         const UsualSixAxisJoint& joint) override {
        return make<bullet::PlasticJoint<UsualSixAxisJoint>>(
            name, a, b, bullet::to_bullet(JointFrame<double>{at, axes}), joint);
    }
    JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                        const Vector3<double>& at, const Vector3<double>& axis,
                        const UsualAxisJoint& joint) override {
        return make<bullet::PlasticHinge<UsualAxisJoint>>(name, a, b, along(axis, at), joint);
    }
    JointQueries& hinge(const std::string& name, BodyNumber a, BodyNumber b,
                        const Vector3<double>& at, const Vector3<double>& axis,
                        const FatigueAxisJoint& joint) override {
        return make<bullet::PlasticHinge<FatigueAxisJoint>>(name, a, b, along(axis, at), joint);
    }
    JointQueries& slider(const std::string& name, BodyNumber a, BodyNumber b,
                         const Vector3<double>& at, const Vector3<double>& axis,
                         const UsualAxisJoint& joint) override {
        return make<bullet::PlasticSlider<UsualAxisJoint>>(name, a, b, along(axis, at), joint);
    }

    [[nodiscard]] Vector3<double> place(BodyNumber body) const override {
        return bullet::to_core(bodies_[std::size_t(body)]->getCenterOfMassPosition());
    }
    [[nodiscard]] Vector3<double> velocity(BodyNumber body) const override {
        return bullet::to_core(bodies_[std::size_t(body)]->getLinearVelocity());
    }
    [[nodiscard]] Matrix3<double> axes(BodyNumber body) const override {
        return bullet::to_core(bodies_[std::size_t(body)]->getCenterOfMassTransform().getBasis());
    }
    [[nodiscard]] double speed() const override {
        double most = 0;
        each([&most](btRigidBody& body) {
            most = std::max(most, body.getLinearVelocity().length());
        });
        return most;
    }
    void set_velocity(BodyNumber body, const Vector3<double>& velocity) override {
        bodies_[std::size_t(body)]->setLinearVelocity(bullet::to_bullet(velocity));
        bodies_[std::size_t(body)]->activate(true);
    }
    void turn(BodyNumber body, double /*from*/, double to, double /*frame*/) override {
        bodies_[std::size_t(body)]->getWorldTransform().setRotation(
            btQuaternion(btVector3(0, 0, 1), to));
    }
    void push(BodyNumber body, const Vector3<double>& force) override {
        bodies_[std::size_t(body)]->applyCentralForce(bullet::to_bullet(force));
    }
    void halt() override {
        each([](btRigidBody& body) {
            body.setLinearVelocity(btVector3(0, 0, 0));
            body.setAngularVelocity(btVector3(0, 0, 0));
        });
    }
    void set_gravity(double gravity) override {
        engine_.setGravity(btVector3(0, 0, -gravity));
        each([](btRigidBody& body) { body.activate(true); });
    }
    void keep_awake() override {
        each([](btRigidBody& body) { body.setActivationState(DISABLE_DEACTIVATION); });
    }

    void step(double frame) override {
        world_->step(frame);
        if (recorder_ != nullptr) recorder_->look(*world_);
    }
    [[nodiscard]] const SteppedWorld& world() const override { return *world_; }

    void record(replay::Recorder& recorder) override {
        recorder_ = &recorder;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (bodies_[i].get() == floor_) continue;
            replay::add_body(recorder, *bodies_[i], names_[i]);
        }
        if (floor_ != nullptr) {
            constexpr double drawn = 50; // [m]
            recorder.add(floor_,
                         {.name = "floor",
                          .shapes = {{replay::ShapeKind::plane, {drawn, drawn, 0}, {}}},
                          .moves = false},
                         [] { return replay::Pose{}; });
        }
        if (structure_) {
            const StructurePlan& plan = structure_->plan();
            for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
                if (!structure_->has_body(i)) continue;
                replay::add_body(recorder, *structure_->body(i), plan.bodies[i].name);
            }
            for (std::size_t i = 0; i < plan.joints.size(); ++i) {
                if (!structure_->has_joint(i)) continue;
                const auto& joint = *structure_->joint(i);
                const Known known = known_of(joint, plan.joints[i].joint, true);
                replay::add_joint(recorder, joint, plan.joints[i].name,
                                  facts_of(plan.joints[i].name, known.facts), known.life);
            }
        }
        for (const OwnJoint& own : joints_) {
            replay::add_joint(recorder, *own.joint, own.name, facts_of(own.name, own.known.facts),
                              own.known.life);
        }
    }

  private:
    struct OwnJoint {
        std::string name;
        Known known;
        std::unique_ptr<bullet::PlasticConstraint> joint;
    };
    [[nodiscard]] BuiltStructure& structure() override { return *structure_; }
    [[nodiscard]] const void* body_of_structure(std::size_t number) const override {
        return structure_->body(number);
    }
    [[nodiscard]] const JointQueries& joint_of_structure(std::size_t number) const override {
        return *structure_->joint(number);
    }
    /// z of the frame is `axis`.
    [[nodiscard]] static btTransform along(const Vector3<double>& axis, const Vector3<double>& at) {
        return btTransform(shortestArcQuat(btVector3(0, 0, 1), bullet::to_bullet(axis)),
                           bullet::to_bullet(at));
    }
    /// `at`: in the world.
    template <class Made, class Joint>
    Made& make(const std::string& name, BodyNumber a, BodyNumber b, const btTransform& at,
               const Joint& joint) {
        btRigidBody& on_a = body_of(a);
        btRigidBody& on_b = body_of(b);
        auto made =
            std::make_unique<Made>(on_a, on_b, on_a.getCenterOfMassTransform().inverse() * at,
                                   on_b.getCenterOfMassTransform().inverse() * at, joint);
        Made& result = *made;
        result.add_to(engine_, true); // joined bodies do not collide
        world_->add(result, name);
        const bool rotates = !std::is_same_v<Made, bullet::PlasticSlider<UsualAxisJoint>>;
        joints_.push_back({name, known_of(result, joint, rotates), std::move(made)});
        return result;
    }
    btRigidBody& own(double mass, std::string name, const btVector3& at, bool collides = true) {
        btVector3 inertia(0, 0, 0);
        btCollisionShape* shape = shapes_.back().get();
        if (mass > 0) shape->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        names_.push_back(std::move(name));
        if (collides) {
            engine_.addRigidBody(bodies_.back().get());
        } else {
            engine_.addRigidBody(bodies_.back().get(), btBroadphaseProxy::StaticFilter, 0);
        }
        return *bodies_.back();
    }
    [[nodiscard]] btRigidBody& body_of(BodyNumber body) const {
        return body == ground ? btTypedConstraint::getFixedBody() : *bodies_[std::size_t(body)];
    }
    /// All that move.
    template <class Visit>
    void each(const Visit& visit) const {
        const btCollisionObjectArray& objects = engine_.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            btRigidBody* body = btRigidBody::upcast(objects[i]);
            if (!body->isStaticOrKinematicObject()) visit(*body);
        }
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::string> names_;
    btRigidBody* floor_ = nullptr; ///< null: there is none
    bool keeps_tolerance_ = false;
    std::unique_ptr<bullet::World> world_;
    std::unique_ptr<bullet::Structure> structure_;
    std::vector<OwnJoint> joints_;
};

} // namespace

std::unique_ptr<Stage> bullet_stage(const StageParameters& parameters) {
    return std::make_unique<BulletStage>(parameters);
}

} // namespace ductile::scenes
