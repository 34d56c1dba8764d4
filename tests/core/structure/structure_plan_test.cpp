// SPDX-License-Identifier: MIT
//
// Bodies and joints of a structure, without an engine: masses, inertia, stiffness, what is refused.
#include "ductile/structure/structure_plan.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "ductile/material/named.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/l_section.hpp"
#include "ductile/section/rectangle.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;
using V3 = Vector3<double>;

namespace {

const Material<double> steel(s355<double>());
const Rectangle<double> bar({.width = 0.1, .height = 0.2});
const ISection<double> heb(
    {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});

/// A clamped member of 3 m along `way`.
StructurePlan cantilever(const V3& way, const MemberOptions& parameters = {}) {
    StructureModel model;
    const NodeId root = model.node({1, 2, 3}), tip = model.node(V3(1, 2, 3) + 3 * way);
    model.member("beam", root, tip, bar, steel, parameters);
    model.support(root);
    return make_plan(model);
}

/// Portal of one body a member.
StructureModel portal() {
    StructureModel model;
    const NodeId a = model.node({0, 0, 0}), b = model.node({0, 0, 4});
    const NodeId c = model.node({6, 0, 4}), d = model.node({6, 0, 0});
    model.member("left", a, b, heb, steel);
    model.member("right", d, c, heb, steel);
    model.member("beam", b, c, heb, steel, {.setback = 0.1, .carried_mass = 3000});
    model.support(a);
    model.support(d);
    return model;
}

/// Inertia of all bodies about a point, world axes.
Matrix3<double> inertia_about(const StructurePlan& plan, const V3& point) {
    Matrix3<double> all = Matrix3<double>::Zero();
    for (const PlanBody& body : plan.bodies) {
        const Matrix3<double> arm = skew(V3(body.pose.origin - point));
        all += body.pose.axes * body.inertia.asDiagonal() * body.pose.axes.transpose() -
               body.mass * arm * arm;
    }
    return all;
}

/// What the tip of a clamped chain moves by under a unit force, or turns by under a unit moment,
/// at the tip, each about or along `direction`; small displacements.
struct Tip {
    V3 displacement = V3::Zero(), rotation = V3::Zero();
};
Tip under(const StructurePlan& plan, const V3& tip, const V3& force, const V3& moment) {
    Tip result;
    for (const PlanJoint& joint : plan.joints) {
        const V3 arm = tip - joint.frame.origin;
        const V3 about = joint.frame.axes.transpose() * (moment + arm.cross(force));
        const V3 along = joint.frame.axes.transpose() * force;
        const auto& k = joint.joint.parameters().stiffness;
        const V3 turn = joint.frame.axes * about.cwiseQuotient(V3(k[3], k[4], k[5]));
        result.rotation += turn;
        result.displacement +=
            turn.cross(arm) + joint.frame.axes * along.cwiseQuotient(V3(k[0], k[1], k[2]));
    }
    return result;
}

} // namespace

TEST_CASE("A member's axes: z along it, y up, or as it is told", "[structure]") {
    const auto axes = [](const V3& way, const MemberOptions& p = {}) {
        return cantilever(way, p).joints[0].frame.axes;
    };
    const Matrix3<double> along_x = axes(V3(1, 0, 0));
    CHECK(along_x.col(2) == V3(1, 0, 0));
    CHECK(along_x.col(1) == V3(0, 0, 1));
    CHECK(along_x.col(0) == V3(0, 1, 0));
    CHECK(axes(V3(0, 0, 1)) == Matrix3<double>::Identity());
    CHECK(axes(V3(0, 0, 1), {.up = V3(1, 0, 5)}).col(1).isApprox(V3(1, 0, 0)));
    const V3 slope = V3(1, 1, 1).normalized();
    const Matrix3<double> inclined = axes(slope);
    CHECK(inclined.col(2).isApprox(slope));
    CHECK(std::abs(inclined.col(0).z()) < 1e-15);
    CHECK(inclined.col(1).z() > 0);
    CHECK(inclined.determinant() == Approx(1));

    StructureModel y_up({.up = V3(0, 2, 0)});
    const NodeId a = y_up.node({0, 0, 0}), b = y_up.node({0, 3, 0}), c = y_up.node({4, 3, 0});
    y_up.member("column", a, b, bar, steel);
    y_up.member("beam", b, c, bar, steel);
    y_up.support(a);
    const StructurePlan plan = make_plan(y_up);
    CHECK(plan.joints[0].frame.axes.col(1) == V3(0, 0, 1)); // the column's
    CHECK(plan.joints[1].frame.axes.col(1) == V3(0, 1, 0));
}

TEST_CASE("The pieces of a member have its mass, centre and inertia", "[structure]") {
    const V3 way = V3(1, 2, 2) / 3.0, middle = V3(1, 2, 3) + 1.5 * way;
    const double mass = 7850 * 0.02 * 3;
    // of a bar about its centre: m (L²/12 + I/A) across, m (I_x + I_y)/A along
    const double about_x = mass * (9.0 / 12 + 0.04 / 12), about_y = mass * (9.0 / 12 + 0.01 / 12);
    const double about_z = mass * (0.04 + 0.01) / 12;
    for (const int pieces : {1, 2, 5}) {
        const StructurePlan plan = cantilever(way, {.pieces = pieces});
        REQUIRE(int(plan.bodies.size()) == pieces);
        REQUIRE(int(plan.joints.size()) == pieces);
        CHECK(plan.mass() == Approx(mass));
        V3 moment = V3::Zero();
        for (const PlanBody& body : plan.bodies) moment += body.mass * body.pose.origin;
        CHECK((moment / mass - middle).norm() < 1e-14);
        const Matrix3<double> axes = plan.joints[0].frame.axes;
        const Matrix3<double> inertia = axes.transpose() * inertia_about(plan, middle) * axes;
        const Matrix3<double> expected = V3(about_x, about_y, about_z).asDiagonal();
        CHECK((inertia - expected).cwiseAbs().maxCoeff() < 1e-12 * about_x);
    }
    const StructurePlan heavier = cantilever(way, {.mass_per_length = 20.0, .carried_mass = 500});
    CHECK(heavier.mass() == Approx(20 * 3 + 500));
    const StructurePlan boxed = cantilever(V3(0, 0, 1), {.gap = 0.01, .box_inertia = true});
    CHECK(boxed.bodies[0].half_lengths == V3(0.05, 0.1, 1.49));
    CHECK(boxed.bodies[0].inertia.x() == Approx(mass / 3 * (0.1 * 0.1 + 1.49 * 1.49)));
}

TEST_CASE("A body along the world's axes is not turned, its box is", "[structure]") {
    for (const V3& way : {V3(1, 0, 0), V3(-1, 0, 0), V3(0, -1, 0), V3(0, 0, 1), V3(0, 0, -1)}) {
        const PlanBody body = cantilever(way).bodies[0];
        CHECK(body.pose.axes == Matrix3<double>::Identity());
        CHECK(body.box.axes == Matrix3<double>::Identity());
        const V3 along = way.cwiseAbs();
        CHECK(body.half_lengths.dot(along) == Approx(1.5));
        CHECK(body.half_lengths.prod() == Approx(1.5 * 0.05 * 0.1));
        CHECK(body.inertia.dot(along) == Approx(body.mass * 0.05 / 12));
        if (along.z() == 0) CHECK(body.half_lengths.z() == Approx(0.1)); // strong axis level
    }
    const PlanBody inclined = cantilever(V3(1, 2, 2) / 3.0).bodies[0];
    CHECK(inclined.pose.axes.determinant() == Approx(1));
    CHECK(inclined.pose.axes.diagonal().minCoeff() > 0.3);
    CHECK(inclined.half_lengths.maxCoeff() == Approx(1.5));
}

TEST_CASE("A node's mass moves the centre of what it hangs on, and turns its axes", "[structure]") {
    StructureModel model;
    const NodeId a = model.node({0, 0, 0}), b = model.node({0, 0, 3});
    model.member("post", a, b, bar, steel, {.offset = V3(0.5, 0, 0)});
    model.support(a);
    const StructurePlan light = make_plan(model);
    model.mass(b, 100);
    model.mass(b, 50);
    const StructurePlan plan = make_plan(model);
    const double m = light.mass();
    CHECK(plan.mass() == Approx(m + 150));
    const V3 centre = (m * V3(0.5, 0, 1.5) + 150 * V3(0, 0, 3)) / (m + 150);
    CHECK((plan.bodies[0].pose.origin - centre).norm() < 1e-14);
    const V3 point(1, 2, 3);
    const Matrix3<double> arm = skew(V3(V3(0, 0, 3) - point));
    const Matrix3<double> expected = inertia_about(light, point) - 150 * arm * arm;
    CHECK((inertia_about(plan, point) - expected).norm() < 1e-12 * expected.norm());
    // the box stays where it was
    const PlanBody &body = plan.bodies[0], &was = light.bodies[0];
    CHECK((body.pose.origin + body.pose.axes * body.box.origin - was.pose.origin).norm() < 1e-14);
    CHECK((body.pose.axes * body.box.axes - was.pose.axes * was.box.axes).norm() < 1e-14);
}

TEST_CASE("A section that is not symmetric has its principal axes", "[structure]") {
    const LSection<double> angle({.width = 0.1, .height = 0.15, .thickness = 0.01});
    StructureModel model;
    const NodeId a = model.node({0, 0, 0}), b = model.node({2, 0, 0});
    model.member("angle", a, b, angle, steel);
    model.support(a);
    const StructurePlan plan = make_plan(model);
    const Matrix3<double> section = plan.joints[0].frame.axes;
    const Matrix3<double> inertia =
        section.transpose() * inertia_about(plan, plan.bodies[0].pose.origin) * section;
    CHECK(inertia(0, 1) ==
          Approx(-plan.mass() * angle.product_of_inertia() / angle.area()).epsilon(1e-12));
    CHECK(inertia(0, 1) != 0);
    // the box encloses the section, whose centroid is not in its middle
    const PlanBody& body = plan.bodies[0];
    const V3 box = section.transpose() * body.pose.axes * body.box.origin;
    CHECK(box.x() == Approx((angle.lowest(SectionAxis::y) + angle.highest(SectionAxis::y)) / 2));
    CHECK(body.half_lengths.x() == Approx(0.05));
}

TEST_CASE("Two pieces are as stiff as the elastic cantilever", "[structure]") {
    const double L = 3, E = 210e9, G = E / 2.6;
    const V3 x(0, 1, 0), y(0, 0, 1), z(1, 0, 0), tip = V3(1, 2, 3) + L * z; // of the section
    const double shear_x = G * bar.elastic_shear_area(SectionAxis::x);
    const double shear_y = G * bar.elastic_shear_area(SectionAxis::y);
    const double EIx = E * bar.second_moment(SectionAxis::x);
    const double EIy = E * bar.second_moment(SectionAxis::y);
    const V3 none = V3::Zero();
    for (const int pieces : {2, 3, 8}) {
        const StructurePlan plan = cantilever(z, {.pieces = pieces});
        CHECK(under(plan, tip, y, none).displacement.dot(y) ==
              Approx(L * L * L / (3 * EIx) + L / shear_y));
        CHECK(under(plan, tip, x, none).displacement.dot(x) ==
              Approx(L * L * L / (3 * EIy) + L / shear_x));
        CHECK(under(plan, tip, z, none).displacement.dot(z) == Approx(L / (E * bar.area())));
        CHECK(under(plan, tip, none, z).rotation.dot(z) ==
              Approx(L / (G * bar.torsion_constant())));
        CHECK(under(plan, tip, none, x).rotation.dot(x) == Approx(L / EIx));
        CHECK(under(plan, tip, y, none).rotation.dot(x) == Approx(-L * L / (2 * EIx)));
    }
    // one piece: right but for bending by a force at the tip
    const StructurePlan one = cantilever(z);
    CHECK(under(one, tip, none, x).rotation.dot(x) == Approx(L / EIx));
    CHECK(under(one, tip, none, z).rotation.dot(z) == Approx(L / (G * bar.torsion_constant())));
    CHECK(under(one, tip, y, none).displacement.dot(y) == Approx(L * L * L / EIx + L / shear_y));
    // as told: rods of one length, and a length of one's own
    const StructurePlan rods = cantilever(z, {.pieces = 4, .spacing = JointSpacing::equal});
    CHECK(under(rods, tip, none, x).rotation.dot(x) == Approx(L / EIx));
    CHECK(cantilever(z, {.pieces = 4, .joint_length = 0.2}).joints[2].length == 0.2);
}

TEST_CASE("The steepest that is not freed carries a node, the others are jointed to it",
          "[structure]") {
    const StructurePlan plan = make_plan(portal());
    REQUIRE(plan.bodies.size() == 3);
    REQUIRE(plan.joints.size() == 4);
    CHECK(plan.joints[plan.joint("left", MemberEnd::start)].b.kind == PlanSeat::Kind::ground);
    const PlanJoint& start = plan.joints[plan.joint("beam", MemberEnd::start)];
    const PlanJoint& end = plan.joints[plan.joint("beam", MemberEnd::end)];
    CHECK(start.name == "beam start");
    CHECK(start.b == PlanSeat{PlanSeat::Kind::body, plan.body("left")});
    CHECK(end.b == PlanSeat{PlanSeat::Kind::body, plan.body("right")});
    CHECK(start.frame.origin == V3(0.1, 0, 4));
    CHECK(end.frame.origin.isApprox(V3(5.9, 0, 4)));
    CHECK(start.length == Approx(2.9));
    CHECK(plan.neighbours.empty());
    CHECK(plan.mass() == Approx(7850 * heb.area() * (4 + 4 + 6) + 3000));

    // whatever the order; of equally steep ones the first
    StructureModel late;
    const NodeId low = late.node({0, 0, 0}), mid = late.node({0, 0, 3}), top = late.node({0, 0, 6});
    const NodeId far = late.node({5, 0, 3});
    late.member("beam", mid, far, heb, steel);
    late.member("below", low, mid, heb, steel);
    late.member("above", mid, top, heb, steel);
    late.support(low);
    const StructurePlan tower = make_plan(late);
    for (const char* name : {"beam", "above"}) {
        CHECK(tower.joints[tower.joint(name, MemberEnd::start)].b ==
              PlanSeat{PlanSeat::Kind::body, tower.body("below")});
    }

    StructureModel freed;
    const NodeId a = freed.node({0, 0, 0}), b = freed.node({3, 0, 0}), c = freed.node({6, 0, 0});
    freed.member("first", a, b, bar, steel, {.free_at_end = {JointAxis::bending_x}});
    freed.member("second", b, c, bar, steel);
    freed.support(a);
    freed.support(c);
    const StructurePlan hinged = make_plan(freed);
    CHECK(hinged.joints[hinged.joint("first", MemberEnd::end)].b ==
          PlanSeat{PlanSeat::Kind::body, hinged.body("second")});
    const auto& k = hinged.joints[hinged.joint("first", MemberEnd::end)].joint.parameters();
    CHECK(k.stiffness[3] == Approx(1e-9 * 210e9 * bar.second_moment() / 1.5));
    CHECK(k.stiffness[4] == Approx(210e9 * bar.second_moment(SectionAxis::y) / 1.5));
}

TEST_CASE("Where several meet, those that are not jointed do not collide", "[structure]") {
    StructureModel model;
    const NodeId foot = model.node({0, 0, 0}), top = model.node({0, 0, 3});
    const NodeId east = model.node({4, 0, 3}), north = model.node({0, 4, 3});
    model.member("column", foot, top, heb, steel);
    model.member("east", top, east, heb, steel);
    model.member("north", top, north, heb, steel);
    model.footing(foot, {.width = 0.6, .depth = 0.5, .height = 0.3, .mass = 260});
    const StructurePlan plan = make_plan(model);
    REQUIRE(plan.neighbours.size() == 1);
    CHECK(plan.neighbours[0] == std::pair(plan.body("east"), plan.body("north")));
    REQUIRE(plan.bodies.size() == 4);
    const PlanBody& block = plan.bodies.back();
    CHECK(block.pose.origin == V3(0, 0, -0.15));
    CHECK(block.half_lengths == V3(0.3, 0.25, 0.15));
    CHECK(block.mass == 260);
    CHECK(block.inertia.x() == Approx(260 / 12.0 * (0.5 * 0.5 + 0.3 * 0.3)));
    CHECK(plan.joints[plan.joint("column", MemberEnd::start)].b ==
          PlanSeat{PlanSeat::Kind::body, 3});
}

TEST_CASE("What is wrong is named with its value and what it may be", "[structure]") {
    StructureModel model;
    const NodeId a = model.node({0, 0, 0}), b = model.node({0, 0, 4}), c = model.node({0, 0, 4});
    const auto adding = [&](const MemberOptions& p, NodeId from = NodeId{0},
                            NodeId to = NodeId{1}) {
        StructureModel copy = model;
        return message_of([&] { copy.member("beam", from, to, bar, steel, p); });
    };
    CHECK(adding({}, a, NodeId{7}) ==
          "StructureModel.member(beam).end = node 7: must be a node of this model, which has 3");
    CHECK(adding({}, NodeId{}, b) ==
          "StructureModel.member(beam).start = no node: must be a node of this model, which has 3");
    CHECK(adding({}, b, c) ==
          "StructureModel.member(beam).length = 0 m: must be > 0: its nodes are at one place");
    CHECK(adding({}, b, b) ==
          "StructureModel.member(beam).length = 0 m: must be > 0: its nodes are at one place");
    CHECK(adding({.pieces = 0}) == "StructureModel.member(beam).pieces = 0: must be >= 1");
    CHECK(adding({.joint_length = -0.2}) ==
          "StructureModel.member(beam).joint_length = -0.2 m: must be finite and > 0");
    CHECK(adding({.setback = 2}) ==
          "StructureModel.member(beam).setback = 2 m: must be in [0, 2) m, half its length");
    CHECK(adding({.up = V3(0, 0, 1)}) ==
          "StructureModel.member(beam).up = (0, 0, 1): must be across its axis");
    CHECK(adding({.mass_per_length = 0.0}) ==
          "StructureModel.member(beam).mass_per_length = 0 kg/m: must be finite and > 0");
    CHECK(
        adding({.mass_per_length = 1e6}) ==
        "StructureModel.member(beam).mass_per_length = 1000000 kg/m: must be in (0, 200000] kg/m: "
        "a section's dimensions are metres");
    StructureModel long_one;
    const NodeId start = long_one.node({0, 0, 0}), end = long_one.node({0, 0, 4000});
    CHECK(
        message_of([&] { long_one.member("beam", start, end, bar, steel); }) ==
        "StructureModel.member(beam).length = 4000 m: must be in (0, 1000] m: lengths are metres");
    // a box of 100 x 100 x 4 mm that is told what it weighs
    const Box<double> millimetres(
        {.width = 100, .height = 100, .web_thickness = 4, .flange_thickness = 4});
    StructureModel wide = model;
    const std::string said = message_of([&] {
        wide.member("beam", NodeId{0}, NodeId{1}, millimetres, steel, {.mass_per_length = 12});
    });
    CHECK(said.find("StructureModel.member(beam).section.radius_of_gyration = 39.2258") == 0);
    CHECK(said.find("m: must be <= 10 m, or its length: a section's dimensions are metres") <
          said.size());
    CHECK(adding({.carried_mass = NAN}) ==
          "StructureModel.member(beam).carried_mass = nan kg: must be finite and >= 0");
    CHECK(adding({.gap = 2}) ==
          "StructureModel.member(beam).gap = 2 m: must be in [0, 2) m, half a piece");
    CHECK(adding({.largest_bending = 0}) ==
          "StructureModel.member(beam).largest_bending = 0 rad: "
          "must be > 0 (infinity: no limit)");
    CHECK(message_of([&] {
              (void)model.node({0, INFINITY, 0});
          }) == "StructureModel.node.at = (0, inf, 0): must be finite");
    CHECK(message_of([&] {
              (void)model.node({0, 1e160, 0});
          }) == "StructureModel.node.at = (0, 1e+160, 0): must be at most 1e+100 in size");
    CHECK(message_of([] { StructureModel flat({.up = V3(0, 0, 0)}); }) ==
          "StructureModel.up = (0, 0, 0): must be finite and not zero");
    CHECK(message_of([] { StructureModel flat({.up = V3(0, 0, 1e-300)}); }) ==
          "StructureModel.up = (0, 0, 1e-300): must be at least 1e-100 in size");
    CHECK(message_of([&] { model.support(NodeId{9}); }) ==
          "StructureModel.support.node = node 9: must be a node of this model, which has 3");
    CHECK(message_of([&] { model.mass(a, -1); }) ==
          "StructureModel.mass.mass = -1 kg: must be finite and > 0");
    CHECK(message_of([&] { model.footing(a, {.width = 1, .depth = 1, .height = 1}); }) ==
          "StructureModel.footing.mass = nan kg: must be finite and > 0");

    CHECK(message_of([&] { (void)make_plan(model); }) ==
          "StructureModel.members = none: must be at least one");
    model.member("post", a, b, bar, steel);
    CHECK(message_of([&] { model.member("post", a, c, bar, steel); }) ==
          "StructureModel.member.name = post: must be of one member alone");
    model.support(c);
    CHECK(message_of([&] { (void)make_plan(model); }) ==
          "StructureModel.node 2 = (0, 0, 4): must be an end of a member");
}

TEST_CASE("A mass where nothing moves, and two holds of one node, are refused", "[structure]") {
    StructureModel model = portal();
    model.mass(NodeId{0}, 500);
    CHECK(message_of([&] { (void)make_plan(model); }) ==
          "StructureModel.node 0.mass = 500 kg: must be 0 where the node is the ground or a body "
          "of the user's");
    CHECK(message_of([&] {
              model.footing(NodeId{0}, {.width = 1, .depth = 1, .height = 1, .mass = 1});
          }) == "StructureModel.footing.node = node 0: must be one without a support");
    const NodeId own[] = {{3}};
    CHECK(message_of([&] { (void)make_plan(portal(), own); }) ==
          "Structure.own.node = node 3: must be one without a support");
    const NodeId nowhere[] = {{12}};
    CHECK(message_of([&] { (void)make_plan(portal(), nowhere); }) ==
          "Structure.own.node = node 12: must be a node of the model, which has 4");
}

TEST_CASE("A mechanism by count is refused unless it is wanted", "[structure]") {
    const auto bars = [](bool wanted, bool supported) {
        StructureModel model({.mechanism = wanted});
        const NodeId a = model.node({0, 0, 0}), b = model.node({3, 0, 0});
        const auto pin = JointAxis::bending_x;
        model.member("beam", a, b, bar, steel, {.free_at_start = {pin, JointAxis::bending_y, pin}});
        if (supported) model.support(a);
        return model;
    };
    CHECK(
        message_of([&] { (void)make_plan(bars(false, true)); }) ==
        "StructureModel.mechanism = false: must be true where parts move freely: of beam and what "
        "hangs together with it no joint holds 2 of the freedoms");
    CHECK(make_plan(bars(true, true)).joints.size() == 1);
    CHECK(make_plan(bars(false, false)).joints.empty()); // one body, free
}

TEST_CASE("What is asked for by name is found or refused", "[structure]") {
    const StructurePlan plan = make_plan(portal());
    CHECK(plan.body("beam") == 2);
    CHECK(plan.joint("beam", 1) == plan.joint("beam", MemberEnd::end));
    CHECK(message_of([&] { (void)plan.body("bean"); }) ==
          "Structure.member = bean: must be the name of a member");
    CHECK(message_of([&] { (void)plan.body("beam", 1); }) ==
          "Structure.body(beam).piece = 1: must be less than 1");
    CHECK(message_of([&] { (void)plan.joint("beam", 2); }) ==
          "Structure.joint(beam).number = 2: must be less than 2");
    CHECK(message_of([&] { (void)plan.joint("left", MemberEnd::end); }) ==
          "Structure.joint(left).end = end: must be a jointed end: this one carries its node");
}
