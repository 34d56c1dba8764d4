// SPDX-License-Identifier: MIT
//
// The three-storey frame of reference problem P29 in an ODE world as a user makes one: dWorldStep,
// a default World, contacts named to it where there are any.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/member/section_joint.hpp"
#include "ductile/ode/ode.hpp"
#include "ductile/section/i_section.hpp"

namespace ductile::test {

struct FrameSettings {
    bool elastic = true;
    double weights = 1; ///< factor on gravity
    bool loose = false; ///< on footings of 0.6 × 0.6 × 0.3 m, 260 kg, that lie on the ground
    int crates = 0;     ///< of 1 t on every beam
    int frames = 1;     ///< one on the other, jointed by their columns
    ode::WorldParameters world{};
};

class OdeFrame {
  public:
    using Joint = ode::PlasticJoint<SectionJoint<double>>;
    static constexpr double storey = 3.5, length_x = 6, length_y = 5;
    static constexpr double friction = 0.6;
    /// Depth at which ODE lets a contact rest [m].
    static constexpr double layer = 1e-3;

    explicit OdeFrame(const FrameSettings& settings) : settings_(settings) {
        dWorldSetGravity(id_, 0, 0, dReal(-9.81 * settings.weights));
        dWorldSetContactSurfaceLayer(id_, dReal(layer));
        ode::WorldParameters parameters = settings.world;
        parameters.warn = [this](const std::string& line) { lines_.push_back(line); };
        world_ = std::make_unique<ode::World>(id_, parameters);
        dCreatePlane(space_, 0, 0, 1, 0);
        for (int i = 0; i < settings.frames; ++i) add_frame(i);
    }
    OdeFrame(const OdeFrame&) = delete;
    OdeFrame& operator=(const OdeFrame&) = delete;

    [[nodiscard]] ode::World& world() { return *world_; }
    void step(double dt) {
        for (dBodyID body : bodies_) apply_damping(body);
        dSpaceCollide(space_, this, &OdeFrame::touch);
        world_->step(dt);
        dJointGroupEmpty(contacts_);
        events_ += world_->events().size();
    }
    void run(double time, double dt) {
        for (int i = 0, n = int(time / dt + 0.5); i < n; ++i) step(dt);
    }
    /// By forces in proportion to mass and velocity [1/s].
    void damp(double rate) { damping_ = rate; }
    void let_sleep(bool yes = true) {
        for (dBodyID body : bodies_) dBodySetAutoDisableFlag(body, yes ? 1 : 0);
    }

    void wake() {
        for (dBodyID body : bodies_) dBodyEnable(body);
    }
    void put_one_to_sleep() { dBodyDisable(bodies_.back()); }
    void wake_one() { dBodyEnable(bodies_.back()); }
    /// A kilogramme on a ball joint of ODE's under beam 20: the island is ODE's then.
    void hang_a_lamp() {
        const Vector3<double> below = beam(2, 0) - Vector3<double>(0, 0, 1);
        dBodyID lamp = box(1, Vector3<double>(0.1, 0.1, 0.1), below, false);
        const dJointID ball = dJointCreateBall(id_, nullptr);
        dJointAttach(ball, lamp, beams_[2][0]);
        dJointSetBallAnchor(ball, dReal(below.x()), dReal(below.y()), dReal(below.z() + 1));
    }

    /// Column 00 goes, with its four joints.
    void remove_column() {
        dBodyID column = columns_[0][0];
        remove_joints([column](const Joint& joint) {
            return joint.bodies().a == column || joint.bodies().b == column;
        });
        world_->remove(column);
        std::erase(bodies_, column);
        dBodyDestroy(column);
    }
    /// The foot of column 00 goes.
    void cut_foot() {
        Joint* foot = feet_[0];
        remove_joints([foot](const Joint& joint) { return &joint == foot; });
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
        for (dBodyID body : bodies_) most = std::max(most, norm(ode::linear_velocity(body)));
        return most;
    }
    [[nodiscard]] bool asleep() const {
        return std::none_of(bodies_.begin(), bodies_.end(),
                            [](dBodyID body) { return dBodyIsEnabled(body) != 0; });
    }
    [[nodiscard]] bool awake() const {
        return std::all_of(bodies_.begin(), bodies_.end(),
                           [](dBodyID body) { return dBodyIsEnabled(body) != 0; });
    }
    [[nodiscard]] Vector3<double> beam(int level, int number) const {
        return place(beams_[std::size_t(level)][std::size_t(number)]);
    }
    [[nodiscard]] Vector3<double> column(int level, int number) const {
        return place(columns_[std::size_t(level)][std::size_t(number)]);
    }
    /// Largest way of a beam along x or y from where it was made [m].
    [[nodiscard]] double sway() const {
        double most = 0;
        for (std::size_t k = 0; k < beams_.size(); ++k) {
            for (std::size_t b = 0; b < 4; ++b) {
                const Vector3<double> way = difference(place(beams_[k][b]), made_[k][b]);
                most = std::max({most, std::abs(way.x()), std::abs(way.y())});
            }
        }
        return most;
    }
    [[nodiscard]] std::size_t events() const { return events_; }
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
    [[nodiscard]] std::size_t joints() const { return joints_.size(); }
    [[nodiscard]] double mass() const {
        double sum = 0;
        for (dBodyID body : bodies_) sum += ode::mass(body);
        return sum;
    }

  private:
    using Row = std::array<dBodyID, 4>;

    /// First made, last destroyed.
    struct Library {
        Library() { dInitODE2(0); }
        ~Library() { dCloseODE(); }
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    };
    struct Engine {
        Engine() = default;
        ~Engine() {
            dJointGroupDestroy(contacts);
            dSpaceDestroy(space);
            dWorldDestroy(id);
        }
        Engine(const Engine&) = delete;
        Engine& operator=(const Engine&) = delete;
        dWorldID id = dWorldCreate();
        dSpaceID space = dHashSpaceCreate(nullptr);
        dJointGroupID contacts = dJointGroupCreate(0);
    };

    [[nodiscard]] static Vector3<double> place(dBodyID body) {
        return ode::to_core(dBodyGetPosition(body));
    }

    static void touch(void* frame, dGeomID a, dGeomID b) {
        static_cast<OdeFrame*>(frame)->add_contacts(a, b);
    }
    void add_contacts(dGeomID a, dGeomID b) {
        dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        if (body_a == nullptr && body_b == nullptr) return;
        if (body_a != nullptr && body_b != nullptr && dAreConnected(body_a, body_b) != 0) return;
        std::array<dContact, 8> found{};
        const int count = dCollide(a, b, int(found.size()), &found[0].geom, int(sizeof(dContact)));
        for (int i = 0; i < count; ++i) {
            dContact& contact = found[std::size_t(i)];
            contact.surface.mode = dContactApprox1;
            contact.surface.mu = dReal(friction);
            const dJointID joint = dJointCreateContact(id_, contacts_, &contact);
            dJointAttach(joint, body_a, body_b);
            world_->add_contact(joint, contact);
        }
    }
    void apply_damping(dBodyID body) {
        if (damping_ == 0) return;
        ode::add_force(body, scaled(-damping_ * ode::mass(body), ode::linear_velocity(body)),
                       scaled(-damping_, times(ode::inertia(body), ode::angular_velocity(body))));
    }

    dBodyID box(double mass, const Vector3<double>& half, const Vector3<double>& at,
                bool collides) {
        dBodyID body = dBodyCreate(id_);
        dMass inertia;
        dMassSetBoxTotal(&inertia, dReal(mass), dReal(2 * half.x()), dReal(2 * half.y()),
                         dReal(2 * half.z()));
        dBodySetMass(body, &inertia);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(body, 1);
        if (collides) {
            dGeomID shape =
                dCreateBox(space_, dReal(2 * half.x()), dReal(2 * half.y()), dReal(2 * half.z()));
            dGeomSetBody(shape, body);
        }
        world_->add(body);
        bodies_.push_back(body);
        return body;
    }
    void connect(dBodyID a, dBodyID b, const Matrix3<double>& axes, const Vector3<double>& at,
                 const SectionJoint<double>& joint, std::string name) {
        joints_.push_back(
            std::make_unique<Joint>(id_, a, b, Joint::Frame{.origin = at, .axes = axes}, joint));
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

    void add_frame(int number) {
        const Material<double> steel(s355<double>());
        const ISection<double> heb(
            {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});
        const ISection<double> ipe(
            {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107});
        const auto of_columns =
            section_joint(heb, steel, {.length = 0.2, .elastic = settings_.elastic});
        const auto of_beams =
            section_joint(ipe, steel, {.length = 0.3, .elastic = settings_.elastic});
        const Matrix3<double> up = Matrix3<double>::Identity();
        Matrix3<double> along_x, along_y; // columns: x, y, z of the section
        along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;
        along_y << -1, 0, 0, 0, 0, 1, 0, 1, 0;
        constexpr double gap = 0.01;
        const std::array<double, 4> x{0, length_x, length_x, 0}, y{0, 0, length_y, length_y};
        const double footing = settings_.loose ? 0.3 - layer : 0;
        const double base = 3 * storey * number + footing;
        const std::string prefix = number > 0 ? "upper " : "";
        using V3 = Vector3<double>;
        const std::size_t first = columns_.size();
        for (std::size_t k = 0; k < 3; ++k) {
            columns_.emplace_back();
            for (std::size_t c = 0; c < 4; ++c) {
                const double z = base + storey * double(k);
                columns_.back()[c] = box(61.3 * storey, V3(0.1, 0.1, storey / 2 - gap),
                                         V3(x[c], y[c], z + storey / 2), false);
                dBodyID below = nullptr;
                if (first + k > 0) {
                    below = columns_[first + k - 1][c];
                } else if (settings_.loose) {
                    below = box(260, V3(0.3, 0.3, 0.15), V3(x[c], y[c], footing - 0.15), true);
                }
                connect(columns_.back()[c], below, up, V3(x[c], y[c], z), of_columns,
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
                const V3 middle((x[b] + x[next]) / 2, (y[b] + y[next]) / 2, z);
                const double half = length / 2 - 0.1 - gap;
                beams_.back()[b] =
                    box(42.2 * length + 3000, is_x ? V3(half, 0.075, 0.15) : V3(0.075, half, 0.15),
                        middle, settings_.crates > 0);
                made_.back()[b] = middle;
                for (const bool end : {false, true}) {
                    const std::size_t c = end ? next : b;
                    const V3 way = V3(x[c], y[c], z) - middle;
                    connect(beams_.back()[b], columns_[first + k][c], is_x ? along_x : along_y,
                            middle + way / way.norm() * (length / 2 - 0.1), of_beams,
                            prefix + "beam " + std::to_string(k) + std::to_string(b) +
                                (end ? "b" : "a"));
                }
                for (int crate = 0; crate < settings_.crates; ++crate) {
                    const double side = (crate - (settings_.crates - 1) / 2.0) * 1.5;
                    const double above = 0.55 - layer;
                    box(1000, V3(0.4, 0.4, 0.4),
                        middle + (is_x ? V3(side, 0, above) : V3(0, side, above)), true);
                }
            }
        }
    }

    FrameSettings settings_;
    Library library_;
    Engine engine_;
    dWorldID id_ = engine_.id;
    dSpaceID space_ = engine_.space;
    dJointGroupID contacts_ = engine_.contacts;
    std::vector<dBodyID> bodies_;
    std::vector<std::string> names_, lines_;
    std::unique_ptr<ode::World> world_;
    std::vector<std::unique_ptr<Joint>> joints_;
    std::vector<Row> columns_, beams_;
    std::vector<std::array<Vector3<double>, 4>> made_;
    std::array<Joint*, 4> feet_{};
    double damping_ = 0;
    std::size_t events_ = 0;
};

} // namespace ductile::test
