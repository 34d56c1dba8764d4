// SPDX-License-Identifier: MIT
//
// For tests of Bullet's solvers: a constraint of free rows, solvers that let their impulses be
// read, and the exact answer for the same rows.
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/bullet/soft_mlcp_solver.hpp"
#include "ductile/bullet/soft_solvers.hpp"
#include "reference/boxed_lcp.hpp"

namespace ductile::test {

/// u' + C λ = b, lower <= λ <= upper, with u = (lin_a, ang_a, lin_b, ang_b) · (v_a, ω_a, v_b, ω_b).
struct FreeRow {
    btVector3 lin_a, ang_a, lin_b, ang_b;
    double target = 0;                                    ///< b [m/s]
    double lower = -SIMD_INFINITY, upper = SIMD_INFINITY; ///< [N s]
    double compliance = 0;                                ///< C [1/kg]
};

/// Writes its rows as soft_rows.hpp says: C where the solver is exact, else what `otherwise` says.
class FreeRows final : public btTypedConstraint, public bullet::SoftRows {
  public:
    FreeRows(btRigidBody& a, btRigidBody& b, std::vector<FreeRow> wanted)
        : btTypedConstraint(MAX_CONSTRAINT_TYPE, a, b), rows(std::move(wanted)) {}

    void getInfo1(btConstraintInfo1* info) override {
        info->m_numConstraintRows = int(rows.size());
        info->nub = 0;
    }
    void getInfo2(btConstraintInfo2* info) override {
        was_exact = compliance_is_exact();
        for (int i = 0; i < int(rows.size()); ++i) {
            const FreeRow& row = rows[std::size_t(i)];
            const int at = i * info->rowskip;
            for (int k = 0; k < 3; ++k) {
                info->m_J1linearAxis[at + k] = row.lin_a[k];
                info->m_J1angularAxis[at + k] = row.ang_a[k];
                info->m_J2linearAxis[at + k] = row.lin_b[k];
                info->m_J2angularAxis[at + k] = row.ang_b[k];
            }
            info->m_constraintError[at] = btScalar(row.target);
            info->m_lowerLimit[at] = btScalar(row.lower);
            info->m_upperLimit[at] = btScalar(row.upper);
            info->cfm[at] = btScalar(was_exact ? row.compliance : row.compliance * mass(row));
        }
    }
    void setParam(int, btScalar, int) override {}
    btScalar getParam(int, int) const override { return 0; }

    /// m = 1/(J M⁻¹ Jᵀ) [kg]
    [[nodiscard]] double mass(const FreeRow& row) const {
        return 1 / (double(m_rbA.getInvMass()) * double(row.lin_a.length2()) +
                    double(m_rbB.getInvMass()) * double(row.lin_b.length2()) +
                    double(row.ang_a.dot(m_rbA.getInvInertiaTensorWorld() * row.ang_a)) +
                    double(row.ang_b.dot(m_rbB.getInvInertiaTensorWorld() * row.ang_b)));
    }

    std::vector<FreeRow> rows;
    bool was_exact = false;
};

/// Keeps the joint rows' impulses of the last solve [N s].
template <class Solver>
class Recording final : public Solver {
  public:
    using Solver::Solver;
    std::vector<double> impulses;

  protected:
    btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                           const btContactSolverInfo& info) override {
        impulses.clear();
        for (int i = 0; i < this->m_tmpSolverNonContactConstraintPool.size(); ++i) {
            impulses.push_back(
                double(btScalar(this->m_tmpSolverNonContactConstraintPool[i].m_appliedImpulse)));
        }
        return Solver::solveGroupCacheFriendlyFinish(bodies, count, info);
    }
};

/// Any solver by name, "soft-" for those of this library.
class NamedSolver {
  public:
    explicit NamedSolver(const std::string& name) {
        if (name == "si") {
            keep<btSequentialImpulseConstraintSolver>();
        } else if (name == "nncg") {
            keep<btNNCGConstraintSolver>();
        } else if (name == "soft-si") {
            keep<bullet::SoftSequentialImpulseSolver>();
        } else if (name == "soft-nncg") {
            keep<bullet::SoftNncgSolver>();
        } else {
            keep_mlcp(name);
        }
    }

    [[nodiscard]] btConstraintSolver& operator*() { return *solver_; }
    [[nodiscard]] const std::vector<double>& impulses() const { return *impulses_; }
    /// Islands that a direct solver gave back to sequential impulse.
    [[nodiscard]] int fallbacks() const { return mlcp_ != nullptr ? mlcp_->getNumFallbacks() : 0; }

  private:
    template <class Solver, class... Arguments>
    Solver* keep(Arguments&&... arguments) {
        auto solver = std::make_unique<Recording<Solver>>(std::forward<Arguments>(arguments)...);
        Recording<Solver>* raw = solver.get();
        impulses_ = &raw->impulses;
        solver_ = std::move(solver);
        return raw;
    }

    void keep_mlcp(const std::string& name) {
        const std::string inner = name.substr(name.rfind('-') + 1);
        if (inner == "dantzig") lcp_ = std::make_unique<btDantzigSolver>();
        if (inner == "lemke") lcp_ = std::make_unique<btLemkeSolver>();
        if (inner == "pgs") lcp_ = std::make_unique<btSolveProjectedGaussSeidel>();
        if (lcp_ == nullptr) throw std::invalid_argument("no solver " + name);
        if (name.starts_with("mlcp-")) {
            mlcp_ = keep<btMLCPSolver>(lcp_.get());
        } else {
            mlcp_ = keep<bullet::SoftMlcpSolver>(
                *lcp_, inner == "pgs" ? bullet::Answer::iterated : bullet::Answer::exact);
        }
    }

    std::unique_ptr<btMLCPSolverInterface> lcp_;
    std::unique_ptr<btConstraintSolver> solver_;
    btMLCPSolver* mlcp_ = nullptr;
    const std::vector<double>* impulses_ = nullptr;
};

/// Bodies and rows, solved once as one island, without gravity.
class RowSystem {
  public:
    btRigidBody& body(double mass, const btVector3& inertia, const btVector3& v,
                      const btVector3& w) {
        bodies_.push_back(std::make_unique<btRigidBody>(
            btRigidBody::btRigidBodyConstructionInfo(btScalar(mass), nullptr, &shape_, inertia)));
        bodies_.back()->setFlags(0); // no gyroscopic moment: the rows are all there is
        bodies_.back()->setLinearVelocity(v);
        bodies_.back()->setAngularVelocity(w);
        return *bodies_.back();
    }
    FreeRows& join(btRigidBody& a, btRigidBody& b, std::vector<FreeRow> rows) {
        joints_.push_back(std::make_unique<FreeRows>(a, b, std::move(rows)));
        return *joints_.back();
    }
    [[nodiscard]] btRigidBody& body(std::size_t i) { return *bodies_[i]; }
    [[nodiscard]] FreeRows& joint(std::size_t i) { return *joints_[i]; }
    [[nodiscard]] std::size_t joints() const { return joints_.size(); }

    /// Assembles A, g and bounds from what the bodies are now; solve() changes their velocities.
    void assemble() {
        const auto n = rows();
        jacobian_ = reference::Matrix<double>::Zero(n, 6 * Eigen::Index(bodies_.size()));
        reference::Matrix<double> inverse_mass =
            reference::Matrix<double>::Zero(jacobian_.cols(), jacobian_.cols());
        for (Eigen::Index k = 0; k < Eigen::Index(bodies_.size()); ++k) {
            const btRigidBody& b = *bodies_[std::size_t(k)];
            inverse_mass.block<3, 3>(6 * k, 6 * k).diagonal().setConstant(double(b.getInvMass()));
            inverse_mass.block<3, 3>(6 * k + 3, 6 * k + 3) =
                bullet::to_core(b.getInvInertiaTensorWorld());
        }
        lower.resize(n), upper.resize(n), target_.resize(n), compliance_.resize(n);
        Eigen::Index at = 0;
        for (const auto& joint : joints_) {
            for (const FreeRow& row : joint->rows) {
                write(at, joint->getRigidBodyA(), row.lin_a, row.ang_a);
                write(at, joint->getRigidBodyB(), row.lin_b, row.ang_b);
                lower[at] = row.lower, upper[at] = row.upper;
                target_[at] = row.target, compliance_[at] = row.compliance;
                ++at;
            }
        }
        matrix = jacobian_ * inverse_mass * jacobian_.transpose();
        matrix.diagonal() += compliance_;
        offset = jacobian_ * velocities() - target_;
    }

    void solve(btConstraintSolver& solver, int iterations) {
        btContactSolverInfo info;
        info.m_timeStep = btScalar(1) / 60;
        info.m_numIterations = iterations;
        std::vector<btCollisionObject*> objects;
        for (auto& b : bodies_) objects.push_back(b.get());
        std::vector<btTypedConstraint*> constraints;
        for (auto& j : joints_) constraints.push_back(j.get());
        solver.solveGroup(objects.data(), int(objects.size()), nullptr, 0, constraints.data(),
                          int(constraints.size()), info, nullptr, nullptr);
    }

    /// Largest violation of a row's condition, from the bodies' velocities now and `impulses`: how
    /// far a step to its own optimum would still move the bodies, and what is out of bounds, as a
    /// share of scale().
    [[nodiscard]] double violation(const std::vector<double>& impulses) const {
        const reference::Vector<double> lambda =
            Eigen::Map<const reference::Vector<double>>(impulses.data(), rows());
        const reference::Vector<double> w =
            jacobian_ * velocities() + compliance_.cwiseProduct(lambda) - target_;
        double most = 0;
        for (Eigen::Index i = 0; i < rows(); ++i) {
            const double optimum = lambda[i] - w[i] / matrix(i, i);
            const double step = std::clamp(optimum, lower[i], upper[i]) - lambda[i];
            most = std::max(most, std::abs(step) * mobility(i));
        }
        return most / scale();
    }
    /// Largest difference of an impulse from the exact one, as the velocity it gives, as a share of
    /// scale().
    [[nodiscard]] double error(const std::vector<double>& impulses) const {
        const reference::Vector<double> right = exact();
        double most = 0;
        for (Eigen::Index i = 0; i < rows(); ++i) {
            const double difference = std::abs(impulses[std::size_t(i)] - right[i]) * mobility(i);
            most = std::isfinite(difference) ? std::max(most, difference)
                                             : std::numeric_limits<double>::infinity();
        }
        return most / scale();
    }
    /// The exact impulses [N s]. Solved for what is beyond the given forces and in rows of unit
    /// diagonal, because the reference's tolerance is a share of the largest C λ.
    [[nodiscard]] reference::Vector<double> exact() const {
        const reference::Vector<double> given = lower.cwiseMax(0.0).cwiseMin(upper);
        std::vector<Eigen::Index> open;
        for (Eigen::Index i = 0; i < rows(); ++i) {
            if (lower[i] < upper[i]) open.push_back(i);
        }
        if (open.empty()) return given;
        const reference::Vector<double> unit = matrix.diagonal()(open).cwiseSqrt().cwiseInverse();
        const reference::Vector<double> per_unit = unit.cwiseInverse();
        const reference::Matrix<double> a =
            unit.asDiagonal() * matrix(open, open) * unit.asDiagonal();
        const reference::Vector<double> g =
            unit.cwiseProduct((offset + matrix * given).eval()(open));
        reference::Vector<double> result = given;
        result(open) += unit.cwiseProduct(
            reference::BoxedLcp<double>().solve(a, g, per_unit.cwiseProduct((lower - given)(open)),
                                                per_unit.cwiseProduct((upper - given)(open))));
        return result;
    }
    /// Largest velocity that there is to be dealt with, asked for or given by a force [m/s].
    [[nodiscard]] double scale() const {
        double largest = offset.cwiseAbs().maxCoeff();
        for (Eigen::Index i = 0; i < rows(); ++i) {
            largest =
                std::max(largest, std::abs(std::clamp(0.0, lower[i], upper[i])) * mobility(i));
        }
        return largest;
    }
    [[nodiscard]] Eigen::Index rows() const {
        Eigen::Index n = 0;
        for (const auto& joint : joints_) n += Eigen::Index(joint->rows.size());
        return n;
    }

    reference::Matrix<double> matrix; ///< A = J M⁻¹ Jᵀ + C
    reference::Vector<double> offset; ///< g = J v - b
    reference::Vector<double> lower, upper;

  private:
    /// 1/m of a row [1/kg]
    [[nodiscard]] double mobility(Eigen::Index i) const { return matrix(i, i) - compliance_[i]; }
    [[nodiscard]] reference::Vector<double> velocities() const {
        reference::Vector<double> v(6 * Eigen::Index(bodies_.size()));
        for (Eigen::Index k = 0; k < Eigen::Index(bodies_.size()); ++k) {
            v.segment<3>(6 * k) = bullet::to_core(bodies_[std::size_t(k)]->getLinearVelocity());
            v.segment<3>(6 * k + 3) =
                bullet::to_core(bodies_[std::size_t(k)]->getAngularVelocity());
        }
        return v;
    }
    void write(Eigen::Index row, const btRigidBody& b, const btVector3& lin, const btVector3& ang) {
        for (Eigen::Index k = 0; k < Eigen::Index(bodies_.size()); ++k) {
            if (bodies_[std::size_t(k)].get() != &b) continue;
            jacobian_.row(row).segment<3>(6 * k) = bullet::to_core(lin).transpose();
            jacobian_.row(row).segment<3>(6 * k + 3) = bullet::to_core(ang).transpose();
        }
    }

    btSphereShape shape_{1};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<FreeRows>> joints_;
    reference::Matrix<double> jacobian_;
    reference::Vector<double> target_, compliance_;
};

} // namespace ductile::test
