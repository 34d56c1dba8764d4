// SPDX-License-Identifier: MIT
//
// Draws a recording at a time: all shapes as one mesh whose bodies' places are a texture, members of
// several bodies as one bent bar, joints as points that can be clicked. Three calls, whatever there
// is; instances would be as few, but where pixels are drawn by software each is a call of its own.
import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

import { chains, clamps, members, reaches } from "./chains.js";
import { brokenColour, colourOf, lostColour, stillColour } from "./colours.js";
import { broken, placeOf, poseAt, unreliable } from "./recording.js";

// Lit at the corners, not at the pixels: of flat faces in parallel light that is the same.
const light = `
varying vec3 shown;
void light(vec3 place, vec3 normal, vec3 tint) {
    float sun = max(0.0, dot(normal, normalize(vec3(3.0, -5.0, 8.0))));
    shown = tint * (mix(0.5, 0.75, 0.5 + 0.5 * normal.z) + 0.4 * sun);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;
const perRow = 64; // bodies in a row of the texture
const ofBodies = `
uniform sampler2D bodies;
attribute float body;
${light}
vec3 turned(vec3 v, vec4 q) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
    ivec2 at = ivec2(3 * (int(body) % ${perRow}), int(body) / ${perRow});
    vec4 place = texelFetch(bodies, at, 0); // and whether it is drawn
    vec4 turn = texelFetch(bodies, at + ivec2(1, 0), 0);
    light(place.xyz + turned(place.w * position, turn), turned(normal, turn), texelFetch(bodies, at + ivec2(2, 0), 0).xyz);
}`;
const ofBars = `
${light}
void main() {
    vec3 n = normalize(normal);
    light(position, dot(n, cameraPosition - position) < 0.0 ? -n : n, color);
}`;
const ofPoints = `
uniform float size;
varying vec3 shown;
void main() {
    shown = color;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
    gl_PointSize = max(3.0, size * projectionMatrix[1][1] / gl_Position.w);
}`;
const filled = `
varying vec3 shown;
void main() { gl_FragColor = vec4(shown, 1.0); }`;
const round = `
varying vec3 shown;
void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(shown, 0.85);
}`;

const geometries = {
    box: () => new three.BoxGeometry(2, 2, 2),
    sphere: () => new three.SphereGeometry(1, 20, 14),
    cylinder: () => new three.CylinderGeometry(1, 1, 2, 24).rotateX(Math.PI / 2),
    plane: () => new three.BoxGeometry(2, 2, 2),
};

function scaleOf({ kind, size }) {
    if (kind === "sphere") return [size[0], size[0], size[0]];
    if (kind === "cylinder") return [size[0], size[0], size[1]];
    if (kind === "plane") return [size[0], size[1], 1e-3];
    return size;
}

// for a moment
const [point, at, x, y, z, left, below] = Array.from({ length: 7 }, () => new three.Vector3());
const [turn, next] = [new three.Quaternion(), new three.Quaternion()];
/** Round a section: right, top, left, bottom; each side has its own corners. */
const outline = [[1, -1], [1, 1], [-1, 1], [-1, -1], [1, -1]];

const bays = 6; // of a bar between two joints

const hardly = 1e-3; // a bend that is not drawn [rad]

/** A chain of bodies (chains.js) as one bar: through its joints, along the bodies between them. */
class Bar {
    /** @param held  what holds the ends of each body (clamps) */
    constructor(chain, held, material) {
        this.chain = chain;
        this.ends = [-1, 1].map((side) => {
            const { body, axis, sign } = chain.at(side < 0 ? 0 : -1);
            return held[body].filter((end) => end.axis === axis && end.sign === side * sign);
        });
        this.count = chain.length * bays + 1;
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
        this.geometry = new three.BufferGeometry();
        this.geometry.setIndex(faces);
        for (const name of ["position", "normal", "color"]) {
            this.geometry.setAttribute(name, new three.BufferAttribute(new Float32Array(3 * (last + 8)), 3));
        }
        this.mesh = new three.Mesh(this.geometry, material);
        this.mesh.frustumCulled = false;
        this.stations = Array.from({ length: chain.length + 1 }, () => ({ at: new three.Vector3(), along: new three.Vector3() }));
    }

    /** Where the joints are, and which way the bar goes there: the mean of the two bodies. */
    place(poses) {
        const { chain, stations } = this;
        for (const { at, along } of stations) at.set(0, 0, 0), along.set(0, 0, 0);
        chain.forEach(({ body, axis, sign, entry, exit }, i) => {
            const pose = poses[body];
            turn.set(pose[4], pose[5], pose[6], pose[3]);
            for (const [station, end] of [[stations[i], entry], [stations[i + 1], exit]]) {
                station.at.add(point.fromArray(end).applyQuaternion(turn)).add(point.fromArray(pose));
                station.along.add(point.set(0, 0, 0).setComponent(axis, sign).applyQuaternion(turn));
            }
        });
        for (let i = 1; i < chain.length; ++i) stations[i].at.multiplyScalar(0.5);
        for (const { along } of stations) along.normalize();
        this.bent = chain.length > 1;
        this.ends.forEach((ends, i) => {
            const { along } = stations[i * chain.length];
            const own = x.copy(along);
            for (const { other, share, along: wanted } of ends) {
                point.fromArray(wanted).multiplyScalar(i === 0 ? -1 : 1); // the way the bar goes
                if (other >= 0) point.applyQuaternion(turn.set(poses[other][4], poses[other][5], poses[other][6], poses[other][3]));
                along.addScaledVector(point.sub(own), share / ends.length);
            }
            along.normalize();
            this.bent ||= along.distanceTo(own) > hardly;
        });
    }

    /** `poses`, `colours`: of all bodies. */
    update(poses, colours) {
        this.place(poses);
        this.mesh.visible = this.bent;
        if (!this.bent) return;
        const { chain, stations } = this;
        const { position, normal, color } = this.geometry.attributes;
        const write = (attribute, index, v) => v.toArray(attribute.array, 3 * index);
        for (let i = 0; i < this.count; ++i) {
            const bay = Math.min(chain.length - 1, Math.floor(i / bays));
            const s = i / bays - bay;
            const { body, axis, half } = chain[bay];
            const [from, to] = [stations[bay], stations[bay + 1]];
            const length = from.at.distanceTo(to.at);
            // a cubic through both joints
            const [r, q] = [1 - s, s * s];
            at.copy(from.at).multiplyScalar((1 + 2 * s) * r * r).addScaledVector(to.at, q * (3 - 2 * s));
            at.addScaledVector(from.along, length * s * r * r).addScaledVector(to.along, -length * q * r);
            z.copy(to.at).sub(from.at).multiplyScalar(6 * s * r / length);
            z.addScaledVector(from.along, r * (1 - 3 * s)).addScaledVector(to.along, s * (3 * s - 2)).normalize();
            // the section: as the bodies turn about the bar
            const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            const other = chain[Math.min(chain.length - 1, Math.max(0, s < 0.5 ? bay - 1 : bay + 1))].body;
            const share = Math.abs(s - 0.5);
            next.set(poses[other][4], poses[other][5], poses[other][6], poses[other][3]);
            turn.set(poses[body][4], poses[body][5], poses[body][6], poses[body][3]).slerp(next, share);
            x.set(0, 0, 0).setComponent(u, 1).applyQuaternion(turn);
            y.crossVectors(z, x).normalize();
            x.crossVectors(y, z);
            const sides = [x, y, left.copy(x).negate(), below.copy(y).negate()];
            for (let k = 0; k < 4; ++k) {
                for (let end = 0; end < 2; ++end) {
                    const [a, b] = outline[k + end];
                    const index = 8 * i + 2 * k + end;
                    write(position, index, point.copy(at).addScaledVector(x, a * half[u]).addScaledVector(y, b * half[v]));
                    write(normal, index, sides[k]);
                    color.array.set(colours[body], 3 * index);
                }
            }
            const cap = i === 0 ? 0 : i === this.count - 1 ? 4 : -1;
            for (let k = 0; cap >= 0 && k < 4; ++k) {
                const [a, b] = outline[k];
                const index = 8 * this.count + cap + k;
                write(position, index, point.copy(at).addScaledVector(x, a * half[u]).addScaledVector(y, b * half[v]));
                write(normal, index, z);
                color.array.set(colours[body], 3 * index);
            }
        }
        for (const attribute of [position, normal, color]) attribute.needsUpdate = true;
    }
}

export class Scene {
    /** @param {HTMLElement} view */
    constructor(view, recording) {
        this.view = view;
        this.sharpness = 1;
        // opaque, which three does not ask for: else the browser blends it with what is below
        const canvas = document.createElement("canvas");
        const context = canvas.getContext("webgl2", { alpha: false, antialias: false });
        this.renderer = new three.WebGLRenderer({ canvas, context });
        view.prepend(this.renderer.domElement);
        this.scene = new three.Scene();
        this.camera = new three.PerspectiveCamera(45, 1, 0.01, 1e4);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, this.renderer.domElement);
        this.controls.addEventListener("change", () => (this.stale = true));
        this.dark = matchMedia("(prefers-color-scheme: dark)");
        this.dark.addEventListener("change", () => this.paint());
        this.paint();
        this.show(recording);
        this.resize();
        this.reset();
        new ResizeObserver(() => this.resize()).observe(view);
    }

    /** Another recording; the view stays where it has the same bodies and joints, as one that has grown. */
    show(recording) {
        const parts = ({ bodies, joints }) => JSON.stringify([bodies.map(({ name, shapes }) => [name, shapes]), joints.map(({ name }) => name)]);
        const same = this.recording && parts(recording) === parts(this.recording);
        this.recording = recording;
        this.largest = { rad: 0, m: 0 }; // plastic travel, of joints that turn and that slide
        for (const { helper, rotates, plastic } of recording.joints) {
            const unit = rotates ? "rad" : "m";
            if (!helper) this.largest[unit] = plastic.reduce((a, b) => (b > a ? b : a), this.largest[unit]);
        }
        if (same) return;
        for (const { geometry } of this.scene.children) geometry.dispose();
        this.scene.clear();
        this.texture?.dispose();
        this.bars = [];
        this.holding = undefined;
        this.followed = -1;
        this.poses = recording.bodies.map(() => new Float64Array(7));
        this.colours = recording.bodies.map(() => stillColour);
        this.shares = new Float64Array(recording.bodies.length);
        this.addShapes();
        this.addMarkers();
        this.update(recording.times[0], "utilisation");
        if (this.renderer.domElement.clientWidth > 0) this.reset();
    }

    paint() {
        this.scene.background = new three.Color(getComputedStyle(document.body).backgroundColor);
        this.stale = true;
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.view;
        if (!(width > 0 && height > 0)) return;
        this.renderer.setPixelRatio(this.sharpness * Math.min(2, this.sharpness < 1 ? 1 : 2 * devicePixelRatio));
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.stale = true;
    }

    /** Pixels to a pixel of the page, each way; 1: twice as many as there are, which smooths edges. */
    setSharpness(share) {
        if (share === this.sharpness) return;
        this.sharpness = share;
        this.resize();
    }

    /** Bars of what holds together in a sample: made anew where a joint breaks. */
    setBars(index) {
        const { joints } = this.recording;
        const holds = (joint) => !(joints[joint].state[index] & broken);
        const key = joints.map((_, i) => (holds(i) ? "" : i)).join();
        if (key === this.holding) return;
        this.holding = key;
        for (const { mesh, geometry } of this.bars) {
            this.scene.remove(mesh);
            geometry.dispose();
        }
        this.barred ??= new three.ShaderMaterial({ vertexShader: ofBars, fragmentShader: filled, vertexColors: true, side: three.DoubleSide });
        const held = clamps(this.recording, holds);
        const rows = chains(this.recording, holds);
        this.bars = [...rows, ...members(this.recording, held, rows)].map((chain) => new Bar(chain, held, this.barred));
        for (const bar of this.bars) this.scene.add(bar.mesh);
    }

    addShapes() {
        const { bodies } = this.recording;
        this.places = new Float32Array(4 * 3 * perRow * Math.max(1, Math.ceil(bodies.length / perRow)));
        this.texture = new three.DataTexture(this.places, 3 * perRow, this.places.length / 12 / perRow, three.RGBAFormat, three.FloatType);
        this.shapes = [];
        const drawn = [];
        const reach = reaches(this.recording);
        const middle = new three.Matrix4();
        bodies.forEach((body, index) => {
            for (const shape of body.shapes) {
                const { pose } = shape;
                const size = scaleOf(shape);
                const { low, high } = reach[index] ?? { low: size.map((v) => -v), high: size };
                const local = new three.Matrix4().compose(point.fromArray(pose), turn.set(pose[4], pose[5], pose[6], pose[3]), at.set(1, 1, 1));
                at.fromArray(high).sub(point.fromArray(low)).divideScalar(2); // half lengths
                local.multiply(middle.compose(point.add(at), turn.identity(), at));
                const geometry = geometries[shape.kind]().applyMatrix4(local);
                geometry.deleteAttribute("uv");
                const count = geometry.attributes.position.count;
                geometry.setAttribute("body", new three.BufferAttribute(new Float32Array(count).fill(index), 1));
                drawn.push(geometry);
                this.shapes.push({ body: index, local });
            }
        });
        if (drawn.length === 0) return;
        const material = new three.ShaderMaterial({ vertexShader: ofBodies, fragmentShader: filled, uniforms: { bodies: { value: this.texture } } });
        const mesh = new three.Mesh(mergeGeometries(drawn), material);
        mesh.frustumCulled = false;
        this.scene.add(mesh);
    }

    addMarkers() {
        const count = this.recording.joints.length;
        const geometry = new three.BufferGeometry();
        geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(3 * count).fill(NaN), 3));
        geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(3 * count), 3));
        const material = new three.ShaderMaterial({ vertexShader: ofPoints, fragmentShader: round, uniforms: { size: { value: 1 } }, vertexColors: true, depthTest: false, transparent: true });
        this.markers = new three.Points(geometry, material);
        this.markers.renderOrder = 1;
        this.markers.frustumCulled = false;
        this.scene.add(this.markers);
    }

    /** What a joint is coloured by, at a sample. */
    shareOf(joint, index, by) {
        if (joint.helper) return 0;
        return by === "plastic" ? joint.plastic[index] / (this.largest[joint.rotates ? "rad" : "m"] || 1) : joint.utilisation[index];
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
        const { shares } = this;
        shares.fill(0);
        for (const joint of recording.joints) {
            if (joint.state[place.index] & broken) continue;
            const share = this.shareOf(joint, place.index, by);
            for (const body of [joint.a, joint.b]) {
                if (body >= 0) shares[body] = Math.max(shares[body], share);
            }
        }
        recording.bodies.forEach(({ moves }, i) => (this.colours[i] = moves ? colourOf(shares[i]) : stillColour));
        const { places, colours } = this;
        for (let i = 0; i < poses.length; ++i) {
            const [pose, colour, at] = [poses[i], colours[i], 12 * i];
            for (let k = 0; k < 3; ++k) {
                places[at + k] = pose[k];
                places[at + 4 + k] = pose[4 + k];
                places[at + 8 + k] = colour[k];
            }
            places[at + 3] = 1;
            places[at + 7] = pose[3];
        }
        this.setBars(place.index);
        for (const bar of this.bars) {
            bar.update(poses, colours);
            for (const { body } of bar.chain) places[12 * body + 3] = bar.bent ? 0 : 1;
        }
        this.texture.needsUpdate = true;
        const { position, color } = this.markers.geometry.attributes;
        recording.joints.forEach((joint, i) => {
            const anchor = joint.a >= 0 ? joint.a : joint.b;
            if (anchor < 0) return;
            const pose = poses[anchor];
            point.set(...joint.in_a).applyQuaternion(turn.set(pose[4], pose[5], pose[6], pose[3]));
            position.setXYZ(i, point.x + pose[0], point.y + pose[1], point.z + pose[2]);
            color.array.set(this.colourOfJoint(joint, place.index, by), 3 * i);
        });
        position.needsUpdate = true;
        color.needsUpdate = true;
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
        const matrix = new three.Matrix4();
        for (const { body, local } of this.shapes) {
            if (moving && !bodies[body].moves) continue;
            const pose = this.poses[body];
            matrix.compose(point.fromArray(pose), turn.set(pose[4], pose[5], pose[6], pose[3]), size.set(1, 1, 1)).multiply(local);
            for (let k = 0; k < 8; ++k) {
                corner.set(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
                bounds.expandByPoint(corner.applyMatrix4(matrix));
            }
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
        for (let i = 0; i < this.recording.joints.length; ++i) {
            place.fromBufferAttribute(this.markers.geometry.attributes.position, i).project(this.camera);
            const distance = Math.hypot((place.x - at.x) * this.camera.aspect, place.y - at.y);
            if (distance < nearest) [nearest, best] = [distance, i];
        }
        return best;
    }

    render() {
        if (!this.stale) return false;
        this.stale = false;
        const height = this.renderer.domElement.height;
        this.markers.material.uniforms.size.value = 0.008 * (this.size ?? 1) * height;
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
