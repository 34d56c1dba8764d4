// SPDX-License-Identifier: MIT
//
// Members that are several bodies: boxes of one section that joints hold together end to end, in one
// line at the start. They are drawn as one bent bar, not as boxes with gaps. And slender members of
// one body that joints hold at their ends: what those turned is drawn as a bend along the chord.
import { poseAt } from "./recording.js";

const start = { index: 0, share: 0 };

/** v turned by the pose's quaternion, or back. */
function turned(pose, v, back = 1) {
    const [w, x, y, z] = [pose[3], back * pose[4], back * pose[5], back * pose[6]];
    const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
}

/** Half lengths of a body that is one box about its centre; undefined of another. */
function boxOf({ shapes }) {
    if (shapes.length !== 1 || shapes[0].kind !== "box") return undefined;
    const { pose, size } = shapes[0];
    const off = Math.hypot(...pose.slice(0, 3)) + Math.hypot(...pose.slice(4));
    return off < 1e-9 ? size : undefined;
}

const othersOf = (k) => [0, 1, 2].filter((each) => each !== k);
const unit = (k) => [0, 1, 2].map((each) => (each === k ? 1 : 0));

/**
 * The end at which a point lies: the axis of the body and its sign; the longest of several.
 * @param within  so far from it, by the axis
 */
function endAt(half, point, within = (k) => Math.max(0.1 * half[k], ...othersOf(k).map((each) => 0.5 * half[each]))) {
    let found;
    for (let k = 0; k < 3; ++k) {
        const others = othersOf(k);
        if (Math.abs(Math.abs(point[k]) - half[k]) > within(k)) continue;
        if (others.some((each) => Math.abs(point[each]) > 1.01 * half[each] + 1e-9)) continue;
        if (!found || half[k] > half[found.axis]) found = { axis: k, sign: Math.sign(point[k]) };
    }
    return found;
}

/**
 * Of each body that is one box: `low` and `high` along its axes, drawn up to where joints hold it and, where it meets
 * another at a corner, as far as the half of that one; else as it is. Undefined of another body.
 */
export function reaches({ bodies, joints }) {
    const poses = bodies.map((body) => poseAt(body, start, new Float64Array(7)));
    const boxes = bodies.map(({ shapes }) => (shapes.length === 1 && shapes[0].kind === "box" ? shapes[0] : undefined));
    const found = boxes.map((box) => box && { low: box.size.map((v) => -v), high: [...box.size] });
    const into = (pose, point) => turned(pose, point.map((v, k) => v - pose[k]), -1);
    for (const { a, b, in_a, helper } of joints) {
        if (a < 0 || helper) continue;
        const place = turned(poses[a], in_a).map((v, k) => v + poses[a][k]);
        const ends = [a, b].map((body) => {
            if (!boxes[body]) return undefined;
            const { pose, size } = boxes[body];
            const thin = Math.min(...size);
            const point = into(pose, into(poses[body], place));
            const end = endAt(size, point, (k) => (size[k] > 1.01 * thin ? Math.max(0.1 * size[k], 1.5 * thin) : -1));
            return end && { ...end, body, thin, at: Math.abs(point[end.axis]), along: turned(poses[body], turned(pose, unit(end.axis))) };
        });
        ends.forEach((end, i) => {
            if (!end) return;
            const other = ends[1 - i];
            const corner = other && Math.abs(end.along.reduce((sum, v, k) => sum + v * other.along[k], 0)) < 0.99;
            const { low, high } = found[end.body];
            const { axis, sign } = end;
            const to = end.at + (corner ? other.thin : 0);
            if (sign > 0) high[axis] = Math.max(high[axis], to);
            else low[axis] = Math.min(low[axis], -to);
        });
    }
    return found;
}

/**
 * @param holds  whether a joint, by its number, holds
 * @returns chains of [{ body, axis, sign, half, entry, exit }]: bodies from end to end, `sign` that of
 * the axis along the chain, `entry` and `exit` on the body's axis
 */
export function chains({ bodies, joints }, holds = () => true) {
    const halves = bodies.map(boxOf);
    const drawn = reaches({ bodies, joints });
    const poses = bodies.map((body) => poseAt(body, start, new Float64Array(7)));
    const links = bodies.map(() => []); // of each body: { axis, sign, to, joint, at }
    joints.forEach((joint, number) => {
        const { a, b } = joint;
        if (!holds(number) || a < 0 || b < 0 || !halves[a] || !halves[b]) return;
        const at = turned(poses[a], joint.in_a).map((v, k) => v + poses[a][k]);
        const inB = turned(poses[b], at.map((v, k) => v - poses[b][k]), -1);
        const [endA, endB] = [endAt(halves[a], joint.in_a), endAt(halves[b], inB)];
        if (!endA || !endB || endA.axis !== endB.axis || endA.sign === endB.sign) return;
        // one section, and axes that agree
        for (let k = 0; k < 3; ++k) {
            const [u, v] = [turned(poses[a], unit(k)), turned(poses[b], unit(k))];
            if (u[0] * v[0] + u[1] * v[1] + u[2] * v[2] < 0.999) return;
            if (k !== endA.axis && Math.abs(halves[a][k] - halves[b][k]) > 1e-6 * halves[a][k]) return;
        }
        links[a].push({ ...endA, to: b, joint: number, at: joint.in_a });
        links[b].push({ ...endB, to: a, joint: number, at: inB });
    });
    // a body that is joined along two axes is part of a plate; of two at one end none is the next
    const usable = links.map((each) => {
        const axes = new Set(each.map(({ axis }) => axis));
        const ends = new Set(each.map(({ sign }) => sign));
        return axes.size === 1 && ends.size === each.length ? each : [];
    });
    const seen = new Set();
    const found = [];
    const walk = (first) => {
        const chain = [];
        let from = -1;
        for (let body = first; body >= 0 && !seen.has(body); ) {
            seen.add(body);
            const entry = usable[body].find(({ to }) => to === from);
            const next = usable[body].find((link) => link !== entry && usable[link.to].some(({ joint }) => joint === link.joint));
            const { axis } = entry ?? next;
            const sign = next ? next.sign : -entry.sign;
            const end = (link, side) => [0, 1, 2].map((k) => (k === axis ? link?.at[k] ?? drawn[body][side > 0 ? "high" : "low"][k] : 0));
            chain.push({ body, axis, sign, half: halves[body], entry: end(entry, -sign), exit: end(next, sign) });
            from = body;
            body = next ? next.to : -1;
        }
        if (chain.length > 1) found.push(chain);
    };
    const partners = (body) => usable[body].filter(({ to, joint }) => usable[to].some((link) => link.joint === joint)).length;
    bodies.forEach((_, body) => partners(body) === 1 && !seen.has(body) && walk(body));
    return found;
}

/**
 * What holds the ends of slender boxes on their axis: of each body [{ axis, sign, other, along }], `along` the axis towards
 * that end at the start, as the other body (-1: the ground) has it. Of two slender ends each takes half of what their joint
 * turned (`share`), else the one takes it all.
 */
export function clamps({ bodies, joints }, holds = () => true) {
    const slender = (half, axis) => othersOf(axis).every((each) => half[axis] > 4 * half[each]);
    const halves = bodies.map(boxOf);
    const poses = bodies.map((body) => poseAt(body, start, new Float64Array(7)));
    const found = bodies.map(() => []);
    joints.forEach(({ a, b, in_a, helper }, number) => {
        if (a < 0 || helper || !holds(number)) return;
        const at = turned(poses[a], in_a).map((v, k) => v + poses[a][k]);
        const inB = b >= 0 && turned(poses[b], at.map((v, k) => v - poses[b][k]), -1);
        const ends = [[a, in_a, b], [b, inB, a]].map(([body, point, other]) => {
            const half = body >= 0 && bodies[body].moves && halves[body];
            const end = half && endAt(half, point);
            if (!end || !slender(half, end.axis) || othersOf(end.axis).some((each) => Math.abs(point[each]) > 0.5 * half[each])) return undefined;
            const world = turned(poses[body], unit(end.axis)).map((v) => end.sign * v);
            return { body, ...end, other, along: other >= 0 ? turned(poses[other], world, -1) : world };
        });
        const share = ends[0] && ends[1] ? 0.5 : 1;
        for (const end of ends) if (end) found[end.body].push({ ...end, share });
    });
    return found;
}

/** Chains of one body each: what is held at an end and in none of `others`. */
export function members(recording, held, others) {
    const drawn = reaches(recording);
    const chained = new Set(others.flatMap((chain) => chain.map(({ body }) => body)));
    const found = [];
    held.forEach((ends, body) => {
        if (ends.length === 0 || chained.has(body) || ends.some(({ axis }) => axis !== ends[0].axis)) return;
        const { axis } = ends[0];
        const end = (side) => [0, 1, 2].map((k) => (k === axis ? drawn[body][side][k] : 0));
        found.push([{ body, axis, sign: 1, half: boxOf(recording.bodies[body]), entry: end("low"), exit: end("high") }]);
    });
    return found;
}
