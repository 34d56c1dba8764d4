// SPDX-License-Identifier: MIT
//
// Recordings for tests, of functions of the time, laid down as packed.hpp does.
import { gzipSync } from "node:zlib";

const waves = Object.fromEntries(["kinetic", "plastic", "unexplained"].map((name, i) => [name, (t) => 50 + 40 * Math.sin(t + i)]));

/**
 * @param bodies    [{ name, half, offset, pose(t) }]: boxes, x y z and the turn w x y z
 * @param joints    [{ name, a, b, in_a, turns, facts, sample(t), axes: [{ axis, turns, sample(t) }] }], `axes`: those beside the first
 * @param energies  { name: of a time }
 * @param hash      (time, number) of each sample's poses
 * @returns gzipped bytes
 */
export function pack({ name, times, bodies, joints, energies = waves, events = [], hash = (_, i) => i }) {
    const columns = [];
    const add = (of, fixed) => {
        const values = times.map(of);
        const [low, high] = fixed ?? [Math.min(...values), Math.max(...values)];
        columns.push({ low, step: (high - low) / 65534 || 0, values });
    };
    const whole = (of) => columns.push({ low: 0, step: 1, values: times.map(of) });
    for (const { pose } of bodies) {
        for (let k = 0; k < 7; ++k) add((t) => pose(t)[k], k > 2 ? [-1, 1] : undefined);
    }
    for (const { sample, axes = [] } of joints) {
        for (const each of ["utilisation", "plastic", "absorbed", "residual"]) add((t) => sample(t)[each] ?? 0);
        whole((t) => sample(t).state ?? 0);
        add((t) => sample(t).life ?? 0, [0, 1]);
        for (const of of [sample, ...axes.map((axis) => axis.sample)]) for (const each of ["force", "position"]) add((t) => of(t)[each] ?? 0);
    }
    for (const energy of Object.values(energies)) add(energy);
    whole(() => 1);
    whole(hash);
    const low = Buffer.alloc(columns.length * times.length);
    const high = Buffer.alloc(columns.length * times.length);
    columns.forEach((column, c) => {
        let last = 0;
        column.values.forEach((value, i) => {
            const q = column.step === 0 ? 0 : Math.round((value - column.low) / column.step);
            let difference = (q - last) & 0xffff;
            if (difference > 0x7fff) difference -= 0x10000;
            const zigzag = ((difference << 1) ^ (difference >> 31)) & 0xffff;
            low[c * times.length + i] = zigzag & 0xff;
            high[c * times.length + i] = zigzag >> 8;
            last = q;
        });
    });
    const text = JSON.stringify({
        name, about: "", engine: "none", times, energies: Object.keys(energies), events,
        bodies: bodies.map((body) => ({ name: body.name, moves: true, shapes: [{ kind: "box", size: body.half, pose: body.offset ?? [0, 0, 0, 1, 0, 0, 0] }] })),
        joints: joints.map(({ name, a, b, in_a, turns = true, facts = [], axes = [] }) => ({ name, a, b, in_a, facts, axes: [{ axis: "axis", turns }, ...axes.map(({ axis, turns }) => ({ axis, turns }))] })),
        columns: { low: columns.map((c) => c.low), step: columns.map((c) => c.step), order: columns.map(() => 1) },
    });
    const head = Buffer.alloc(12);
    head.write("ductrec4");
    head.writeUInt32LE(Buffer.byteLength(text), 8);
    return gzipSync(Buffer.concat([head, Buffer.from(text), low, high]));
}

/** A page with such a recording inside. */
export function pageOf(page, made) {
    const recording = `<script id="recording" type="text/plain">${pack(made).toString("base64")}</script>`;
    return page.replace("<!--recording-->", () => recording);
}
