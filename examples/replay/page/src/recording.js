// SPDX-License-Identifier: MIT
//
// Reads what packed.hpp writes, and tells where everything is at a time.

export class RecordingError extends Error {}

const magic = "ductrec4";
const noNumber = 65535;

/** Bytes of base64 text. */
export function fromBase64(text) {
    let binary;
    try {
        binary = atob(text.trim());
    } catch {
        throw new RecordingError("this is not a recording: its text is not base64");
    }
    return Uint8Array.from(binary, (c) => c.charCodeAt(0));
}

/** The recording inside the text of a replay page. */
export function ofPage(text) {
    const found = /<script id="recording" type="text\/plain">([^<]*)<\/script>/.exec(text);
    if (!found) {
        const begun = /<script id="recording" type="text\/plain">/.test(text);
        throw new RecordingError(begun ? "the recording is cut short" : "this file holds no recording");
    }
    return fromBase64(found[1]);
}

async function unzipped(bytes) {
    try {
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
        return new Uint8Array(await new Response(stream).arrayBuffer());
    } catch {
        throw new RecordingError("the recording is damaged or cut short");
    }
}

/** Decodes columns one after the other; those of order 0 are constant and have no samples. */
class Columns {
    constructor(text, low, high, frames) {
        Object.assign(this, { text, low, high, frames, next: 0, at: 0 });
    }
    take() {
        const column = this.next++;
        const { low, step, order } = this.text;
        const values = new Float64Array(this.frames);
        if (order[column] === 0) return values.fill(low[column] ?? NaN);
        let last = 0;
        let slope = 0;
        for (let i = 0, at = this.at; i < this.frames; ++i, ++at) {
            const zigzag = this.low[at] | (this.high[at] << 8);
            const difference = (zigzag >> 1) ^ -(zigzag & 1);
            if (order[column] === 2) {
                slope = (slope + difference) & 0xffff;
                last = (last + slope) & 0xffff;
            } else {
                last = (last + difference) & 0xffff;
            }
            values[i] = last === noNumber && step[column] !== 1 ? NaN : low[column] + step[column] * last;
        }
        this.at += this.frames;
        return values;
    }
}

/**
 * @param {Uint8Array} bytes as packed.hpp writes them
 * @throws {RecordingError} where they are anything else
 */
export async function decode(bytes) {
    return decodeLaidDown(await unzipped(bytes));
}

/** Likewise, of bytes that are not zipped. */
export function decodeLaidDown(all) {
    const letters = new TextDecoder();
    if (letters.decode(all.subarray(0, 8)) !== magic) {
        throw new RecordingError("this is not a recording, or one of another version");
    }
    try {
        return read(all, letters);
    } catch (error) {
        if (error instanceof RecordingError) throw error;
        throw new RecordingError("the recording is damaged or cut short");
    }
}

function read(all, letters) {
    const length = new DataView(all.buffer, all.byteOffset).getUint32(8, true);
    const text = JSON.parse(letters.decode(all.subarray(12, 12 + length)));
    const frames = text.times.length;
    const samples = text.columns.order.filter((order) => order > 0).length * frames;
    const rest = all.subarray(12 + length);
    if (rest.length !== 2 * samples) throw new RecordingError("the recording is cut short");
    const columns = new Columns(text.columns, rest.subarray(0, samples), rest.subarray(samples), frames);
    const take = (names, into) => names.forEach((name) => (into[name] = columns.take()));
    for (const body of text.bodies) {
        if (body.moves) body.columns = Array.from({ length: 7 }, () => columns.take());
    }
    for (const joint of text.joints) {
        take(["utilisation", "plastic", "absorbed", "residual", "state", "life"], joint);
        for (const axis of joint.axes) take(["force", "position"], axis);
    }
    judge(text.joints);
    text.energies = text.energies.map((name) => ({ name, values: columns.take() }));
    const low = columns.take();
    const high = columns.take();
    text.hashes = Array.from(low, (value, i) => value + 65536 * high[i]);
    text.times = Float64Array.from(text.times);
    delete text.columns;
    return text;
}

/**
 * Tells of each joint whether it only guides or drives what is shown (`helper`): it says that its section is none, or
 * what it flows at and what it took are nothing beside the others'. And whether its plastic travel is an angle
 * (`rotates`): of one with several axes it is an equivalent one, of its law, which is told in bending.
 */
function judge(joints) {
    const fact = (joint, name) => joint.facts.find(([word]) => word.startsWith(name))?.[1] ?? "";
    for (const joint of joints) {
        joint.helper = fact(joint, "section").startsWith("none");
        joint.rotates = joint.axes[0].turns || fact(joint, "capacity, ") !== "";
    }
    const took = (joint) => joint.absorbed.at(-1) || 0;
    const bears = (joint) => (joint.plastic.at(-1) > 0 ? took(joint) / joint.plastic.at(-1) : Infinity);
    const shown = joints.filter((joint) => !joint.helper && bears(joint) < Infinity);
    const nothing = (of) => 1e-3 * Math.max(0, ...shown.map(of));
    const [weak, little] = [nothing(bears), nothing(took)];
    for (const joint of shown) joint.helper = bears(joint) < weak && took(joint) < little;
}

/** The joint that took most or, where none took any, was loaded most; none of the helpers where there are others. -1: there is none. */
export function foremost(joints) {
    const largest = (values) => values.reduce((a, b) => (b > a ? b : a), 0);
    const rank = (joint) => [joint.helper ? 0 : 1, joint.absorbed.at(-1) || 0, largest(joint.utilisation)];
    const ranks = joints.map(rank);
    const over = (a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2];
    return ranks.reduce((best, each, i) => (best < 0 || over(each, ranks[best]) > 0 ? i : best), -1);
}

/** Sample before `time` and the share of the way to the next one. */
export function placeOf(times, time) {
    let low = 0;
    let high = times.length - 1;
    if (!(time > times[0])) return { index: 0, share: 0 };
    if (time >= times[high]) return { index: high, share: 0 };
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (times[middle] <= time) low = middle;
        else high = middle;
    }
    return { index: low, share: (time - times[low]) / (times[low + 1] - times[low]) };
}

/** Pose x, y, z, qw, qx, qy, qz of a body, into `out`; not a number where the run had none. */
export function poseAt(body, { index, share }, out) {
    if (!body.moves) {
        for (let k = 0; k < 7; ++k) out[k] = body.pose[k];
        return out;
    }
    const next = share > 0 ? index + 1 : index;
    let length = 0;
    for (let k = 0; k < 7; ++k) {
        const column = body.columns[k];
        out[k] = column[index] + share * (column[next] - column[index]);
        if (k > 2) length += out[k] * out[k];
    }
    length = Math.sqrt(length);
    for (let k = 3; k < 7; ++k) out[k] /= length;
    return out;
}

/** First sample in which two recordings of one scene differ; -1: none does. */
export function firstDifference(a, b) {
    const count = Math.min(a.hashes.length, b.hashes.length);
    for (let i = 0; i < count; ++i) {
        if (a.hashes[i] !== b.hashes[i] || a.times[i] !== b.times[i]) return i;
    }
    return a.hashes.length === b.hashes.length ? -1 : count;
}

export const broken = 2;
export const flowed = 1;
export const unreliable = 4;
