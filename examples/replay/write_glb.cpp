// SPDX-License-Identifier: MIT
#include "write_glb.hpp"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "files.hpp"

namespace ductile::replay {

namespace {

using Point = std::array<float, 3>;

struct Mesh {
    std::vector<Point> points, normals;
    std::vector<std::uint16_t> corners;

    void add_triangle(int a, int b, int c) {
        for (const int corner : {a, b, c}) corners.push_back(std::uint16_t(corner));
    }
    int add_point(const Point& point, const Point& normal) {
        points.push_back(point);
        normals.push_back(normal);
        return int(points.size()) - 1;
    }
    void add_quad(const std::array<int, 4>& corner) {
        add_triangle(corner[0], corner[1], corner[2]);
        add_triangle(corner[0], corner[2], corner[3]);
    }
};

/// Of half length 1.
Mesh cube() {
    Mesh mesh;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.f, 1.f}) {
            Point normal{};
            normal[axis] = side;
            std::array<int, 4> corner{};
            constexpr std::array<std::array<float, 2>, 4> round{
                {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
            for (std::size_t k = 0; k < 4; ++k) {
                Point point = normal;
                point[(axis + 1) % 3] = round[k][0] * side;
                point[(axis + 2) % 3] = round[k][1];
                corner[k] = mesh.add_point(point, normal);
            }
            mesh.add_quad(corner);
        }
    }
    return mesh;
}

constexpr int around = 24;
constexpr float turn = 2 * std::numbers::pi_v<float>;

/// Of radius 1.
Mesh ball() {
    constexpr int rings = 12;
    Mesh mesh;
    for (int i = 0; i <= rings; ++i) {
        const float polar = turn / 2 * float(i) / rings;
        for (int k = 0; k <= around; ++k) {
            const float angle = turn * float(k) / around;
            const Point point{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                              std::cos(polar)};
            mesh.add_point(point, point);
        }
    }
    constexpr int row = around + 1;
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const int at = i * row + k;
            mesh.add_quad({at, at + row, at + row + 1, at + 1});
        }
    }
    return mesh;
}

/// Of radius 1 and half length 1, along z.
Mesh cylinder() {
    Mesh mesh;
    const auto rim = [](int k, float z) {
        const float angle = turn * float(k) / around;
        return Point{std::cos(angle), std::sin(angle), z};
    };
    for (int k = 0; k <= around; ++k) {
        for (const float z : {-1.f, 1.f}) {
            const Point point = rim(k, z);
            mesh.add_point(point, {point[0], point[1], 0});
        }
    }
    for (int k = 0; k < around; ++k) mesh.add_quad({2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1});
    for (const float z : {-1.f, 1.f}) {
        const int centre = mesh.add_point({0, 0, z}, {0, 0, z});
        for (int k = 0; k <= around; ++k) mesh.add_point(rim(k, z), {0, 0, z});
        for (int k = 1; k <= around; ++k) {
            if (z > 0)
                mesh.add_triangle(centre, centre + k, centre + k + 1);
            else
                mesh.add_triangle(centre, centre + k + 1, centre + k);
        }
    }
    return mesh;
}

class Writer {
  public:
    Writer() {
        model_.asset.version = "2.0";
        model_.asset.generator = "ductile";
        model_.buffers.emplace_back();
        model_.scenes.emplace_back();
        model_.defaultScene = 0;
        // z up to y up
        const double half = std::numbers::sqrt2 / 2;
        root_ = add_node("scene");
        model_.nodes[std::size_t(root_)].rotation = {-half, 0, 0, half};
        model_.scenes[0].nodes.push_back(root_);
        colours_ = {add_material({0.62, 0.65, 0.70, 1}, 0.4),
                    add_material({0.32, 0.36, 0.33, 1}, 0)};
    }

    void add(const Recording& recording) {
        for (std::size_t i = 0; i < recording.bodies.size(); ++i) {
            const Body& body = recording.bodies[i];
            const int node = add_node(body.name);
            model_.nodes[std::size_t(root_)].children.push_back(node);
            place(node, drawable(recording.poses[i].front(), {}));
            for (const Shape& shape : body.shapes) add(node, shape, body.moves);
            if (body.moves && recording.times.size() > 1) move(node, recording, i);
        }
    }

    [[nodiscard]] std::string bytes() {
        if (!animation_.channels.empty()) model_.animations.push_back(animation_);
        model_.buffers[0].data = data_;
        std::ostringstream out;
        tinygltf::TinyGLTF writer;
        const auto fail = [](const std::string& why) {
            throw Error("the scene could not be written as glTF" + why);
        };
        try {
            if (!writer.WriteGltfSceneToStream(&model_, out, false, true)) fail("");
        } catch (const std::exception& error) { // a name that is no UTF-8
            fail(std::string(": ") + error.what());
        }
        return out.str();
    }

  private:
    /// What went to infinity, for which glTF has no number, stays where it was.
    [[nodiscard]] static Pose drawable(const Pose& pose, const Pose& last) {
        const auto known = [](double value) { return std::isfinite(float(value)); };
        const bool all = std::all_of(pose.position.begin(), pose.position.end(), known) &&
                         std::all_of(pose.turn.begin(), pose.turn.end(), known);
        return all ? pose : last;
    }
    int add_node(const std::string& name) {
        model_.nodes.emplace_back().name = name;
        return int(model_.nodes.size()) - 1;
    }
    int add_material(const std::vector<double>& colour, double metal) {
        tinygltf::Material material;
        material.pbrMetallicRoughness.baseColorFactor = colour;
        material.pbrMetallicRoughness.metallicFactor = metal;
        material.pbrMetallicRoughness.roughnessFactor = 0.6;
        model_.materials.push_back(material);
        return int(model_.materials.size()) - 1;
    }
    void place(int node, const Pose& pose) {
        tinygltf::Node& placed = model_.nodes[std::size_t(node)];
        placed.translation.assign(pose.position.begin(), pose.position.end());
        placed.rotation = {pose.turn[1], pose.turn[2], pose.turn[3], pose.turn[0]};
    }

    template <class Value>
    int add_view(const std::vector<Value>& values, int target) {
        while (data_.size() % 4 != 0) data_.push_back(0);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data_.size();
        view.byteLength = values.size() * sizeof(Value);
        view.target = target;
        data_.resize(data_.size() + view.byteLength);
        std::memcpy(data_.data() + view.byteOffset, values.data(), view.byteLength);
        model_.bufferViews.push_back(view);
        return int(model_.bufferViews.size()) - 1;
    }
    int add_accessor(int view, std::size_t count, int component, int type,
                     std::vector<double> low = {}, std::vector<double> high = {}) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.count = count;
        accessor.componentType = component;
        accessor.type = type;
        accessor.minValues = std::move(low);
        accessor.maxValues = std::move(high);
        model_.accessors.push_back(accessor);
        return int(model_.accessors.size()) - 1;
    }
    int mesh_of(ShapeKind kind, bool moves) {
        int& known = meshes_[std::size_t(kind)][moves];
        if (known >= 0) return known;
        const Mesh mesh = kind == ShapeKind::sphere     ? ball()
                          : kind == ShapeKind::cylinder ? cylinder()
                                                        : cube();
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = colours_[moves ? 0 : 1];
        const auto points = [&](const std::vector<Point>& values, bool bounds) {
            return add_accessor(add_view(values, TINYGLTF_TARGET_ARRAY_BUFFER), values.size(),
                                TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                bounds ? std::vector<double>{-1, -1, -1} : std::vector<double>{},
                                bounds ? std::vector<double>{1, 1, 1} : std::vector<double>{});
        };
        primitive.attributes["POSITION"] = points(mesh.points, true);
        primitive.attributes["NORMAL"] = points(mesh.normals, false);
        primitive.indices = add_accessor(
            add_view(mesh.corners, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER), mesh.corners.size(),
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
        model_.meshes.emplace_back().primitives.push_back(primitive);
        return known = int(model_.meshes.size()) - 1;
    }
    void add(int parent, const Shape& shape, bool moves) {
        const int node = add_node("");
        place(node, shape.in_body);
        tinygltf::Node& drawn = model_.nodes[std::size_t(node)];
        drawn.mesh = mesh_of(shape.kind, moves);
        const auto& s = shape.size;
        constexpr double thin = 1e-3; // of a plane [m]
        if (shape.kind == ShapeKind::sphere)
            drawn.scale = {s[0], s[0], s[0]};
        else if (shape.kind == ShapeKind::cylinder)
            drawn.scale = {s[0], s[0], s[1]};
        else if (shape.kind == ShapeKind::plane)
            drawn.scale = {s[0], s[1], thin};
        else
            drawn.scale = {s[0], s[1], s[2]};
        model_.nodes[std::size_t(parent)].children.push_back(node);
    }

    void move(int node, const Recording& recording, std::size_t body) {
        if (times_ < 0) {
            const std::vector<float> times(recording.times.begin(), recording.times.end());
            times_ =
                add_accessor(add_view(times, 0), times.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                             TINYGLTF_TYPE_SCALAR, {double(times.front())}, {double(times.back())});
        }
        std::vector<Point> places;
        std::vector<std::array<float, 4>> turns;
        Pose last;
        for (const Pose& seen : recording.poses[body]) {
            const Pose& pose = last = drawable(seen, last);
            const auto& p = pose.position;
            const auto& q = pose.turn;
            places.push_back({float(p[0]), float(p[1]), float(p[2])});
            turns.push_back({float(q[1]), float(q[2]), float(q[3]), float(q[0])});
        }
        add_channel(node, "translation",
                    add_accessor(add_view(places, 0), places.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                 TINYGLTF_TYPE_VEC3));
        add_channel(node, "rotation",
                    add_accessor(add_view(turns, 0), turns.size(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                 TINYGLTF_TYPE_VEC4));
    }
    void add_channel(int node, const std::string& path, int values) {
        tinygltf::AnimationSampler sampler;
        sampler.input = times_;
        sampler.output = values;
        sampler.interpolation = "LINEAR";
        animation_.samplers.push_back(sampler);
        tinygltf::AnimationChannel channel;
        channel.sampler = int(animation_.samplers.size()) - 1;
        channel.target_node = node;
        channel.target_path = path;
        animation_.channels.push_back(channel);
    }

    tinygltf::Model model_;
    tinygltf::Animation animation_;
    std::vector<unsigned char> data_;
    std::array<std::array<int, 2>, 4> meshes_{{{-1, -1}, {-1, -1}, {-1, -1}, {-1, -1}}};
    std::array<int, 2> colours_{};
    int root_ = 0, times_ = -1;
};

} // namespace

void write_glb(const Recording& recording, const std::filesystem::path& file) {
    check(recording);
    Writer writer;
    writer.add(recording);
    write_file(file, writer.bytes());
}

} // namespace ductile::replay
