// SPDX-License-Identifier: MIT
//
// What the page reads is what was recorded. REPLAY_DIR: where replay_test wrote its files.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import test from "node:test";
import { gunzipSync, gzipSync } from "node:zlib";

import validator from "gltf-validator";

import { pack } from "./made.mjs";
import { chains, clamps, members, reaches } from "../src/chains.js";
import { decode, firstDifference, ofPage, placeOf, poseAt, RecordingError } from "../src/recording.js";

const folder = process.env.REPLAY_DIR ?? ".";
const page = await readFile(join(folder, "replay_rotor.html"), "utf8");
const expected = JSON.parse(await readFile(join(folder, "replay_rotor.json"), "utf8"));
const bytes = ofPage(page);
const recording = await decode(bytes);

/** To a 65535th of the column's range. */
function near(values, wanted) {
    const low = Math.min(...wanted);
    const high = Math.max(...wanted);
    assert.equal(values.length, wanted.length);
    wanted.forEach((value, i) => assert.ok(Math.abs(values[i] - value) <= 0.51 * (high - low) / 65534 + 1e-12, `${values[i]} for ${value}`));
}

test("columns are those of the run", () => {
    near(Array.from(recording.times), expected.times);
    near(recording.joints[0].absorbed, expected.absorbed);
    const [axis] = recording.joints[0].axes;
    near(axis.force, expected.force);
    near(axis.position, expected.position);
    for (const { name, values } of recording.energies) near(values, expected.energies[name]);
    assert.equal(recording.joints[0].state.at(-1), 3);
    assert.equal(recording.bodies[1].shapes[0].kind, "plane");
});

test("poses between samples are between", () => {
    const [a, b] = recording.times;
    const pose = poseAt(recording.bodies[0], placeOf(recording.times, (a + b) / 2), new Float64Array(7));
    const middle = expected.turn[0].map((value, k) => (value + expected.turn[1][k]) / 2);
    const length = Math.hypot(...middle);
    middle.forEach((value, k) => assert.ok(Math.abs(pose[3 + k] - value / length) < 1e-4));
});

test("a recording that is damaged, cut short or none is refused in words", async () => {
    await assert.rejects(decode(bytes.subarray(0, bytes.length / 2)), RecordingError);
    await assert.rejects(decode(new Uint8Array([1, 2, 3])), RecordingError);
    assert.throws(() => ofPage("<html></html>"), RecordingError);
    assert.throws(() => ofPage(page.slice(0, page.indexOf('<script id="recording"') + 1000)), /cut short/);
    const laidDown = gunzipSync(bytes);
    for (const length of [4, 10, 200, laidDown.length - 1]) {
        await assert.rejects(decode(gzipSync(laidDown.subarray(0, length))), RecordingError);
    }
    const foreign = Buffer.concat([Buffer.from("ductrec4"), Buffer.from([7, 0, 0, 0]), Buffer.from('{"a":1}')]);
    await assert.rejects(decode(gzipSync(foreign)), RecordingError);
});

test("recordings are compared by their hashes", async () => {
    const other = await decode(bytes);
    assert.equal(firstDifference(recording, other), -1);
    other.hashes[7] ^= 1;
    assert.equal(firstDifference(recording, other), 7);
});

/** Boxes of 1 m along x, 2 cm apart, with what is named otherwise. */
const row = (count, other = {}) => ({
    name: "row", times: [0, 1],
    bodies: Array.from({ length: count }, (_, i) => ({ name: `${i}`, half: [0.49, 0.05, 0.04], pose: () => [i, 0, 0, 1, 0, 0, 0], ...other.bodies?.[i] })),
    joints: Array.from({ length: count - 1 }, (_, i) => ({ name: `${i}`, a: i + 1, b: i, in_a: [-0.5, 0, 0], sample: () => ({}), ...other.joints?.[i] })),
});
const bodiesOf = (found) => found.map((chain) => chain.map(({ body }) => body));

test("boxes in a row are one bar, from joint to joint, cut where a joint does not hold", async () => {
    const made = await decode(pack(row(4)));
    const [chain] = chains(made);
    assert.deepEqual(bodiesOf([chain]), [[0, 1, 2, 3]]);
    assert.deepEqual(chain[1].entry, [-0.5, 0, 0]);
    assert.deepEqual(chain[1].exit, [0.5, 0, 0]);
    assert.deepEqual(chain[3].exit, [0.49, 0, 0]);
    assert.deepEqual(bodiesOf(chains(made, (joint) => joint !== 1)), [[0, 1], [2, 3]]);
});

test("another section, a bend or a joint aside is no bar", async () => {
    const bodies = { 1: { half: [0.49, 0.05, 0.05] } };
    const turned = { 1: { pose: () => [1, 0, 0, Math.cos(0.1), 0, 0, Math.sin(0.1)] } };
    for (const other of [{ bodies }, { bodies: turned }, { joints: { 0: { in_a: [0, 0.05, 0] } } }]) {
        assert.deepEqual(chains(await decode(pack(row(2, other)))), []);
    }
});

test("a box is drawn up to where joints hold it, at a corner as far as the other's half, and a thin side is no end", async () => {
    const upright = { half: [0.05, 0.06, 0.97], pose: () => [0.5, 0, -1, 1, 0, 0, 0] };
    const [lying, standing] = reaches(await decode(pack(row(2, { bodies: { 1: upright }, joints: { 0: { in_a: [0, 0, 1] } } }))));
    assert.deepEqual(lying, { low: [-0.49, -0.05, -0.04], high: [0.55, 0.05, 0.04] });
    assert.deepEqual(standing, { low: [-0.05, -0.06, -0.97], high: [0.05, 0.06, 1.04] });
    const thicker = { half: [0.48, 0.1, 0.08] };
    const [thin, thick] = reaches(await decode(pack(row(2, { bodies: { 1: thicker } }))));
    assert.deepEqual([thin.high[0], thick.low[0]], [0.5, -0.5]);
    const slab = { half: [0.6, 0.5, 0.1], pose: () => [0, 0, 0.26, 1, 0, 0, 0] };
    const [, below] = reaches(await decode(pack(row(2, { bodies: { 1: slab }, joints: { 0: { in_a: [0, 0, -0.15] } } }))));
    assert.deepEqual(below, { low: [-0.6, -0.5, -0.1], high: [0.6, 0.5, 0.1] });
    const turned = { half: [0.3, 0.04, 0.05], offset: [0.2, 0, 0, 0, 0, 0, 1], pose: () => [1, 0, 0, 1, 0, 0, 0] };
    const [, off] = reaches(await decode(pack(row(2, { bodies: { 1: turned }, joints: { 0: { in_a: [-0.12, 0, 0] } } }))));
    assert.ok(Math.abs(off.high[0] - 0.32) < 1e-3, `${off.high}`);
});

test("slender members are held at their ends on their axis: half of a joint's turn between two of them, all of it else", async () => {
    const shares = async (other) => clamps(await decode(pack(row(2, other)))).map((ends) => ends.map(({ sign, other, share }) => [sign, other, share]));
    assert.deepEqual(await shares({}), [[[1, 1, 0.5]], [[-1, 0, 0.5]]]);
    const node = { half: [0.05, 0.05, 0.05] };
    assert.deepEqual(await shares({ bodies: { 0: { ...node, pose: () => [0.5, 0, 0, 1, 0, 0, 0] } } }), [[], [[-1, 0, 1]]]);
    assert.deepEqual(await shares({ joints: { 0: { in_a: [-0.5, 0.04, 0] } } }), [[], []]);
    const made = await decode(pack(row(2, { bodies: { 0: { ...node, pose: () => [0.5, 0, 0, 1, 0, 0, 0] } } })));
    const held = clamps(made);
    assert.deepEqual(members(made, held, []).map(([{ body, entry, exit }]) => [body, entry, exit]), [[1, [-0.5, 0, 0], [0.49, 0, 0]]]);
    assert.deepEqual(members(made, held, [[{ body: 1 }]]), []);
});

test("the glb is valid glTF, of a body that went to infinity too", async () => {
    for (const name of ["replay_rotor.glb", "replay_lost.glb"]) {
        const report = await validator.validateBytes(new Uint8Array(await readFile(join(folder, name))));
        assert.equal(report.issues.numErrors, 0, JSON.stringify(report.issues.messages));
        assert.equal(report.issues.numWarnings, 0, JSON.stringify(report.issues.messages));
    }
});
