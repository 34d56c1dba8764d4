// SPDX-License-Identifier: MIT
//
// Question: what does a solver of independent rows get wrong where forces share a yield surface?
//
// Table 1, one step. A force f* on the surface, drawn at random, and a trial beyond it along its
// normal, so that f* is the closest point: the right answer. The mapping is told a force that is
// off by an angle; the solver answers the trial inside the box it makes. Overshoot: excess of the
// trial over the tangent plane at f*, in units of the surface. Errors, normalised by the
// capacities:
//   force     |f - f*|
//   outside   γ(f) - 1, positive where the force exceeds the surface
//   flow      angle between the slips and ∇γ(f*); 90 where nothing slips
//
// Table 2, a whole motion. Rows of a joint (coupled masses, own share of a load that turns, with a
// static part that must be held at the end) over 2 s; error of the plastic travel left at the end
// against the exact surface at dt = 10 µs, relative to it. Mappings are combined with predictions:
//   last force     f' = f of the last step
//   predicted      predicted_force with the right mass
//   wrong mass     predicted_force with a mass 4 times too large on one axis and no coupling
// Baselines: the independent axes, and the exact surface enforced by closest-point projection.
//
// Usage: surface_mapping [--csv FILE]
#include <fmt/core.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <string_view>

#include "ductile/surface/bending_torsion.hpp"
#include "ductile/surface/biaxial_rectangle.hpp"
#include "ductile/surface/box_projection.hpp"
#include "ductile/surface/i_axial_bending.hpp"
#include "ductile/surface/rectangle_axial_bending.hpp"
#include "ductile/surface/row_box.hpp"
#include "ductile/surface/stopping_force.hpp"

namespace {

using namespace ductile;

enum class Mapping { independent, chords, exact };
constexpr std::array boxed{Mapping::independent, Mapping::chords};

std::string_view name(Mapping mapping) {
    switch (mapping) {
        case Mapping::independent:
            return "independent";
        case Mapping::chords:
            return "box_along";
        case Mapping::exact:
            return "exact";
    }
    return "";
}

template <YieldSurface T>
RowBox<double, T::dimension> box_of(Mapping mapping, const T& surface,
                                    const typename T::Vector& predicted) {
    using Vector = typename T::Vector;
    if (mapping == Mapping::chords) return box_along(surface, predicted);
    RowBox<double, T::dimension> box;
    for (int i = 0; i < T::dimension; ++i) {
        box.upper[i] = 1 / surface.value(Vector::Unit(i));
        box.lower[i] = -box.upper[i];
    }
    return box;
}

struct Csv {
    std::FILE* file = nullptr;

    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) const {
        if (file) fmt::print(file, format, std::forward<Args>(args)...);
    }
};

// ---- table 1
// ----------------------------------------------------------------------------------------

struct Error {
    double force_max = 0, force_mean = 0, outside_max = 0, flow_max = 0, flow_mean = 0;
};

template <YieldSurface T>
Error one_step(const T& surface, Mapping mapping, double angle, double overshoot) {
    using Vector = typename T::Vector;
    using Matrix = typename T::Matrix;
    constexpr int samples = 2000;
    constexpr double degree = std::numbers::pi / 180;
    std::mt19937 random(12345);
    std::normal_distribution<double> normal;
    const auto any = [&] { return Vector::NullaryExpr([&] { return normal(random); }).eval(); };

    Error error;
    for (int sample = 0; sample < samples; ++sample) {
        const Vector ray = any().normalized();
        const Vector side = any();
        const Vector across = (side - ray * ray.dot(side)).normalized();
        Matrix mass = Matrix::Identity(); // eigenvalues 1/2 to 2, coupled
        const Vector coupling = any().normalized();
        mass += (std::exp2(2 * (sample % 2) - 1) - 1) * coupling * coupling.transpose();

        const Vector exact = ray / surface.value(ray);
        const Vector flow = surface.normal(ray);
        const Vector push = mass * flow;
        const Vector trial = exact + push * (overshoot / flow.dot(push));
        const Vector told = std::cos(angle * degree) * ray + std::sin(angle * degree) * across;
        const Vector predicted = told / surface.value(told);

        const Vector force = enforce(box_of(mapping, surface, predicted), trial, mass);
        const Vector slip = mass.inverse() * (trial - force);
        const double off = (force - exact).norm();
        const double cosine = slip.dot(flow) / (slip.norm() * flow.norm());
        const bool slips = slip.norm() > 1e-12 * trial.norm();
        const double turn = slips ? std::acos(std::clamp(cosine, -1.0, 1.0)) / degree : 90;
        error.force_max = std::max(error.force_max, off);
        error.force_mean += off / samples;
        error.outside_max = std::max(error.outside_max, surface.value(force) - 1);
        error.flow_max = std::max(error.flow_max, turn);
        error.flow_mean += turn / samples;
    }
    return error;
}

template <YieldSurface T>
void table_one(const char* surface_name, const T& surface, const Csv& csv) {
    for (const double overshoot : {0.01, 0.1, 1.0, 10.0}) {
        for (const Mapping mapping : boxed) {
            for (const double angle : {0.0, 1.0, 5.0, 20.0}) {
                if (mapping == Mapping::independent && angle > 0) continue; // knows no prediction
                const Error e = one_step(surface, mapping, angle, overshoot);
                fmt::print("{:<20}{:<13}{:>9}{:>7}{:>12.2e}{:>12.2e}{:>12.2e}{:>9.2f}{:>9.2f}\n",
                           surface_name, name(mapping), overshoot, angle, e.force_max, e.force_mean,
                           e.outside_max, e.flow_max, e.flow_mean);
                csv.line("step,{},{},,,{},{},{},{},{},{},{}\n", surface_name, name(mapping),
                         overshoot, angle, e.force_max, e.force_mean, e.outside_max, e.flow_max,
                         e.flow_mean);
            }
        }
    }
}

// ---- table 2
// ----------------------------------------------------------------------------------------

enum class Prediction { last_force, predicted, wrong_mass };

std::string_view name(Prediction prediction) {
    switch (prediction) {
        case Prediction::last_force:
            return "last force";
        case Prediction::predicted:
            return "predicted";
        case Prediction::wrong_mass:
            return "wrong mass";
    }
    return "";
}

template <YieldSurface T>
struct Motion {
    const T& surface;
    typename T::Matrix mass;
    double stiffness; ///< of each row; infinite: rigid

    using Vector = typename T::Vector;
    using Matrix = typename T::Matrix;

    static Vector load(double time) {
        Vector load = Vector::Zero();
        const double pulse = time < 1 ? 1.3 : 0;
        load[0] = 0.4 + pulse * std::cos(4 * time);
        load[1] = 0.3 + pulse * std::sin(5 * time);
        if constexpr (T::dimension > 2) load[2] = 0.7 * pulse * std::cos(7 * time + 1);
        return load;
    }

    /// (M⁻¹ + K⁻¹/dt²)⁻¹/dt
    Matrix impedance(const Matrix& of_mass, double dt) const {
        const Matrix inverse = of_mass.inverse() + Matrix::Identity() / (stiffness * dt * dt);
        return inverse.inverse() / dt;
    }

    /// Plastic travel left at the end.
    Vector run(Mapping mapping, Prediction prediction, double dt) const {
        Matrix believed = mass;
        if (prediction == Prediction::wrong_mass) {
            believed = mass.diagonal().asDiagonal();
            believed(1, 1) *= 4;
        }
        const Matrix inverse = mass.inverse();
        const Matrix real = impedance(mass, dt);
        const Matrix guess = impedance(believed, dt);
        Vector force = Vector::Zero(), velocity = force, last_velocity = force, position = force;
        const int steps = int(std::lround(2 / dt));
        for (int step = 0; step < steps; ++step) {
            const Vector loaded = velocity + inverse * load((step + 0.5) * dt) * dt;
            // the implicit elastic row: f' = f - K dt u', u' = loaded + M⁻¹ f' dt
            const Vector trial = real * (force / (stiffness * dt) - loaded);
            if (mapping == Mapping::exact) {
                force = surface.project(trial, real);
            } else {
                const Vector told =
                    prediction == Prediction::last_force
                        ? force
                        : predicted_force(surface, force, velocity, last_velocity, guess);
                force = enforce(box_of(mapping, surface, told), trial, real);
            }
            last_velocity = velocity;
            velocity = loaded + inverse * force * dt;
            position += velocity * dt;
        }
        return position + force / stiffness;
    }
};

constexpr std::array steps_per_second{60, 240, 960, 3840};

template <YieldSurface T>
void table_two(const char* surface_name, const T& surface, const typename T::Matrix& mass,
               double stiffness, const Csv& csv) {
    const Motion<T> motion{surface, mass, stiffness};
    const auto reference = motion.run(Mapping::exact, Prediction::predicted, 1e-5);
    const char* kind = std::isinf(stiffness) ? "rigid" : "elastic";
    const auto row = [&](Mapping mapping, Prediction prediction, std::string_view label) {
        fmt::print("{:<20}{:<9}{:<13}{:<12}", surface_name, kind, name(mapping), label);
        for (const int rate : steps_per_second) {
            const double dt = 1.0 / rate;
            const double error =
                (motion.run(mapping, prediction, dt) - reference).norm() / reference.norm();
            fmt::print("{:>12.2e}", error);
            csv.line("motion,{} {},{},{},{},,,{},,,,\n", surface_name, kind, name(mapping), label,
                     dt, error);
        }
        fmt::print("\n");
    };
    row(Mapping::exact, Prediction::predicted, "-");
    row(Mapping::independent, Prediction::predicted, "-");
    for (const auto prediction :
         {Prediction::predicted, Prediction::wrong_mass, Prediction::last_force}) {
        row(Mapping::chords, prediction, name(prediction));
    }
}

} // namespace

int main(int argc, char** argv) {
    Csv csv;
    if (argc == 3 && std::strcmp(argv[1], "--csv") == 0) {
        csv.file = std::fopen(argv[2], "w");
        if (!csv.file) {
            fmt::print(stderr, "cannot write {}\n", argv[2]);
            return 1;
        }
    } else if (argc != 1) {
        fmt::print(stderr, "usage: surface_mapping [--csv FILE]\n");
        return 2;
    }

    const BendingTorsion<double> ellipse({.plastic_moment = 1, .plastic_torque = 1});
    const RectangleAxialBending<double> rectangle;
    const IAxialBending<double> i_section(
        {.height = 0.2, .width = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015},
        BendingAxis::strong);
    const BiaxialRectangle<double> biaxial;

    fmt::print("1. One step, 2000 random forces and masses; angle = prediction off by [deg]\n\n");
    fmt::print("{:<20}{:<13}{:>9}{:>7}{:>12}{:>12}{:>12}{:>9}{:>9}\n", "surface", "mapping",
               "oversh.", "angle", "force max", "mean", "outside", "flow max", "mean");
    csv.line(
        "table,surface,mapping,prediction,dt_s,overshoot,angle_deg,force_max,force_mean,outside_"
        "max,"
        "flow_max_deg,flow_mean_deg\n");
    table_one("ellipse", ellipse, csv);
    table_one("rectangle n-m", rectangle, csv);
    table_one("I strong n-m", i_section, csv);
    table_one("rectangle n-mx-my", biaxial, csv);

    fmt::print("\n2. A whole motion: relative error of the plastic travel at the step dt\n\n");
    fmt::print("{:<20}{:<9}{:<13}{:<12}", "surface", "rows", "mapping", "told");
    for (const int rate : steps_per_second) fmt::print("{:>12}", fmt::format("1/{} s", rate));
    fmt::print("\n");
    const Eigen::Matrix2d two{{0.05, 0.02}, {0.02, 0.03}};
    const Eigen::Matrix3d three{{0.05, 0.01, 0}, {0.01, 0.03, -0.01}, {0, -0.01, 0.04}};
    for (const double stiffness : {std::numeric_limits<double>::infinity(), 20.0}) {
        table_two("ellipse", ellipse, two, stiffness, csv);
        table_two("rectangle n-m", rectangle, two, stiffness, csv);
        table_two("I strong n-m", i_section, two, stiffness, csv);
        table_two("rectangle n-mx-my", biaxial, three, stiffness, csv);
    }
    if (csv.file) std::fclose(csv.file);
}
