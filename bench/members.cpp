// SPDX-License-Identifier: MIT
//
// What does a member cost while nothing yields, while it yields, and afterwards, beside the same
// body without the library and beside one whose sections are always joints? And is what it absorbs
// the same?
//
//   members-bullet-double [--quick] [--csv FILE]
//   members-bullet-double --count SCENE METHOD POSTS STEPS     for bench/members.py, which counts
//                                                              instructions
//
// Scenes
//   standing   posts of 2 m on the ground, four contacts each, awake; steps of 1/60 s
//   clamped    the same posts, static
//   struck     P13a: 1 kg at 4 m/s sticks to the tip of a clamped bar of 2 kg, 20 segments; steps
//              of 0.1 ms, 600 of them
//   truck      1000 clamped posts of P34's section, 2 m, 16 segments; the bumper of 24 t at 15 m/s,
//              0.5 m over the ground and guided along x, goes through thirty of them; steps of
//              1/240 s, frames of 1/60 s
// Methods
//   plain      Bullet alone; of `struck` one rigid body that nothing bends
//   world      a World, no members
//   in-time    members; `frames`: in frames with a tolerance of 1 %
//   jointed    each segment a body, a plastic hinge between each and the next
//
// Columns of the CSV: scene,method,posts,part,median_us,ratio,most_open,absorbed_joule,tip_m. Times
// are CPU times of whole steps, methods taking theirs in turn; ratio: to `plain` of the same scene,
// by post. part: of `truck`, before it strikes, while posts are open, after; its last column counts
// the posts that were bent.
#include <btBulletDynamicsCommon.h>
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cpu_time.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/members.hpp"

namespace {

using namespace ductile;
using Hinge = bullet::PlasticHinge<UsualAxisJoint>;

constexpr double length = 2, half = 0.05, mass = 24.1152;
constexpr int usual = btBroadphaseProxy::DefaultFilter, everything = btBroadphaseProxy::AllFilter;

/// Segments of P13a (`bar`), or of a box of S355, 100 x 100 x 4 mm.
Member description(int segments, bool clamped, bool bar) {
    const double weight = bar ? 2 : mass, reach = bar ? 1 : length, strength = bar ? 100 : 19641.44;
    MemberParameters p;
    p.segments = lumped_segments(reach, weight, segments, {1e-4, 1e-4, 2e-4});
    if (clamped) p.segments.insert(p.segments.begin(), {.length = 0, .mass = 0, .held = true});
    p.sections.assign(p.segments.size() - 1,
                      UsualAxisJoint(Perfect<double>({.strength = strength})));
    if (!bar) p.bending_stiffness = 496312.32; // [N m²]
    return Member(p);
}

struct Settings {
    std::string scene, method;
    int posts = 1000;
    int segments = 16;
};

class Site {
  public:
    explicit Site(const Settings& settings) : settings_(settings) {
        const bool struck = settings.scene == "struck";
        engine_.setGravity(btVector3(0, 0, struck ? btScalar(0) : btScalar(-9.81)));
        engine_.getSolverInfo().m_splitImpulsePenetrationThreshold = 1;
        if (settings.method != "plain") {
            world_ = std::make_unique<bullet::World>(
                engine_,
                bullet::WorldParameters{.ledger = settings.method == "ledger",
                                        .tolerance = settings.method == "frames" ? 0.01 : 0.0,
                                        .rest_damping = 0,
                                        .warn = {}});
        }
        if (struck) {
            strike();
            return;
        }
        ground();
        for (int i = 0; i < settings.posts; ++i) post(i);
        for (btRigidBody* of : posts_) make_member(*of);
        if (settings.scene == "truck") truck();
    }
    ~Site() {
        members_.clear();
        hinges_.clear();
        for (auto& constraint : constraints_) engine_.removeConstraint(constraint.get());
        world_.reset();
        for (auto& body : bodies_) engine_.removeRigidBody(body.get());
    }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    void step(double dt) {
        if (world_ != nullptr) {
            world_->step(dt);
        } else {
            engine_.stepSimulation(btScalar(dt), 0);
        }
    }
    [[nodiscard]] int open() const {
        return int(std::count_if(members_.begin(), members_.end(),
                                 [](const auto& member) { return !member->whole(); }));
    }
    [[nodiscard]] int bent() const {
        return int(std::count_if(members_.begin(), members_.end(),
                                 [](const auto& member) { return member->absorbed_energy() > 0; }));
    }
    [[nodiscard]] double absorbed() const {
        double sum = 0;
        for (const auto& member : members_) sum += member->absorbed_energy();
        for (const auto& hinge : hinges_) sum += hinge->absorbed_energy();
        return sum;
    }
    /// Of what struck.
    [[nodiscard]] btVector3 place() const { return striker_->getCenterOfMassPosition(); }

  private:
    btCollisionShape* keep(std::unique_ptr<btCollisionShape> shape) {
        shapes_.push_back(std::move(shape));
        return shapes_.back().get();
    }
    btRigidBody& body(double kilograms, const btVector3& inertia, const btVector3& at,
                      btCollisionShape* shape, bool collides = true) {
        if (shape == nullptr) shape = keep(std::make_unique<btSphereShape>(btScalar(0.01)));
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(kilograms), nullptr, shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        engine_.addRigidBody(bodies_.back().get(), collides ? usual : 0, collides ? everything : 0);
        if (kilograms > 0) bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        return *bodies_.back();
    }
    void ground() {
        body(0, {0, 0, 0}, {0, 0, -1}, keep(std::make_unique<btBoxShape>(btVector3(500, 500, 1))));
    }
    /// In rows of 32, 2 m apart.
    [[nodiscard]] btVector3 foot(int i) const {
        return {btScalar(2 * (i % 32)), btScalar(2 * (i / 32)), 0};
    }

    void post(int i) {
        const bool clamped = settings_.scene != "standing";
        if (settings_.method == "jointed") {
            jointed(i, description(settings_.segments, clamped, false));
            return;
        }
        if (box_ == nullptr) {
            const double wide = clamped ? half : 0.2;
            box_ = keep(std::make_unique<btBoxShape>(
                btVector3(btScalar(wide), btScalar(wide), btScalar(length / 2))));
        }
        btVector3 inertia(0, 0, 0);
        if (!clamped) box_->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody& of = body(clamped ? 0 : mass, inertia,
                               foot(i) + btVector3(0, 0, btScalar(length / 2)), box_);
        // members are made once all bodies are, so that these lie together in memory as without
        if (settings_.method != "plain" && settings_.method != "world") posts_.push_back(&of);
    }
    void make_member(btRigidBody& of) {
        const bool clamped = settings_.scene != "standing";
        // it bends about y, so that a truck along x may bend it
        const btTransform start(btMatrix3x3(0, 1, 0, -1, 0, 0, 0, 0, 1),
                                btVector3(0, 0, btScalar(-length / 2)));
        members_.push_back(std::make_unique<bullet::Member>(
            of, description(settings_.segments, clamped, false), start,
            bullet::MemberBox{clamped ? half : 0.2, clamped ? half : 0.2}));
        world_->add(*members_.back());
    }

    /// Along z from `foot`, each segment a body.
    btRigidBody* jointed(int i, const Member& of) {
        const btMatrix3x3 turned(0, 0, 1, 1, 0, 0, 0, 1, 0); // hinges turn about z
        const bool bar = settings_.scene == "struck";
        btRigidBody* before = nullptr;
        double at = 0;
        for (int k = 0; k < of.segments(); ++k) {
            const MemberSegment& segment = of.segment(k);
            if (segment.held) continue;
            const auto middle = btScalar(segment.length / 2);
            const double wide = of.clamped() ? half : 0.2;
            btCollisionShape* shape = nullptr;
            if (!bar) {
                shape = keep(std::make_unique<btBoxShape>(
                    btVector3(btScalar(wide), btScalar(wide), middle)));
            }
            const btVector3 from = bar ? btVector3(0, 0, 0) : foot(i);
            btRigidBody& next = body(segment.mass,
                                     {btScalar(segment.inertia[0]), btScalar(segment.inertia[1]),
                                      btScalar(segment.inertia[2])},
                                     from + btVector3(0, 0, btScalar(at) + middle), shape, !bar);
            if (k > 0) {
                const bool to_ground = before == nullptr;
                const auto above = btScalar(of.segment(k - 1).length / 2);
                hinges_.push_back(std::make_unique<Hinge>(
                    next, to_ground ? btTypedConstraint::getFixedBody() : *before,
                    btTransform(turned, {0, 0, -middle}),
                    btTransform(turned, to_ground ? from : btVector3(0, 0, above)),
                    of.section(k - 1)));
                hinges_.back()->add_to(engine_, true);
                world_->add(*hinges_.back());
            }
            before = &next;
            at += segment.length;
        }
        return before;
    }

    void strike() {
        const Member of = description(settings_.segments, true, true);
        const btVector3 none(0, 0, 0);
        striker_ = &body(1, {1, 1, 1}, {0, 0, 1}, nullptr, false);
        striker_->setLinearVelocity({0, 4, 0});
        const auto tie = [this, none](btRigidBody& to, const btVector3& at) {
            return std::make_unique<btPoint2PointConstraint>(to, *striker_, at, none);
        };
        if (settings_.method == "in-time" || settings_.method == "frames") {
            members_.push_back(std::make_unique<bullet::Member>(body(0, none, none, nullptr, false),
                                                                of, btTransform::getIdentity()));
            members_.back()->attach(1, [tie](btRigidBody& piece, const btTransform& place) {
                return tie(piece, place.getOrigin());
            });
            world_->add(*members_.back());
            return;
        }
        btRigidBody* tip = nullptr;
        btVector3 at(0, 0, btScalar(0.5 / settings_.segments));
        if (settings_.method == "jointed") {
            tip = jointed(0, of);
        } else {
            tip = &body(0, none, none, nullptr, false);
            at = {0, 0, 1};
        }
        constraints_.push_back(tie(*tip, at));
        engine_.addConstraint(constraints_.back().get());
    }

    void truck() {
        constexpr double kilograms = 24000;
        auto* shape =
            keep(std::make_unique<btBoxShape>(btVector3(btScalar(0.1), 1, btScalar(0.1))));
        btVector3 inertia;
        shape->calculateLocalInertia(btScalar(kilograms), inertia);
        striker_ = &body(kilograms, inertia, {-4, 0, btScalar(0.5)}, shape);
        striker_->setLinearVelocity({15, 0, 0});
        striker_->setFriction(0);
        striker_->setLinearFactor({1, 0, 0});
        striker_->setAngularFactor({0, 0, 0});
    }

    Settings settings_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    btCollisionShape* box_ = nullptr;
    btRigidBody* striker_ = nullptr;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
    std::unique_ptr<bullet::World> world_;
    std::vector<btRigidBody*> posts_;
    std::vector<std::unique_ptr<bullet::Member>> members_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
};

struct Row {
    std::string scene, method, part;
    int posts = 0;
    double median = 0, ratio = 0;
    int most_open = 0;
    double absorbed = 0, tip = 0;
};

class Table {
  public:
    explicit Table(const std::string& csv) {
        if (!csv.empty()) {
            file_.open(csv);
            if (!file_) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
            file_ << "scene,method,posts,part,median_us,ratio,most_open,absorbed_joule,tip_m\n";
        }
        fmt::print("{:<9} {:<8} {:>6} {:<8} {:>11} {:>8} {:>9} {:>13} {:>10}\n", "scene", "method",
                   "posts", "part", "median [us]", "/ plain", "most open", "absorbed [J]",
                   "tip [m]");
    }
    void add(const Row& row) {
        fmt::print("{:<9} {:<8} {:>6} {:<8} {:>11.2f} {:>8.3f} {:>9} {:>13.7g} {:>10.7f}\n",
                   row.scene, row.method, row.posts, row.part, 1e6 * row.median, row.ratio,
                   row.most_open, row.absorbed, row.tip);
        std::fflush(stdout);
        file_ << fmt::format("{},{},{},{},{:.3f},{:.4f},{},{:.8g},{:.8g}\n", row.scene, row.method,
                             row.posts, row.part, 1e6 * row.median, row.ratio, row.most_open,
                             row.absorbed, row.tip);
    }

  private:
    std::ofstream file_;
};

double timed_step(Site& site, double dt) {
    const double start = bench::cpu_now();
    site.step(dt);
    return bench::cpu_now() - start;
}

/// Nothing happens.
void intact(Table& table, const std::string& scene, bool quick) {
    const int posts = quick ? 100 : 1000, few = quick ? 10 : 100;
    const std::vector<std::string> methods{"plain", "world", "in-time", "ledger", "frames"};
    std::vector<std::unique_ptr<Site>> sites;
    for (const auto& method : methods) {
        sites.push_back(
            std::make_unique<Site>(Settings{.scene = scene, .method = method, .posts = posts}));
    }
    std::vector<std::vector<double>> times(methods.size() + 1);
    for (int i = 0; i < 120; ++i) {
        for (auto& site : sites) site->step(1.0 / 60);
    }
    for (int i = 0; i < (quick ? 60 : 200); ++i) {
        for (std::size_t k = 0; k < sites.size(); ++k) {
            times[k].push_back(timed_step(*sites[k], 1.0 / 60));
        }
    }
    const double plain = bench::median(times[0]);
    for (std::size_t k = 0; k < sites.size(); ++k) {
        const double median = bench::median(times[k]);
        table.add({scene, methods[k], "", posts, median, median / plain, sites[k]->open(),
                   sites[k]->absorbed()});
    }
    sites.clear();
    Site jointed({.scene = scene, .method = "jointed", .posts = few, .segments = 4});
    for (int i = 0; i < 20; ++i) jointed.step(1.0 / 60);
    for (int i = 0; i < 20; ++i) times.back().push_back(timed_step(jointed, 1.0 / 60));
    const double median = bench::median(times.back());
    table.add(
        {scene, "jointed", "", few, median, median / few / (plain / posts), 0, jointed.absorbed()});
}

void struck(Table& table, bool quick) {
    const int steps = quick ? 300 : 600;
    double plain = 0;
    for (const std::string method : {"plain", "jointed", "in-time", "frames"}) {
        Site site({.scene = "struck", .method = method, .posts = 1, .segments = 20});
        std::vector<double> times;
        int open = 0;
        for (int i = 0; i < steps; ++i) {
            times.push_back(timed_step(site, 1e-4));
            open = std::max(open, site.open());
        }
        const double median = bench::median(times);
        if (plain == 0) plain = median;
        table.add({"struck", method, "", 1, median, median / plain, open, site.absorbed(),
                   double(site.place().y())});
    }
}

void truck(Table& table, bool quick) {
    const int posts = quick ? 128 : 1000;
    Site plain({.scene = "truck", .method = "plain", .posts = posts});
    std::vector<double> of_plain;
    for (int i = 0; i < 20; ++i) of_plain.push_back(timed_step(plain, 1.0 / 60));
    const double beside = bench::median(of_plain);
    table.add({"truck", "plain", "before", posts, beside, 1, 0, 0});
    for (const std::string method : {"in-time", "frames"}) {
        Site site({.scene = "truck", .method = method, .posts = posts});
        std::vector<double> before, open, after;
        int most = 0;
        // Bullet's own steps of 1/60 s are a quarter of a metre: it would miss most of the posts
        const double dt = method == "frames" ? 1.0 / 60 : 1.0 / 240;
        const int enough = quick ? 2 : 30;
        for (int i = 0; i < int(7 / dt) && site.bent() < enough; ++i) {
            const double time = timed_step(site, dt);
            most = std::max(most, site.open());
            (site.open() > 0 ? open : site.bent() > 0 ? after : before).push_back(time);
        }
        for (const auto& [part, times] :
             {std::pair{"before", &before}, std::pair{"open", &open}, std::pair{"after", &after}}) {
            constexpr std::size_t fewest = 10; // of which a median says something
            if (times->size() < fewest) continue;
            const double median = bench::median(*times);
            table.add({"truck", method, part, posts, median, median / beside, most, site.absorbed(),
                       double(site.bent())});
        }
    }
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Cost and accuracy of members that are one body until they yield");
    bool quick = false;
    std::string csv;
    std::vector<std::string> count;
    app.add_flag("--quick", quick, "fewer posts and steps");
    app.add_option("--csv", csv, "file to write");
    app.add_option("--count", count, "SCENE METHOD POSTS STEPS: steps and says nothing")
        ->expected(4);
    CLI11_PARSE(app, argc, argv);
    if (!count.empty()) {
        Site site({.scene = count[0], .method = count[1], .posts = std::stoi(count[2])});
        for (int i = 0; i < std::stoi(count[3]); ++i) site.step(1.0 / 60);
        return 0;
    }
    Table table(csv);
    intact(table, "standing", quick);
    intact(table, "clamped", quick);
    struck(table, quick);
    truck(table, quick);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
