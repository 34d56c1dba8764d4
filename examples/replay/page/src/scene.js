// SPDX-License-Identifier: MIT
//
// Draws a recording at a time: shapes as instances, members of several bodies as one bent strip,
// joints as markers that can be clicked.
import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { brokenColour, colourOf, lostColour, stillColour } from "./colours.js";
import { broken, placeOf, poseAt, unreliable } from "./recording.js";

const geometries = {
    box: () => new three.BoxGeometry(2, 2, 2),
    sphere: () => new three.SphereGeometry(1, 24, 16),
    cylinder: () => new three.CylinderGeometry(1, 1, 2, 24).rotateX(Math.PI / 2),
    plane: () => new three.BoxGeometry(2, 2, 2),
};

function scaleOf({ kind, size }) {
    if (kind === "sphere") return [size[0], size[0], size[0]];
    if (kind === "cylinder") return [size[0], size[0], size[1]];
    if (kind === "plane") return [size[0], size[1], 1e-3];
    return size;
}

/** Points and turns of a strip between its stations: four to a bay. */
const bays = 4;

class Strip {
    constructor(strip, material) {
        this.strip = strip;
        this.count = (strip.stations.length - 1) * bays + 1;
        const faces = [];
        for (let i = 0; i + 1 < this.count; ++i) {
            for (let k = 0; k < 4; ++k) {
                const a = 8 * i + 2 * k;
                faces.push(a, a + 1, a + 8, a + 1, a + 9, a + 8);
            }
        }
        const last = 8 * this.count;
        faces.push(last, last + 1, last + 2, last, last + 2, last + 3);
        faces.push(last + 4, last + 6, last + 5, last + 4, last + 7, last + 6);
        const points = last + 8;
        this.geometry = new three.BufferGeometry();
        this.geometry.setIndex(faces);
        this.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(3 * points), 3));
        this.geometry.setAttribute("normal", new three.BufferAttribute(new Float32Array(3 * points), 3));
        this.geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(3 * points), 3));
        this.mesh = new three.Mesh(this.geometry, material);
        this.mesh.frustumCulled = false;
    }

    /** `poses`: of all bodies; `colours`: of all bodies. */
    update(poses, colours) {
        const { stations, half_width, half_height } = this.strip;
        const places = [];
        const turns = [];
        for (const { body, in_body } of stations) {
            const pose = poses[body];
            const turn = new three.Quaternion(pose[4], pose[5], pose[6], pose[3]);
            const place = new three.Vector3(...in_body).applyQuaternion(turn);
            places.push(place.add(new three.Vector3(pose[0], pose[1], pose[2])));
            turns.push(turn);
        }
        const line = new three.CatmullRomCurve3(places, false, "centripetal");
        const position = this.geometry.attributes.position;
        const normal = this.geometry.attributes.normal;
        const colour = this.geometry.attributes.color;
        const x = new three.Vector3();
        const y = new three.Vector3();
        const z = new three.Vector3();
        const at = new three.Vector3();
        const turn = new three.Quaternion();
        const put = (index, along, across, n, c) => {
            position.setXYZ(index, at.x + along * x.x + across * y.x, at.y + along * x.y + across * y.y, at.z + along * x.z + across * y.z);
            normal.setXYZ(index, n.x, n.y, n.z);
            colour.setXYZ(index, ...c);
        };
        // round the section: right, top, left, bottom; each side has its own corners
        const round = [[1, -1], [1, 1], [-1, 1], [-1, -1], [1, -1]];
        for (let i = 0; i < this.count; ++i) {
            const bay = Math.min(stations.length - 2, Math.floor(i / bays));
            const share = (i - bay * bays) / bays;
            line.getPoint((bay + share) / (stations.length - 1), at);
            turn.slerpQuaternions(turns[bay], turns[bay + 1], share);
            x.set(1, 0, 0).applyQuaternion(turn);
            y.set(0, 1, 0).applyQuaternion(turn);
            const of = colours[stations[share < 0.5 ? bay : bay + 1].body];
            const sides = [x, y, x.clone().negate(), y.clone().negate()];
            for (let k = 0; k < 4; ++k) {
                for (let end = 0; end < 2; ++end) {
                    const [a, b] = round[k + end];
                    put(8 * i + 2 * k + end, a * half_width, b * half_height, sides[k], of);
                }
            }
            const cap = i === 0 ? 0 : i === this.count - 1 ? 4 : -1;
            if (cap >= 0) {
                z.crossVectors(x, y).multiplyScalar(cap === 0 ? -1 : 1);
                for (let k = 0; k < 4; ++k) {
                    put(8 * this.count + cap + k, round[k][0] * half_width, round[k][1] * half_height, z, of);
                }
            }
        }
        for (const attribute of [position, normal, colour]) attribute.needsUpdate = true;
    }
}

export class Scene {
    /** @param {HTMLElement} view */
    constructor(view, recording) {
        this.view = view;
        this.recording = recording;
        this.renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
        view.prepend(this.renderer.domElement);
        this.scene = new three.Scene();
        this.camera = new three.PerspectiveCamera(45, 1, 0.01, 1e4);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, this.renderer.domElement);
        this.controls.addEventListener("change", () => (this.stale = true));
        const sun = new three.DirectionalLight(0xffffff, 2.2);
        sun.position.set(3, -5, 8);
        this.scene.add(sun, new three.HemisphereLight(0xffffff, 0x8a8f98, 1.6));
        this.poses = recording.bodies.map(() => new Float64Array(7));
        this.colours = recording.bodies.map(() => stillColour);
        this.largestTravel = Math.max(1e-12, ...recording.joints.map((joint) => joint.plastic.reduce((a, b) => (b > a ? b : a), 0)));
        this.addStrips();
        this.addShapes();
        this.addMarkers();
        this.dark = matchMedia("(prefers-color-scheme: dark)");
        this.dark.addEventListener("change", () => this.paint());
        this.paint();
        this.resize();
        new ResizeObserver(() => this.resize()).observe(view);
        this.followed = -1;
        this.update(recording.times[0], "utilisation");
        this.reset();
    }

    paint() {
        this.scene.background = new three.Color(getComputedStyle(document.body).backgroundColor);
        this.stale = true;
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.view;
        if (!(width > 0 && height > 0)) return;
        this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.stale = true;
    }

    addStrips() {
        const material = new three.MeshLambertMaterial({ vertexColors: true, side: three.DoubleSide });
        this.strips = this.recording.strips.map((strip) => new Strip(strip, material));
        this.stripped = new Set(this.recording.strips.flatMap((strip) => strip.stations.map((s) => s.body)));
        for (const strip of this.strips) this.scene.add(strip.mesh);
    }

    addShapes() {
        const material = new three.MeshLambertMaterial();
        const kinds = new Map();
        this.recording.bodies.forEach((body, index) => {
            if (this.stripped.has(index)) return;
            for (const shape of body.shapes) {
                if (!kinds.has(shape.kind)) kinds.set(shape.kind, []);
                const { pose } = shape;
                const local = new three.Matrix4().compose(
                    new three.Vector3(pose[0], pose[1], pose[2]),
                    new three.Quaternion(pose[4], pose[5], pose[6], pose[3]),
                    new three.Vector3(...scaleOf(shape)),
                );
                kinds.get(shape.kind).push({ body: index, local });
            }
        });
        this.instances = [...kinds].map(([kind, items]) => {
            const mesh = new three.InstancedMesh(geometries[kind](), material, items.length);
            mesh.instanceColor = new three.InstancedBufferAttribute(new Float32Array(3 * items.length), 3);
            mesh.frustumCulled = false;
            this.scene.add(mesh);
            return { mesh, items };
        });
    }

    addMarkers() {
        const { joints } = this.recording;
        const geometry = new three.SphereGeometry(1, 12, 8);
        const material = new three.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.85 });
        this.markers = new three.InstancedMesh(geometry, material, Math.max(1, joints.length));
        this.markers.count = joints.length;
        this.markers.instanceColor = new three.InstancedBufferAttribute(new Float32Array(3 * Math.max(1, joints.length)), 3);
        this.markers.renderOrder = 1;
        this.markers.frustumCulled = false;
        this.scene.add(this.markers);
    }

    /** What a joint is coloured by, at a sample. */
    shareOf(joint, index, by) {
        return by === "plastic" ? joint.plastic[index] / this.largestTravel : joint.utilisation[index];
    }

    colourOfJoint(joint, index, by) {
        if (joint.state[index] & broken) return brokenColour;
        if (joint.state[index] & unreliable) return lostColour;
        return colourOf(this.shareOf(joint, index, by));
    }

    update(time, by) {
        const { recording, poses } = this;
        const place = placeOf(recording.times, time);
        recording.bodies.forEach((body, i) => poseAt(body, place, poses[i]));
        const shares = recording.bodies.map(() => -1);
        for (const joint of recording.joints) {
            if (joint.state[place.index] & broken) continue;
            const share = this.shareOf(joint, place.index, by);
            for (const body of [joint.a, joint.b]) {
                if (body >= 0) shares[body] = Math.max(shares[body], share);
            }
        }
        this.colours = shares.map((share, i) => {
            if (!recording.bodies[i].moves) return stillColour;
            return colourOf(Math.max(0, share));
        });
        const body = new three.Matrix4();
        const whole = new three.Matrix4();
        const point = new three.Vector3();
        const origin = new three.Vector3();
        const turn = new three.Quaternion();
        const one = new three.Vector3(1, 1, 1);
        const matrixOf = (pose) => body.compose(origin.set(pose[0], pose[1], pose[2]), turn.set(pose[4], pose[5], pose[6], pose[3]), one);
        for (const { mesh, items } of this.instances) {
            items.forEach((item, i) => {
                whole.multiplyMatrices(matrixOf(poses[item.body]), item.local);
                mesh.setMatrixAt(i, whole);
                mesh.instanceColor.setXYZ(i, ...this.colours[item.body]);
            });
            mesh.instanceMatrix.needsUpdate = true;
            mesh.instanceColor.needsUpdate = true;
        }
        for (const strip of this.strips) strip.update(poses, this.colours);
        const radius = 0.008 * (this.size ?? 1);
        recording.joints.forEach((joint, i) => {
            const anchor = joint.a >= 0 ? joint.a : joint.b;
            if (anchor < 0) return;
            point.set(...joint.in_a).applyMatrix4(matrixOf(poses[anchor]));
            whole.makeScale(radius, radius, radius).setPosition(point);
            this.markers.setMatrixAt(i, whole);
            this.markers.instanceColor.setXYZ(i, ...this.colourOfJoint(joint, place.index, by));
        });
        this.markers.instanceMatrix.needsUpdate = true;
        this.markers.instanceColor.needsUpdate = true;
        this.markers.boundingSphere = null;
        this.follow();
        this.stale = true;
    }

    follow() {
        if (this.followed < 0) return;
        const pose = this.poses[this.followed];
        const now = new three.Vector3(pose[0], pose[1], pose[2]);
        const moved = now.clone().sub(this.lastSeen ?? now);
        this.lastSeen = now;
        this.camera.position.add(moved);
        this.controls.target.add(moved);
    }

    setFollowed(body) {
        this.followed = body;
        this.lastSeen = undefined;
        this.follow();
    }

    /** Looks at all that moves, as it was at the start. */
    reset() {
        const bounds = new three.Box3();
        const corner = new three.Vector3();
        const size = new three.Vector3();
        const { bodies } = this.recording;
        const moving = bodies.some((body) => body.moves);
        for (const { mesh, items } of this.instances) {
            items.forEach((item, i) => {
                if (moving && !bodies[item.body].moves) return;
                const matrix = new three.Matrix4();
                mesh.getMatrixAt(i, matrix);
                for (let k = 0; k < 8; ++k) {
                    corner.set(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
                    bounds.expandByPoint(corner.applyMatrix4(matrix));
                }
            });
        }
        for (const strip of this.strips) {
            strip.geometry.computeBoundingBox();
            bounds.union(strip.geometry.boundingBox);
        }
        if (bounds.isEmpty() || !Number.isFinite(bounds.getSize(size).length())) bounds.set(new three.Vector3(-1, -1, -1), new three.Vector3(1, 1, 1));
        this.size = Math.max(1e-3, bounds.getSize(size).length());
        const centre = bounds.getCenter(new three.Vector3());
        const away = (0.62 * this.size) / Math.tan((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
        this.camera.position.copy(centre).addScaledVector(new three.Vector3(0.55, -0.75, 0.36).normalize(), away);
        this.camera.near = away / 500;
        this.camera.far = away * 50;
        this.camera.updateProjectionMatrix();
        this.controls.target.copy(centre);
        this.controls.update();
        this.lastSeen = undefined;
        this.stale = true;
    }

    /** Joint under a pointer; -1: none. */
    pick(event) {
        const box = this.renderer.domElement.getBoundingClientRect();
        const at = new three.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
        const ray = new three.Raycaster();
        ray.setFromCamera(at, this.camera);
        let best = -1;
        let nearest = 0.03; // of the view
        const place = new three.Vector3();
        const matrix = new three.Matrix4();
        for (let i = 0; i < this.recording.joints.length; ++i) {
            this.markers.getMatrixAt(i, matrix);
            place.setFromMatrixPosition(matrix).project(this.camera);
            const distance = Math.hypot((place.x - at.x) * this.camera.aspect, place.y - at.y);
            if (distance < nearest) [nearest, best] = [distance, i];
        }
        return best;
    }

    render() {
        if (!this.stale) return false;
        this.stale = false;
        this.renderer.render(this.scene, this.camera);
        return true;
    }

    /** Camera and target, to be kept in the address. */
    pose() {
        return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
    }
    setPose(numbers) {
        this.camera.position.fromArray(numbers, 0);
        this.controls.target.fromArray(numbers, 3);
        this.controls.update();
        this.stale = true;
    }
}
