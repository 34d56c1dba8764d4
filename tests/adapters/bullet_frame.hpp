// SPDX-License-Identifier: MIT
//
// The three-storey frame of reference problem P29 in a Bullet world as a user makes one: Bullet's
// default solver, ten iterations, a default World.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "ductile/material/named.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/section/i_section.hpp"

namespace ductile::test {

struct FrameSettings {
    bool elastic = true;
    double weights = 1;    ///< factor on gravity
    bool loose = false;    ///< on footings of 0.6 × 0.6 × 0.3 m, 260 kg, that lie on the ground
    int crates = 0;        ///< of 1 t on every beam
    int frames = 1;        ///< one on the other, jointed by their columns
    bool contacts = false; ///< members collide
    double wave_damping = 1e-4, bending_damping = 3e-6; ///< of elastic joints [s]
    bullet::WorldParameters world{};
};

class BulletFrame {
  public:
    using Joint = bullet::PlasticJoint<SectionJoint<double>>;
    static constexpr double storey = 3.5, length_x = 6, length_y = 5;

    explicit BulletFrame(const FrameSettings& settings) : settings_(settings) {
        engine_.setGravity(btVector3(0, 0, btScalar(-9.81 * settings.weights)));
        WorldParametersOf parameters = settings.world;
        parameters.warn = [this](const std::string& line) { lines_.push_back(line); };
        world_ = std::make_unique<bullet::World>(engine_, parameters);
        ground_ = &box(0, {50, 50, 1}, {0, 0, -1}, true);
        for (int i = 0; i < settings.frames; ++i) add_frame(i);
    }
    ~BulletFrame() {
        joints_.clear();
        world_.reset();
        for (auto& body : bodies_) engine_.removeRigidBody(body.get());
    }
    BulletFrame(const BulletFrame&) = delete;
    BulletFrame& operator=(const BulletFrame&) = delete;

    [[nodiscard]] bullet::World& world() { return *world_; }
    [[nodiscard]] btDiscreteDynamicsWorld& engine() { return engine_; }
    void step(double dt) {
        world_->step(dt);
        events_ += world_->events().size();
    }
    void run(double time, double dt) {
        for (int i = 0, n = int(time / dt + 0.5); i < n; ++i) step(dt);
    }
    void damp(double per_second) { // share of the velocity lost
        for (auto& body : bodies_) body->setDamping(btScalar(per_second), btScalar(per_second));
    }
    void keep_awake() {
        for (auto& body : bodies_) body->setActivationState(DISABLE_DEACTIVATION);
    }

    /// Column 00 goes, with its four joints.
    void remove_column() {
        btRigidBody* column = columns_[0][0];
        remove_joints([column](const Joint& joint) {
            return &joint.getRigidBodyA() == column || &joint.getRigidBodyB() == column;
        });
        engine_.removeRigidBody(column);
        wake();
    }
    /// The foot of column 00 goes.
    void cut_foot() {
        Joint* foot = feet_[0];
        remove_joints([foot](const Joint& joint) { return &joint == foot; });
        wake();
    }

    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto& joint : joints_) sum += joint->absorbed_energy();
        return sum;
    }
    [[nodiscard]] double stored() const {
        double sum = 0;
        for (const auto& joint : joints_) sum += joint->stored_energy();
        return sum;
    }
    [[nodiscard]] double utilisation() const {
        double most = 0;
        for (const auto& joint : joints_) most = std::max(most, joint->utilisation());
        return most;
    }
    [[nodiscard]] const std::string& most_used() const {
        std::size_t most = 0;
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            if (joints_[i]->utilisation() > joints_[most]->utilisation()) most = i;
        }
        return names_[most];
    }
    [[nodiscard]] double utilisation_of(const std::string& name) const {
        const auto at = std::find(names_.begin(), names_.end(), name);
        return joints_[std::size_t(at - names_.begin())]->utilisation();
    }
    [[nodiscard]] double speed() const {
        double most = 0;
        for (const auto& body : bodies_) {
            most = std::max(most, double(body->getLinearVelocity().length()));
        }
        return most;
    }
    [[nodiscard]] bool asleep() const {
        return std::all_of(bodies_.begin(), bodies_.end(), [](const auto& body) {
            return body->isStaticOrKinematicObject() || !body->isActive() || !body->isInWorld();
        });
    }
    [[nodiscard]] btVector3 beam(int level, int number) const {
        return beams_[std::size_t(level)][std::size_t(number)]->getCenterOfMassPosition();
    }
    [[nodiscard]] btVector3 column(int level, int number) const {
        return columns_[std::size_t(level)][std::size_t(number)]->getCenterOfMassPosition();
    }
    /// Largest way of a beam along x or y from where it was made [m].
    [[nodiscard]] double sway() const {
        double most = 0;
        for (std::size_t k = 0; k < beams_.size(); ++k) {
            for (std::size_t b = 0; b < 4; ++b) {
                const btVector3 way = beams_[k][b]->getCenterOfMassPosition() - made_[k][b];
                most = std::max({most, std::abs(double(way.x())), std::abs(double(way.y()))});
            }
        }
        return most;
    }
    [[nodiscard]] std::size_t events() const { return events_; }
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
    [[nodiscard]] std::size_t joints() const { return joints_.size(); }
    [[nodiscard]] double mass() const {
        double sum = 0;
        for (const auto& body : bodies_) sum += double(body->getMass());
        return sum;
    }

  private:
    using WorldParametersOf = bullet::WorldParameters;
    using Row = std::array<btRigidBody*, 4>;

    btRigidBody& box(double mass, const btVector3& half, const btVector3& at, bool collides) {
        shapes_.push_back(std::make_unique<btBoxShape>(half));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shapes_.back()->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shapes_.back().get(),
                                                      inertia);
        info.m_startWorldTransform.setOrigin(at);
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setFriction(mass > 0 ? btScalar(0.6) : btScalar(1));
        if (collides) {
            engine_.addRigidBody(&body);
        } else {
            engine_.addRigidBody(&body, 0, 0);
        }
        return body;
    }
    void connect(btRigidBody& a, btRigidBody& b, const btMatrix3x3& axes, const btVector3& at,
                 const SectionJoint<double>& joint, std::string name) {
        const btTransform frame(axes, at);
        joints_.push_back(
            std::make_unique<Joint>(a, b, a.getCenterOfMassTransform().inverse() * frame,
                                    b.getCenterOfMassTransform().inverse() * frame, joint));
        world_->add(*joints_.back(), name);
        names_.push_back(std::move(name));
    }
    template <class Which>
    void remove_joints(const Which& which) {
        for (std::size_t i = joints_.size(); i-- > 0;) {
            if (!which(*joints_[i])) continue;
            world_->remove(*joints_[i]);
            joints_.erase(joints_.begin() + std::ptrdiff_t(i));
            names_.erase(names_.begin() + std::ptrdiff_t(i));
        }
    }
    void wake() {
        for (auto& body : bodies_) body->activate(true);
    }

    void add_frame(int number) {
        const Material<double> steel(s355<double>());
        const ISection<double> heb(
            {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});
        const ISection<double> ipe(
            {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107});
        const auto of_columns = section_joint(heb, steel,
                                              {.length = 0.2,
                                               .elastic = settings_.elastic,
                                               .wave_damping = settings_.wave_damping,
                                               .bending_damping = settings_.bending_damping});
        const auto of_beams = section_joint(ipe, steel,
                                            {.length = 0.3,
                                             .elastic = settings_.elastic,
                                             .wave_damping = settings_.wave_damping,
                                             .bending_damping = settings_.bending_damping});
        const btMatrix3x3 up = btMatrix3x3::getIdentity();
        // columns: x, y, z of the section
        const btMatrix3x3 along_x(0, 0, 1, 1, 0, 0, 0, 1, 0), along_y(-1, 0, 0, 0, 0, 1, 0, 1, 0);
        constexpr double gap = 0.01;
        const std::array<double, 4> x{0, length_x, length_x, 0}, y{0, 0, length_y, length_y};
        const double footing = settings_.loose ? 0.3 : 0;
        const double base = 3 * storey * number + footing;
        const std::string prefix = number > 0 ? "upper " : "";
        const bool hits = settings_.contacts || settings_.crates > 0;
        const auto at = [](double px, double py, double pz) {
            return btVector3(btScalar(px), btScalar(py), btScalar(pz));
        };
        const std::size_t first = columns_.size();
        for (std::size_t k = 0; k < 3; ++k) {
            columns_.emplace_back();
            for (std::size_t c = 0; c < 4; ++c) {
                const double z = base + storey * double(k);
                columns_.back()[c] = &box(61.3 * storey, at(0.1, 0.1, storey / 2 - gap),
                                          at(x[c], y[c], z + storey / 2), settings_.contacts);
                btRigidBody* below = ground_;
                if (first + k > 0) {
                    below = columns_[first + k - 1][c];
                } else if (settings_.loose) {
                    below = &box(260, at(0.3, 0.3, 0.15), at(x[c], y[c], 0.15), true);
                }
                connect(*columns_.back()[c], *below, up, at(x[c], y[c], z), of_columns,
                        prefix + "column " + std::to_string(k) + std::to_string(c));
                if (first + k == 0) feet_[c] = joints_.back().get();
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            beams_.emplace_back();
            made_.emplace_back();
            for (std::size_t b = 0; b < 4; ++b) {
                const std::size_t next = (b + 1) % 4;
                const bool is_x = b % 2 == 0;
                const double length = is_x ? length_x : length_y;
                const double z = base + storey * double(k + 1) - 0.15 - gap;
                const btVector3 middle = at((x[b] + x[next]) / 2, (y[b] + y[next]) / 2, z);
                const double half = length / 2 - 0.1 - gap;
                beams_.back()[b] =
                    &box(42.2 * length + 3000, is_x ? at(half, 0.075, 0.15) : at(0.075, half, 0.15),
                         middle, hits);
                made_.back()[b] = middle;
                for (const bool end : {false, true}) {
                    const std::size_t c = end ? next : b;
                    const btVector3 way = (at(x[c], y[c], z) - middle).normalized();
                    connect(*beams_.back()[b], *columns_[first + k][c], is_x ? along_x : along_y,
                            middle + way * btScalar(length / 2 - 0.1), of_beams,
                            prefix + "beam " + std::to_string(k) + std::to_string(b) +
                                (end ? "b" : "a"));
                }
                for (int crate = 0; crate < settings_.crates; ++crate) {
                    const double side = (crate - (settings_.crates - 1) / 2.0) * 1.5;
                    box(1000, at(0.4, 0.4, 0.4),
                        middle + (is_x ? at(side, 0, 0.55) : at(0, side, 0.55)), true);
                }
            }
        }
    }

    FrameSettings settings_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btBoxShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::unique_ptr<bullet::World> world_;
    std::vector<std::unique_ptr<Joint>> joints_;
    std::vector<std::string> names_, lines_;
    std::vector<Row> columns_, beams_;
    std::vector<std::array<btVector3, 4>> made_;
    std::array<Joint*, 4> feet_{};
    btRigidBody* ground_ = nullptr;
    std::size_t events_ = 0;
};

} // namespace ductile::test
