// SPDX-License-Identifier: MIT
//
// What does a frame with a tolerance cost where nothing happens, and where one post of many bodies
// is struck? Beside the same world without a tolerance.
//
//   locality-bullet-double [--quick] [--csv FILE]
//   locality-bullet-double --count POSTS JOINTS TOLERANCE FRAMES      for callgrind
//
// Scenes
//   intact     1000 hinges that stand, awake, as posts of one or five pieces, with a ledger or
//              without: two worlds, with a tolerance of 1 % and with none, take their frames of
//              1/60 s in turn; the median of the ratios of pairs
//   struck     a post of five hinges among 1000 boxes on a floor, awake or asleep, hit by a ball of
//              100 kg at 5 m/s, twenty times anew: the dearest frame beside the median step of the
//              same world without a tolerance; its solves; the same scaled to 25 solves
//
// Columns of the CSV: scene,set_up,step_us,frame_us,ratio,solves,ratio_of_25.
#include <btBulletDynamicsCommon.h>
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cpu_time.hpp"
#include "ductile/bullet/bullet.hpp"

namespace {

using namespace ductile;
using Law = OneAxisJoint<Perfect<double>>;
using Hinge = bullet::PlasticHinge<Law>;

constexpr double frame = 1.0 / 60;

class Site {
  public:
    Site(double tolerance, bool ledger) {
        engine_.setGravity(btVector3(0, btScalar(-9.81), 0));
        world_ = std::make_unique<bullet::World>(
            engine_, bullet::WorldParameters{
                         .ledger = ledger, .tolerance = tolerance, .rest_damping = 0, .warn = {}});
        add(floor_, 0, {0, -1, 0});
    }
    ~Site() {
        hinges_.clear();
        world_.reset();
        for (auto& body : bodies_) engine_.removeRigidBody(body.get());
    }
    Site(const Site&) = delete;
    Site& operator=(const Site&) = delete;

    /// Of pieces of 0.4 m.
    void post(const btVector3& foot, int joints) {
        btRigidBody* below = nullptr;
        const btVector3 half(0, btScalar(0.2), 0);
        for (int i = 0; i < joints; ++i) {
            btRigidBody& piece = add(piece_, 12, foot + btVector3(0, btScalar(0.25 + 0.4 * i), 0));
            piece.setActivationState(DISABLE_DEACTIVATION);
            const Law law(Perfect<double>({.strength = 4000}));
            hinges_.push_back(below != nullptr
                                  ? std::make_unique<Hinge>(piece, *below, at(-half), at(half), law)
                                  : std::make_unique<Hinge>(piece, at(-half), law));
            world_->add(*hinges_.back());
            below = &piece;
        }
    }
    /// In rows of 32, beside the post.
    void boxes(int count, bool awake) {
        for (int i = 0; i < count; ++i) {
            btRigidBody& made =
                add(box_, 100,
                    {btScalar(4 + 1.5 * (i % 32)), btScalar(0.5), btScalar(4 + 1.5 * (i / 32))});
            if (awake) made.setActivationState(DISABLE_DEACTIVATION);
        }
    }
    void strike() {
        btRigidBody& ball = add(ball_, 100, {btScalar(-0.3), btScalar(1.9), 0});
        ball.setGravity({0, 0, 0});
        ball.setActivationState(DISABLE_DEACTIVATION);
        ball.setLinearVelocity({5, 0, 0});
    }
    /// [s]
    double timed_step() {
        const double start = bench::cpu_now();
        world_->step(frame);
        return bench::cpu_now() - start;
    }
    [[nodiscard]] const bullet::World& world() const { return *world_; }

  private:
    static btTransform at(const btVector3& origin) {
        btTransform result;
        result.setIdentity();
        result.setOrigin(origin);
        return result;
    }
    btRigidBody& add(btCollisionShape& shape, double mass, const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
        info.m_startWorldTransform = at(place);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        engine_.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld engine_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    btBoxShape floor_{btVector3(500, 1, 500)},
        piece_{btVector3(btScalar(0.05), btScalar(0.2), btScalar(0.05))},
        box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btSphereShape ball_{btScalar(0.2)};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::unique_ptr<bullet::World> world_;
    std::vector<std::unique_ptr<Hinge>> hinges_;
};

class Table {
  public:
    explicit Table(const std::string& csv) {
        if (!csv.empty()) {
            file_.open(csv);
            if (!file_) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
            file_ << "scene,set_up,step_us,frame_us,ratio,solves,ratio_of_25\n";
        }
        fmt::print("{:<8} {:<28} {:>10} {:>11} {:>7} {:>7} {:>12}\n", "scene", "set-up",
                   "step [us]", "frame [us]", "ratio", "solves", "ratio of 25");
    }
    void add(const std::string& scene, const std::string& set_up, double step, double time,
             double ratio, int solves, double of_25) {
        fmt::print("{:<8} {:<28} {:>10.1f} {:>11.1f} {:>7.3f} {:>7} {:>12.3f}\n", scene, set_up,
                   1e6 * step, 1e6 * time, ratio, solves, of_25);
        std::fflush(stdout);
        file_ << fmt::format("{},{},{:.2f},{:.2f},{:.4f},{},{:.4f}\n", scene, set_up, 1e6 * step,
                             1e6 * time, ratio, solves, of_25);
    }

  private:
    std::ofstream file_;
};

std::unique_ptr<Site> standing(int posts, int joints, double tolerance, bool ledger) {
    auto site = std::make_unique<Site>(tolerance, ledger);
    for (int i = 0; i < posts; ++i) {
        site->post({btScalar(2 * (i % 32)), 0, btScalar(2 * (i / 32))}, joints);
    }
    return site;
}

void intact(Table& table, int hinges, int joints, bool ledger, int frames) {
    const auto without = standing(hinges / joints, joints, 0, ledger);
    const auto with = standing(hinges / joints, joints, 0.01, ledger);
    std::vector<double> steps, times, ratios;
    for (int i = 0; i < 20 + frames; ++i) {
        const double step = without->timed_step(), time = with->timed_step();
        if (i < 20) continue;
        steps.push_back(step);
        times.push_back(time);
        ratios.push_back(time / step);
    }
    table.add("intact",
              fmt::format("{} posts of {}{}", hinges / joints, joints, ledger ? ", ledger" : ""),
              bench::median(steps), bench::median(times), bench::median(ratios), 1, 0);
}

void struck(Table& table, int boxes, bool awake, int times) {
    const int before = awake ? 20 : 200; // frames, to fall asleep
    std::vector<double> steps, dearest, ratios, of_25, all_solves;
    int solves = 0;
    for (int k = 0; k < times; ++k) {
        Site without(0, true), with(0.01, true);
        for (Site* site : {&without, &with}) {
            site->boxes(boxes, awake);
            site->post({0, 0, 0}, 5);
        }
        for (int i = 0; i < before; ++i) {
            (void)without.timed_step();
            (void)with.timed_step();
        }
        with.strike();
        std::vector<double> beside;
        double most = 0;
        for (int i = 0; i < 12; ++i) {
            beside.push_back(without.timed_step());
            const double time = with.timed_step();
            if (time < most) continue;
            most = time;
            solves = with.world().frame().solves();
        }
        all_solves.push_back(solves);
        const double step = bench::median(beside);
        steps.push_back(step);
        dearest.push_back(most);
        ratios.push_back(most / step);
        of_25.push_back(1 + (most / step - 1) * 25 / solves);
    }
    table.add("struck", fmt::format("{} boxes {}", boxes, awake ? "awake" : "asleep"),
              bench::median(steps), bench::median(dearest), bench::median(ratios),
              int(bench::median(all_solves)), bench::median(of_25));
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Cost of a frame with a tolerance where nothing, or little, happens");
    bool quick = false;
    std::string csv;
    std::vector<double> count;
    app.add_flag("--quick", quick, "fewer frames");
    app.add_option("--csv", csv, "file to write");
    app.add_option("--count", count, "posts, joints of each, tolerance, frames")->expected(4);
    CLI11_PARSE(app, argc, argv);
    if (!count.empty()) {
        const auto site = standing(int(count[0]), int(count[1]), count[2], true);
        for (int i = 0; i < int(count[3]); ++i) (void)site->timed_step();
        return 0;
    }
    Table table(csv);
    for (const bool ledger : {true, false}) {
        for (const int joints : {1, 5}) intact(table, 1000, joints, ledger, quick ? 40 : 200);
    }
    for (const bool awake : {true, false}) struck(table, 1000, awake, quick ? 3 : 20);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
