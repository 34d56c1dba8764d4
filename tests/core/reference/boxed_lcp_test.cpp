// SPDX-License-Identifier: MIT
//
// The solver of the reference integrator against brute force: every way to put n rows at a bound or
// between them is tried. What verifies the core must itself be verified.
#include <catch2/catch.hpp>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/boxed_lcp.hpp"
#include "support/property.hpp"

using namespace ductile::reference;

namespace {

struct Problem {
    Matrix<double> a;
    Vector<double> g, lower, upper;
};

/// Whole numbers, so that ties and dependent rows are exact and frequent.
Problem arbitrary_problem() {
    const auto rows = *rc::gen::inRange(1, 6);
    const auto bodies = *rc::gen::inRange(1, 5);
    Matrix<double> jacobian(rows, bodies);
    for (auto& entry : jacobian.reshaped()) entry = *rc::gen::inRange(-2, 3);
    Problem p{jacobian * jacobian.transpose(), Vector<double>(rows), Vector<double>(rows),
              Vector<double>(rows)};
    Vector<double> free_velocity(bodies);
    for (auto& entry : free_velocity) entry = *rc::gen::inRange(-4, 5);
    p.g = jacobian * free_velocity;
    for (int i = 0; i < rows; ++i) {
        p.upper[i] = *rc::gen::inRange(0, 4);
        p.lower[i] = -*rc::gen::inRange(0, 4);
        if (*rc::gen::inRange(0, 3) == 0) p.a(i, i) += 0.5; // a compliant row
    }
    return p;
}

/// Smallest objective over all 3^n active sets, each solved by a rank-revealing decomposition.
double smallest_by_enumeration(const Problem& p) {
    const int n = int(p.g.size());
    int sets = 1;
    for (int i = 0; i < n; ++i) sets *= 3;
    double best = std::numeric_limits<double>::infinity();
    for (int set = 0; set < sets; ++set) {
        Vector<double> lambda = Vector<double>::Zero(n);
        std::vector<int> free;
        for (int i = 0, code = set; i < n; ++i, code /= 3) {
            if (code % 3 == 0) free.push_back(i);
            if (code % 3 == 1) lambda[i] = p.lower[i];
            if (code % 3 == 2) lambda[i] = p.upper[i];
        }
        if (!free.empty()) {
            const Vector<double> target = -(p.a * lambda + p.g)(free);
            const Matrix<double> block = p.a(free, free);
            const Vector<double> solved = block.completeOrthogonalDecomposition().solve(target);
            lambda(free) = solved;
        }
        const double slip = 1e-9;
        if (((lambda - p.lower).array() < -slip).any()) continue;
        if (((lambda - p.upper).array() > slip).any()) continue;
        best = std::min(best, lambda.dot(p.a * lambda) / 2 + p.g.dot(lambda));
    }
    return best;
}

} // namespace

TEST_CASE("the boxed LCP finds the optimum that enumeration finds", "[reference][lcp]") {
    ductile::test::prop("whole numbers, dependent rows, ties, boxes of no width", [] {
        const Problem p = arbitrary_problem();
        BoxedLcp<double> lcp;
        const Vector<double> lambda = lcp.solve(p.a, p.g, p.lower, p.upper);
        for (int i = 0; i < lambda.size(); ++i) {
            RC_ASSERT(lambda[i] >= p.lower[i]);
            RC_ASSERT(lambda[i] <= p.upper[i]);
            RC_ASSERT(lcp_violation(lcp.slack()[i], lambda[i], p.lower[i], p.upper[i]) < 1e-9);
        }
        const double objective = lambda.dot(p.a * lambda) / 2 + p.g.dot(lambda);
        RC_ASSERT(objective < smallest_by_enumeration(p) + 1e-9);
    });
}

TEST_CASE("the boxed LCP gives the same velocities whatever it starts from", "[reference][lcp]") {
    ductile::test::prop("after any other problem of the same size", [] {
        const Problem p = arbitrary_problem();
        BoxedLcp<double> cold, warm;
        cold.solve(p.a, p.g, p.lower, p.upper);
        warm.solve(p.a, -2 * p.g, p.lower, p.upper);
        warm.solve(p.a, p.g, p.lower, p.upper);
        RC_ASSERT((cold.slack() - warm.slack()).cwiseAbs().maxCoeff() < 1e-9);
    });
}

TEST_CASE("the boxed LCP refuses what has no solution", "[reference][lcp]") {
    // two rigid rows on the same degree of freedom with different targets
    const Matrix<double> a = Matrix<double>::Ones(2, 2);
    const Vector<double> g = Vector<double>::LinSpaced(2, 0, 1);
    const Vector<double> open =
        Vector<double>::Constant(2, std::numeric_limits<double>::infinity());
    BoxedLcp<double> lcp;
    CHECK_THROWS_AS(lcp.solve(a, g, -open, open), std::runtime_error);
    const Vector<double> none = Vector<double>::Constant(2, std::nan(""));
    CHECK_THROWS_AS(lcp.solve(a, none, -open, open), std::runtime_error);
}
