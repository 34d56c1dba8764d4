// SPDX-License-Identifier: MIT
//
// Bending by fibres against closed forms (P10, and the plastic moments of P18 and P19, of
// tests/reference), and the hinge made of it.
#include "ductile/law/moment_curvature.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "ductile/law/moment_rotation.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

template <class S>
struct Plate {
    using Scalar = S;
    S b = S(0.05);
    S h = S(0.1);
    S lowest() const { return -h / 2; }
    S highest() const { return h / 2; }
    S width_at(S y) const { return y >= lowest() && y <= highest() ? b : S(0); }
};
struct Disc {
    using Scalar = double;
    double r = 0.05;
    double lowest() const { return -r; }
    double highest() const { return r; }
    double width_at(double y) const { return 2 * std::sqrt(std::max(r * r - y * y, 0.0)); }
};
/// T: flange 100 × 20 on top of a web 10 × 100 [mm]; `top` is the height of the top face.
struct Tee {
    using Scalar = double;
    static constexpr double area = 0.1 * 0.02 + 0.01 * 0.1;
    static constexpr double top = (0.1 * 0.02 * 0.01 + 0.01 * 0.1 * 0.07) / area;
    double lowest() const { return top - 0.12; }
    double highest() const { return top; }
    double width_at(double y) const {
        if (y > highest() || y < lowest()) return 0;
        return y > top - 0.02 ? 0.1 : 0.01;
    }
};
static_assert(FibreSection<Plate<float>> && FibreSection<Disc> && !FibreSection<double>);

constexpr double fy = 250e6;
constexpr double E = 200e9;
constexpr double My = 20833.0 + 1.0 / 3;
constexpr double Mp = 31250;
constexpr double ky = 0.025;

BilinearCurve<double> steel(double ratio = 0) {
    return BilinearCurve(BilinearCurveParameters<double>{
        .youngs_modulus = E, .yield_stress = fy, .slope_ratio = ratio});
}
double exact_plate(double k) { return k <= ky ? k / ky * My : Mp * (1 - ky * ky / (3 * k * k)); }

template <class Bending>
double tip_deflection(const Bending& bending, double tip_moment) {
    // ∫ κ(M x) x dx over a length of 1, cut where the curvature starts to grow fast
    const AdaptiveFibres<double> rule(1e-7);
    const double yield = std::min(My / tip_moment, 1.0);
    const auto curvature = [&](double x) { return bending.curvature_at(tip_moment * x) * x; };
    return rule.integrate(0.0, yield, curvature) + rule.integrate(yield, 1.0, curvature);
}

/// A curve that counts how often it is asked.
struct Counted {
    using Scalar = double;
    const RambergOsgood<double>* curve;
    int* calls;
    double stress(double strain) const {
        ++*calls;
        return curve->stress(strain);
    }
};

} // namespace

TEST_CASE("a rectangle bends as the closed form says (P10)", "[law][fibres]") {
    const MomentCurvature perfect(Plate<double>{}, steel());
    const MomentCurvature bilinear(Plate<double>{}, steel(0.02));
    CHECK(perfect.bending_stiffness() == Approx(833333.33333).epsilon(1e-9));
    struct Row {
        double k, moment, bilinear, residual;
    };
    for (const Row& row : {Row{1, 20833.33, 20833.33, 0}, Row{1.5, 26620.37, 26712.96, 0.2222222},
                           Row{2, 28645.83, 28906.25, 0.625}, Row{4, 30598.96, 31653.65, 2.53125},
                           Row{10, 31145.83, 34689.58, 8.505}}) {
        const double k = row.k * ky;
        CHECK(perfect.moment(k) == Approx(row.moment).epsilon(5e-7)); // printed to 7 digits
        CHECK(perfect.moment(k) == Approx(exact_plate(k)).epsilon(1e-8));
        CHECK(perfect.moment(-k) == Approx(-exact_plate(k)).epsilon(1e-8));
        CHECK(bilinear.moment(k) == Approx(row.bilinear).epsilon(5e-7));
        CHECK(perfect.residual_curvature(k) / ky == Approx(row.residual).margin(1e-6));
    }
    CHECK(perfect.moment(1e4) == Approx(Mp).epsilon(1e-9));
    CHECK(perfect.moment(0) == 0);
}

TEST_CASE("midpoint fibres reach the closed form to second order (P10)", "[law][fibres][order]") {
    const auto moment = [](std::size_t count) {
        return MomentCurvature(Plate<double>{}, steel(), MidpointFibres<double>(count))
                   .moment(2 * ky) /
               Mp;
    };
    CHECK(moment(10) == Approx(0.92).epsilon(1e-12));
    CHECK(moment(20) == Approx(0.915).epsilon(1e-12));
    CHECK(moment(40) == Approx(0.91625).epsilon(1e-12));
    // the kink wanders through its strip, so single ratios scatter: the envelope is of order 2
    const double exact = 1 - 1.0 / 12;
    for (const std::size_t count : {10u, 20u, 40u, 80u, 160u, 333u}) {
        CHECK(std::abs(moment(count) - exact) <= 0.7 / double(count * count));
    }
    // with the kink at the same place of its strip the order shows
    for (const std::size_t count : {20u, 40u, 80u}) {
        CHECK(std::log2((moment(count) - exact) / (moment(2 * count) - exact)) >= 1.8);
    }
}

TEST_CASE("the rules integrate polynomials as their order says", "[law][fibres]") {
    const auto square = [](double y) { return y * y; };
    // midpoint: exact for lines, short by h² × width/12 for the square
    CHECK(MidpointFibres<double>(10).integrate(0.0, 1.0, square) ==
          Approx(1.0 / 3 - 1e-2 / 12).epsilon(1e-13));
    CHECK(MidpointFibres<double>(3).integrate(1.0, 3.0, [](double y) { return y; }) ==
          Approx(4).epsilon(1e-14));
    // Simpson with its extrapolation: exact to the fifth power however loose the tolerance
    CHECK(AdaptiveFibres<double>(0.09).integrate(0.0, 2.0, [](double y) {
        return std::pow(y, 5);
    }) == Approx(64.0 / 6).epsilon(1e-13));
    // a jump anywhere is closed in upon
    CHECK(AdaptiveFibres<double>().integrate(0.0, 1.0, [](double y) {
        return y < 0.3217 ? 1.0 : 5.0;
    }) == Approx(0.3217 + 5 * (1 - 0.3217)).epsilon(1e-9));
}

TEST_CASE("coarse fibres of an unsymmetric section are elastic with the stiffness they claim",
          "[law][fibres]") {
    const MomentCurvature tee(Tee{}, steel(), MidpointFibres<double>(17));
    CHECK(tee.moment(1e-3) == Approx(tee.bending_stiffness() * 1e-3).epsilon(1e-12));
    CHECK(tee.residual_curvature(1e-3) == Approx(0).margin(1e-14));
}

TEST_CASE("a section beyond yield under axial force bends on its second slope", "[law][fibres]") {
    const double Np = fy * 0.005;
    for (const double n : {-1.2, 1.2}) {
        const MomentCurvature plate(Plate<double>{}, steel(0.02), AdaptiveFibres<double>(), n * Np);
        const auto point = plate.at(0.1 * ky); // strains of 11 ± 0.1 yield strains
        CHECK(point.moment == Approx(0.02 * 0.1 * My).epsilon(1e-6));
        CHECK(point.axial_strain ==
              Approx(std::copysign(fy / E * (1 + 0.2 / 0.02), n)).epsilon(1e-8));
        CHECK(message_of([&] {
                  (void)moment_rotation(plate,
                                        HingeParameters<double>{.length = 0.1, .curvature_max = 1});
              }) ==
              "Hinge.proof = 0.001: must be more than the plastic share under axial force and no "
              "curvature");
    }
}

TEST_CASE("adaptive fibres hold their tolerance at little cost", "[law][fibres][order]") {
    const RambergOsgood curve(RambergOsgoodParameters<double>{
        .youngs_modulus = 200e9, .coefficient = 1200e6, .exponent = 0.15});
    int calls = 0;
    const Counted counted{&curve, &calls};
    const auto moment = [&](double tolerance) {
        calls = 0;
        return MomentCurvature(Plate<double>{}, counted, AdaptiveFibres<double>(tolerance))
            .moment(0.1);
    };
    const double reference = moment(1e-13);
    std::vector<int> cost;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        CHECK(moment(tolerance) == Approx(reference).epsilon(tolerance));
        cost.push_back(calls);
    }
    // order 4: a tolerance 1e4 times smaller takes 10 times the points, where order 2 would take
    // 100
    CHECK(cost[3] < 15 * cost[1]);
}

TEST_CASE("sections reach their plastic moment wherever the neutral axis has to go (P18, P19)",
          "[law][fibres]") {
    constexpr double huge = 2000; // curvature at which the elastic core has all but gone
    const MomentCurvature tee(Tee{}, steel());
    CHECK(tee.moment(huge) == Approx(fy * 6.75e-5).epsilon(1e-6));
    CHECK(tee.moment(-huge) == Approx(-fy * 6.75e-5).epsilon(1e-6));
    // equal-area axis 15 mm below the top face: zero strain there
    const auto point = tee.at(huge);
    CHECK(-point.axial_strain / huge == Approx(Tee::top - 0.015).epsilon(1e-4));
    // elastic: zero strain at the centroid, and I by Steiner's rule
    const double inertia = 0.1 * 8e-6 / 12 + 0.002 * std::pow(Tee::top - 0.01, 2) +
                           0.01 * 1e-3 / 12 + 0.001 * std::pow(Tee::top - 0.07, 2);
    CHECK(tee.bending_stiffness() == Approx(E * inertia).epsilon(1e-7));
    CHECK(tee.moment(1e-3) == Approx(E * inertia * 1e-3).epsilon(1e-7));

    const MomentCurvature disc(Disc{}, steel());
    CHECK(disc.moment(huge) == Approx(fy * 4 * std::pow(0.05, 3) / 3).epsilon(1e-6));
    CHECK(disc.bending_stiffness() ==
          Approx(E * std::numbers::pi * std::pow(0.05, 4) / 4).epsilon(1e-8));
}

TEST_CASE("axial force lowers the plastic moment as the interaction curves say (P18)",
          "[law][fibres]") {
    constexpr double huge = 2000;
    const double Np = fy * 0.005;
    for (const double n : {-0.8, -0.2, 0.1, 0.4, 0.8}) {
        const MomentCurvature plate(Plate<double>{}, steel(), AdaptiveFibres<double>(), n * Np);
        CHECK(plate.moment(huge) / Mp == Approx(1 - n * n).epsilon(1e-5));
        CHECK(plate.moment(1e-4 * ky) / My == Approx(1e-4).epsilon(1e-6));
    }
    const double area = std::numbers::pi * 0.05 * 0.05;
    const double disc_mp = fy * 4 * std::pow(0.05, 3) / 3;
    for (const auto& [n, m] :
         {std::pair{0.2, 0.9629121}, std::pair{0.5, 0.7654859}, std::pair{0.8, 0.3836245}}) {
        const MomentCurvature disc(Disc{}, steel(), AdaptiveFibres<double>(), n * fy * area);
        CHECK(disc.moment(huge) / disc_mp == Approx(m).epsilon(1e-5));
    }
    CHECK(message_of([&] {
              MomentCurvature(Plate<double>{}, steel(), AdaptiveFibres<double>(), 2e6);
          }) == "MomentCurvature.axial_force = 2000000 N: must be within what the section carries");
}

TEST_CASE("the moment grows with curvature, and the curvature of a moment inverts it",
          "[law][fibres][property]") {
    const MomentCurvature tee(Tee{}, steel(0.01));
    test::prop("there and back, either direction", [&] {
        const double k = std::pow(10.0, *rc::gen::inRange(-3000, 500) / 1000.0);
        const double moment = tee.moment(k);
        RC_ASSERT(tee.moment(1.05 * k) > moment);
        // hardening of 1 % magnifies the error of the integral a hundredfold
        RC_ASSERT(std::abs(tee.curvature_at(moment) / k - 1) < 1e-5);
        RC_ASSERT(std::abs(tee.curvature_at(-moment) + tee.curvature_at(moment)) < 1e-5 * k ||
                  tee.moment(-k) != -moment);
    });
    const MomentCurvature plate(Plate<double>{}, steel());
    CHECK(std::isinf(plate.curvature_at(1.01 * Mp)));
    CHECK(plate.curvature_at(-1.01 * Mp) == -std::numeric_limits<double>::infinity());
}

TEST_CASE("a cantilever's tip goes down as Prager and Hodge say (P10)", "[law][fibres]") {
    const MomentCurvature plate(Plate<double>{}, steel());
    const double elastic = ky / 3; // length 1
    for (const auto& [m, known] : {std::pair{0.5, 0.5}, std::pair{1.2, 1.212982},
                                   std::pair{1.4, 1.547072}, std::pair{1.49, 1.966136}}) {
        CHECK(tip_deflection(plate, m * My) / elastic == Approx(known).epsilon(2e-6));
    }
}

TEST_CASE("fibres work in float and in other units", "[law][fibres][units]") {
    const MomentCurvature single(
        Plate<float>{}, BilinearCurve(BilinearCurveParameters<float>{.youngs_modulus = 200e9f,
                                                                     .yield_stress = 250e6f}));
    CHECK(single.moment(0.05f) == Approx(exact_plate(0.05)).epsilon(1e-5));
    // mm, N, MPa: N mm
    const MomentCurvature mm(Plate<double>{50, 100},
                             BilinearCurve(BilinearCurveParameters<double>{.youngs_modulus = 200e3,
                                                                           .yield_stress = 250.0}));
    CHECK(mm.moment(0.05e-3) == Approx(1e3 * exact_plate(0.05)).epsilon(1e-8));
}

TEST_CASE("a hinge of given length has the section's stiffness and moments",
          "[law][fibres][hinge]") {
    const MomentCurvature plate(Plate<double>{}, steel());
    const double length = 0.1;
    const auto hinge =
        moment_rotation(plate, HingeParameters<double>{.length = length, .curvature_max = 10 * ky});
    CHECK(hinge.stiffness == Approx(8333333.3333).epsilon(1e-9));
    CHECK(hinge.backbone.size() == 16);
    // P10's residual curvature is the plastic rotation over the hinge length
    const auto last = hinge.backbone.point(15);
    CHECK(last.travel == Approx(8.505 * ky * length).epsilon(1e-6));
    CHECK(last.strength == Approx(31145.83).epsilon(1e-6));
    CHECK(hinge.backbone.value(1.0) == last.strength);
    const double proof = hinge.backbone.value(0);
    const double curvature = plate.curvature_at(proof);
    CHECK((curvature - proof / plate.bending_stiffness()) / curvature ==
          Approx(1e-3).epsilon(1e-3));
    CHECK(proof > My);
    CHECK(proof < 1.05 * My);
}

TEST_CASE("more knots approach the hinge's true backbone to second order",
          "[law][fibres][hinge][order]") {
    const MomentCurvature plate(Plate<double>{}, steel());
    const auto worst = [&](std::size_t knots) {
        const auto hinge = moment_rotation<128>(
            plate, HingeParameters<double>{
                       .length = 1, .curvature_max = 10 * ky, .proof = 1e-3, .knots = knots});
        double error = 0;
        for (double k = 1.2 * ky; k < 9.9 * ky; k += 0.01 * ky) {
            const double plastic = k - exact_plate(k) / plate.bending_stiffness();
            error = std::max(error, std::abs(hinge.backbone.value(plastic) - exact_plate(k)) / Mp);
        }
        return error;
    };
    const double coarse = worst(16);
    CHECK(coarse < 1e-2);
    CHECK(std::log2(coarse / worst(121)) / 3 >= 1.8); // 15 pieces against 120
}

TEST_CASE("a hinge refuses what makes none", "[law][fibres][hinge][input]") {
    const MomentCurvature plate(Plate<double>{}, steel());
    using P = HingeParameters<double>;
    const auto refused = [&](const P& parameters) {
        return message_of([&] { (void)moment_rotation(plate, parameters); });
    };
    CHECK(refused({.curvature_max = 1}) == "Hinge.length = nan m: must be finite and > 0");
    CHECK(refused({.length = 0.1}) == "Hinge.curvature_max = nan 1/m: must be finite and > 0");
    CHECK(refused({.length = 0.1, .curvature_max = 0.024}) ==
          "Hinge.curvature_max = 0.024 1/m: must be beyond the proof curvature of the section");
    CHECK(refused({.length = 0.1, .curvature_max = 1, .proof = 0}) ==
          "Hinge.proof = 0: must be in (0, 0.5)");
    CHECK(refused({.length = 0.1, .curvature_max = 1, .knots = 33}) ==
          "Hinge.knots = 33: must be in [2, 32]");
    CHECK(message_of([] { MidpointFibres<double>(0); }) ==
          "MidpointFibres.count = 0: must be >= 1");
    CHECK(message_of([] { AdaptiveFibres<double>(0.0); }) ==
          "AdaptiveFibres.tolerance = 0: must be in (0, 0.1)");
}
