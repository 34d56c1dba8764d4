// SPDX-License-Identifier: MIT
//
// Bullet's solvers and those of this library on rows u' + C λ = b, lower <= λ <= upper, against the
// exact solution of the boxed problem; and what Bullet's own do wrong, stated as failures that are
// known.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "adapters/bullet_rows.hpp"

using namespace ductile;
using namespace ductile::test;

extern bool gUseMatrixMultiply; // Bullet's switch between createMLCP and createMLCPFast

namespace {

constexpr bool single = sizeof(btScalar) == sizeof(float);
/// Round-off of solved rows, as a share of the velocities involved: measured 4e-7 and 3e-15 at
/// most, an order of margin. Impulses: times the conditioning of the random rows.
constexpr double solved = single ? 5e-6 : 5e-14;
constexpr double impulses_agree = single ? 5e-4 : 1e-11;
/// Sweeps after which the worst random system is converged to round-off.
constexpr int converged = 2000;

const std::vector<std::string> exact_solvers = {"soft-si", "soft-nncg", "soft-mlcp-dantzig",
                                                "soft-mlcp-lemke", "soft-mlcp-pgs"};

/// What random rows may hold.
struct Mix {
    double decades = 6;  ///< C m from 10^-decades to 10^decades; a third of the rows is rigid
    bool shifted = true; ///< bounds that need not enclose zero
    bool given = true;   ///< rows with equal bounds
    bool compliant = true;
};

/// Five bodies of 0.1 to 10 kg, joined to each other by one to three rows.
void fill(RowSystem& system, unsigned seed, const Mix& mix) {
    std::mt19937 generator(seed);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(generator);
    };
    const auto vector = [&](double size) {
        const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
        return btVector3(btScalar(x), btScalar(y), btScalar(z));
    };
    const auto decades = [&](double d) { return std::pow(10.0, number(-d, d)); };
    for (int i = 0; i < 5; ++i) {
        const double mass = decades(1), inertia = mass * decades(0.3);
        const btVector3 v = vector(10), w = vector(10);
        system.body(
            mass,
            btVector3(btScalar(inertia), btScalar(inertia * number(0.7, 1.3)), btScalar(inertia)),
            v, w);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        std::vector<FreeRow> rows(std::size_t(number(1, 4)));
        for (FreeRow& row : rows) {
            row.lin_a = vector(1), row.ang_a = vector(1);
            row.lin_b = vector(1), row.ang_b = vector(1);
            row.target = number(-1, 1);
        }
        FreeRows& joint = system.join(system.body(i), system.body(i + 1), rows);
        for (FreeRow& row : joint.rows) {
            const double mass = joint.mass(row), impulse = 10 * mass;
            const bool rigid = number(0, 1) < 0.3;
            // rounded as Bullet will hold it, so that both solve the same problem
            const double compliance = double(btScalar(decades(mix.decades) / mass));
            if (mix.compliant && !rigid) row.compliance = compliance;
            const double kind = number(0, 1);
            const double centre = mix.shifted ? number(-0.7, 0.7) * impulse : 0;
            const double half = number(0, 0.7) * impulse;
            if (kind < 0.2) continue; // no bounds
            const bool given = mix.given && kind < 0.4;
            row.lower = double(btScalar(given ? centre : centre - half));
            row.upper = double(btScalar(given ? centre : centre + half));
        }
    }
    system.assemble();
}

/// One row of effective mass 2 kg that stops 3 m/s: λ = -6 N s where it is rigid and unbounded.
struct OneRow {
    RowSystem system;
    FreeRows* joint = nullptr;
    explicit OneRow(double compliance, double lower = -SIMD_INFINITY, double upper = SIMD_INFINITY,
                    double mass = 2) {
        btRigidBody& body = system.body(mass, {1, 1, 1}, {3, 0, 0}, {0, 0, 0});
        btRigidBody& ground = system.body(0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
        FreeRow row{
            .lin_a = {1, 0, 0}, .ang_a = {0, 0, 0}, .lin_b = {-1, 0, 0}, .ang_b = {0, 0, 0}};
        row.lower = lower, row.upper = upper, row.compliance = compliance;
        joint = &system.join(body, ground, {row});
        system.assemble();
    }
    double impulse(const std::string& solver, int iterations) {
        NamedSolver named(solver);
        system.solve(*named, iterations);
        return named.impulses()[0];
    }
};

/// Fails, or says that it solved what it did not.
class BadLcp final : public btMLCPSolverInterface {
  public:
    explicit BadLcp(bool lies) : lies_(lies) {}
    bool solveMLCP(const btMatrixXu&, const btVectorXu&, btVectorXu& x, const btVectorXu&,
                   const btVectorXu&, const btAlignedObjectArray<int>&, int, bool) override {
        for (int i = 0; i < x.rows(); ++i) x[i] = 0;
        return lies_;
    }

  private:
    bool lies_;
};

} // namespace

TEST_CASE("every solver here solves soft, given and shifted rows exactly", "[bullet][solvers]") {
    const auto name = GENERATE(from_range(exact_solvers));
    double violation = 0, error = 0;
    int fallbacks = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        RowSystem system;
        fill(system, seed, {});
        NamedSolver solver(name);
        system.solve(*solver, converged);
        violation = std::max(violation, system.violation(solver.impulses()));
        error = std::max(error, system.error(solver.impulses()));
        fallbacks += solver.fallbacks();
        for (std::size_t i = 0; i < system.joints(); ++i) CHECK(system.joint(i).was_exact);
    }
    INFO(name);
    CHECK(violation < solved);
    CHECK(error < impulses_agree);
    CHECK(fallbacks == 0);
}

TEST_CASE("compliance needs no iterations of its own", "[bullet][solvers]") {
    // a single row is solved by one sweep, whatever C m
    const auto name = GENERATE(from_range(exact_solvers));
    const double slack = std::pow(10.0, GENERATE(range(-6, 7)));
    INFO(name << ", C m = " << slack);
    OneRow row(slack / 2);
    CHECK(row.impulse(name, 1) == Approx(-6 / (1 + slack)).epsilon(single ? 1e-6 : 1e-14));
    OneRow bounded(slack / 2, -1, 4);
    CHECK(bounded.impulse(name, 1) ==
          Approx(std::max(-1.0, -6 / (1 + slack))).epsilon(single ? 1e-6 : 1e-14));
}

TEST_CASE("both ways in which Bullet builds the matrix hold the compliance", "[bullet][solvers]") {
    gUseMatrixMultiply = true;
    double error = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        RowSystem system;
        fill(system, seed, {});
        NamedSolver solver("soft-mlcp-dantzig");
        system.solve(*solver, converged);
        error = std::max(error, system.error(solver.impulses()));
    }
    gUseMatrixMultiply = false;
    CHECK(error < impulses_agree);
}

TEST_CASE("rigid rows whose bounds enclose zero are what they are in Bullet, bit for bit",
          "[bullet][solvers]") {
    const std::string name = GENERATE(as<std::string>(), "si", "mlcp-dantzig", "mlcp-pgs");
    INFO(name);
    for (unsigned seed = 0; seed < 50; ++seed) {
        const auto impulses = [&](const std::string& solver_name) {
            RowSystem system;
            fill(system, seed, {.shifted = false, .given = false, .compliant = false});
            NamedSolver solver(solver_name);
            system.solve(*solver, 20);
            CHECK(solver.fallbacks() == 0);
            return solver.impulses();
        };
        CHECK(impulses("soft-" + name) == impulses(name));
    }
}

TEST_CASE("known failure: stock sequential impulse and NNCG diverge where C m > 1",
          "[bullet][solvers]") {
    const std::string name = GENERATE(as<std::string>(), "si", "nncg");
    INFO(name);
    CHECK(OneRow(0.5 / 2).impulse(name, 60) == Approx(-6 / 1.5).epsilon(1e-6));
    if (name == "si") { // NNCG's second direction happens to find the one row's solution
        CHECK(std::abs(OneRow(1.5 / 2).impulse(name, 60)) > 1e6);
    }
    int wrong = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        RowSystem system;
        fill(system, seed, {.decades = 1, .shifted = false, .given = false});
        NamedSolver solver(name);
        system.solve(*solver, converged);
        const double violation = system.violation(solver.impulses());
        wrong += !(violation < 1e-3);
    }
    CHECK(wrong > 10);
}

TEST_CASE("known failure: the stock MLCP solver leaves row compliance out", "[bullet][solvers]") {
    const std::string inner = GENERATE(as<std::string>(), "dantzig", "lemke", "pgs");
    INFO(inner);
    CHECK(OneRow(4).impulse("mlcp-" + inner, 100) == Approx(-6)); // -6/9 is right
    CHECK(OneRow(4).impulse("soft-mlcp-" + inner, 100) == Approx(-6.0 / 9));
}

TEST_CASE("known failure: stock Dantzig does not solve bounds beyond zero", "[bullet][solvers]") {
    int fallbacks = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
        RowSystem system;
        fill(system, seed, {.compliant = false});
        NamedSolver solver("mlcp-dantzig");
        system.solve(*solver, converged);
        fallbacks += solver.fallbacks(); // sequential impulse solved it, or not, instead
    }
    CHECK(fallbacks > 50);
}

TEST_CASE("known failure: stock NNCG applies velocities as impulses", "[bullet][solvers]") {
    // rigid rows between light bodies: what its row solvers return is 1/m times the impulse
    const auto violation = [](const std::string& name) {
        double most = 0;
        for (unsigned seed = 0; seed < 50; ++seed) {
            RowSystem system;
            fill(system, seed, {.shifted = false, .given = false, .compliant = false});
            NamedSolver solver(name);
            system.solve(*solver, 30);
            most = std::max(most, system.violation(solver.impulses()));
        }
        return most;
    };
    CHECK(violation("nncg") > 10 * violation("si"));
    // the acceleration it is there for, down to round-off
    CHECK(violation("soft-nncg") < 0.1 * violation("si") + solved);
}

TEST_CASE("the mark is there while rows are asked for, and only then", "[bullet][solvers]") {
    const auto name = GENERATE(from_range(exact_solvers));
    INFO(name);
    OneRow row(1);
    CHECK_FALSE(row.joint->compliance_is_exact());
    row.impulse(name, 1);
    CHECK(row.joint->was_exact);
    CHECK_FALSE(row.joint->compliance_is_exact());
    row.impulse("si", 1);
    CHECK_FALSE(row.joint->was_exact);
}

TEST_CASE("what an LCP solver cannot do falls back, with its compliance, and is counted",
          "[bullet][solvers]") {
    const bool lies = GENERATE(false, true);
    BadLcp bad(lies);
    Recording<bullet::SoftMlcpSolver> solver(bad, bullet::Answer::exact);
    RowSystem system;
    fill(system, 1, {.given = false});
    system.solve(solver, converged);
    CHECK(solver.getNumFallbacks() == 1);
    CHECK(system.violation(solver.impulses) < solved);

    // the iterations that the user sets are not meant for a direct solver's islands
    RowSystem few, left;
    fill(few, 1, {.given = false});
    fill(left, 1, {.given = false});
    few.solve(solver, 1);
    NamedSolver iterative("soft-si");
    left.solve(*iterative, 1);
    CHECK(few.violation(solver.impulses) < 0.01 * left.violation(iterative.impulses()));

    Recording<bullet::SoftMlcpSolver> trusting(bad, bullet::Answer::iterated);
    RowSystem again;
    fill(again, 1, {.given = false});
    again.solve(trusting, converged);
    CHECK(trusting.getNumFallbacks() == (lies ? 0 : 1));
}

TEST_CASE("a starting impulse is no reason to give up", "[bullet][solvers]") {
    btMatrixXu a(1, 1);
    a.setElem(0, 0, 1);
    btVectorXu b(1), x(1), lower(1), upper(1);
    b[0] = 3e5, x[0] = 2000, lower[0] = 0, upper[0] = btScalar(1e10);
    btAlignedObjectArray<int> free;
    free.push_back(-1);
    btDantzigSolver dantzig;
    CHECK_FALSE(dantzig.solveMLCP(a, b, x, lower, upper, free, 10)); // known failure: 1000 N s
    btLemkeSolver lemke;
    CHECK_FALSE(lemke.solveMLCP(a, b, x, lower, upper, free, 10)); // known failure: 1e5 N s
    for (btMLCPSolverInterface* inner : {static_cast<btMLCPSolverInterface*>(&dantzig),
                                         static_cast<btMLCPSolverInterface*>(&lemke)}) {
        x[0] = 2000;
        bullet::ShiftedLcp shifted(*inner, bullet::Answer::exact);
        CHECK(shifted.solveMLCP(a, b, x, lower, upper, free, 10));
        CHECK(x[0] == Approx(3e5));
    }
}

TEST_CASE("constraints without rows do no harm, however many", "[bullet][solvers]") {
    // 2000 broken joints before, between and after two that hold
    OneRow row(1);
    btRigidBody &body = row.system.body(0), &ground = row.system.body(1);
    for (int i = 0; i < 1000; ++i) row.system.join(body, ground, {});
    FreeRow across = row.joint->rows[0];
    across.lin_a = {0, 1, 0}, across.lin_b = {0, -1, 0};
    across.target = 2, across.compliance = 0.5;
    row.system.join(body, ground, {across});
    for (int i = 0; i < 1000; ++i) row.system.join(body, ground, {});
    row.system.assemble();
    NamedSolver solver("soft-mlcp-dantzig");
    row.system.solve(*solver, 10);
    CHECK(solver.fallbacks() == 0);
    CHECK(row.system.error(solver.impulses()) < impulses_agree);
    CHECK(solver.impulses()[1] == Approx(2)); // (0.5 + 0.5) λ = 2
}

namespace {

/// A heap of boxes with friction on the ground, and a row between two of them if asked for.
class Heap {
  public:
    explicit Heap(const std::string& solver) : solver_(solver) {
        world_.setGravity({0, -10, 0});
        add(0, {0, -1, 0}, {50, 1, 50});
        for (int i = 0; i < 5; ++i) {
            const auto s = btScalar(i);
            add(1 + i, {s * btScalar(0.3), btScalar(0.6) + s * btScalar(1.05), 0},
                {btScalar(0.5), btScalar(0.5), btScalar(0.5)});
        }
    }
    ~Heap() {
        for (auto& joint : joints_) world_.removeConstraint(joint.get());
        for (auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    btRigidBody& body(std::size_t i) { return *bodies_[i]; }
    FreeRows& join(std::size_t a, std::size_t b, const FreeRow& row) {
        joints_.push_back(std::make_unique<FreeRows>(body(a), body(b), std::vector{row}));
        world_.addConstraint(joints_.back().get(), false);
        return *joints_.back();
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world_.stepSimulation(btScalar(1) / 60, 0);
    }
    [[nodiscard]] std::vector<btScalar> state() const {
        std::vector<btScalar> result;
        for (const auto& b : bodies_) {
            for (int k = 0; k < 3; ++k) {
                result.push_back(b->getCenterOfMassPosition()[k]);
                result.push_back(b->getLinearVelocity()[k]);
                result.push_back(b->getAngularVelocity()[k]);
            }
        }
        return result;
    }
    btDiscreteDynamicsWorld& world() { return world_; }
    [[nodiscard]] int fallbacks() const { return solver_.fallbacks(); }

  private:
    void add(double mass, const btVector3& at, const btVector3& half) {
        shapes_.push_back(std::make_unique<btBoxShape>(half));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shapes_.back()->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shapes_.back().get(),
                                                      inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
    }

    NamedSolver solver_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &*solver_, &configuration_};
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<FreeRows>> joints_;
};

} // namespace

TEST_CASE("contacts with friction are Bullet's, bit for bit", "[bullet][solvers]") {
    const std::string name = GENERATE(as<std::string>(), "si", "mlcp-pgs");
    INFO(name);
    Heap stock(name), soft("soft-" + name);
    stock.run(200), soft.run(200);
    CHECK(stock.state() == soft.state());
}

TEST_CASE("a heap comes to rest in every solver that knows friction", "[bullet][solvers]") {
    const std::string name =
        GENERATE(as<std::string>(), "soft-si", "soft-nncg", "soft-mlcp-dantzig", "soft-mlcp-pgs");
    INFO(name);
    Heap heap(name);
    heap.run(300);
    for (std::size_t i = 1; i < 6; ++i) {
        INFO("box " << i);
        CHECK(heap.body(i).getLinearVelocity().length() < 0.05);
        CHECK(heap.body(i).getCenterOfMassPosition().y() > 0.45);
    }
}

TEST_CASE("a given force does not push where overlaps are pushed apart", "[bullet][solvers]") {
    // two boxes overlap by 20 mm, a sideways row gives one of them 0.1 N s a step: its way in the
    // first step is that of its speed, 0.1 m/s for 1/60 s, and nothing from the push
    const auto sideways = [](const std::string& name) {
        Heap heap(name);
        heap.world().setGravity({0, 0, 0});
        heap.world().getSolverInfo().m_splitImpulsePenetrationThreshold = btScalar(1e30);
        for (std::size_t i = 1; i < 6; ++i) heap.body(i).setFriction(0);
        btTransform low = heap.body(1).getCenterOfMassTransform();
        low.setOrigin({0, btScalar(0.48), 0});
        heap.body(1).setCenterOfMassTransform(low);
        FreeRow row{
            .lin_a = {0, 0, 1}, .ang_a = {0, 0, 0}, .lin_b = {0, 0, -1}, .ang_b = {0, 0, 0}};
        row.lower = row.upper = 0.1;
        heap.join(1, 0, row);
        heap.run(1);
        CHECK(heap.body(1).getCenterOfMassPosition().y() > 0.481); // it is pushed up
        return double(heap.body(1).getCenterOfMassPosition().z());
    };
    const std::string name =
        GENERATE(as<std::string>(), "soft-si", "soft-nncg", "soft-mlcp-dantzig", "soft-mlcp-pgs");
    INFO(name);
    CHECK(sideways(name) == Approx(0.1 / 60).epsilon(1e-4));
    CHECK(sideways("mlcp-pgs") > 0.1 / 60 * 1.5); // known failure of the stock solver
}
