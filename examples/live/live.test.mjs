// SPDX-License-Identifier: MIT
//
// The live page in a real browser (browser.mjs), from disk, run in build/release/examples/replay/page.
// LIVE_PAGE: what build.sh made.
import assert from "node:assert/strict";
import test, { after, before } from "node:test";

import { launch, pixels } from "../replay/page/test/browser.mjs";

const file = `file://${process.env.LIVE_PAGE}`;
const ready = { timeout: 240000 };
let browser;
let page;
const faults = [];

before(async () => {
    browser = await launch();
    page = await open();
});
after(() => browser?.close());

async function open(hash = "") {
    const made = await browser.newPage({ viewport: { width: 1000, height: 700 } });
    made.on("console", (message) => message.type() === "error" && faults.push(message.text()));
    made.on("pageerror", (error) => faults.push(error.message));
    made.on("request", (request) => /^(file|data|blob):/.test(request.url()) || faults.push(`asked for ${request.url()}`));
    await made.goto(file + hash);
    await made.waitForFunction(() => window.live?.answer, null, ready);
    return made;
}

/** A part of a scene to its end: what came out, by name. */
async function run(scene, part, values = {}) {
    const { answer, bodies, time } = await page.evaluate(async ([scene, part, values]) => {
        await live.choose(scene, part, values);
        return { answer: live.answer, bodies: live.shown > 0 ? replay.recording.bodies.length : 0, time: window.replay?.end };
    }, [scene, part, values]);
    assert.ok(answer && !answer.fault, `${scene}: ${answer?.fault}`);
    const found = Object.fromEntries(answer.findings.map(({ what, ...rest }) => [what, rest]));
    return { found, findings: answer.findings, bodies, time };
}

const plain = { rods: 4, length: 4, side: 100, wall: 4, yield: 355, mass: 100, speed: 10, largest: 1, rate: 60, iterations: 10, direct: 0 };
/** M_p and the mass of a metre, by hand. */
const moment = ({ side, wall, yield: strength }) => (strength * 1e6 * ((side / 1e3) ** 3 - ((side - 2 * wall) / 1e3) ** 3)) / 4;
const perLength = ({ side, wall }) => 7850 * ((side / 1e3) ** 2 - ((side - 2 * wall) / 1e3) ** 2);
const near = (value, wanted, within) => assert.ok(Math.abs(value - wanted) <= within * Math.abs(wanted), `${value} for ${wanted}`);

test("a thrown post stops after E/M_p, whatever its rods, frames and section", async () => {
    for (const other of [{ rods: 1 }, { rods: 16 }, { rate: 15 }, { rate: 1000 }, { side: 150, wall: 6, yield: 235, length: 6 }]) {
        const values = { ...plain, ...other };
        const { length, mass, speed } = values;
        const energy = 0.5 * ((perLength(values) / 3) * length ** 3 + mass * length ** 2) * (speed / length) ** 2;
        const { found } = await run("bar", "thrown", values);
        near(found["this library: turn of the foot"].came_out, energy / moment(values), 0.01);
        near(found["this library: joints took"].came_out, energy, 0.01);
    }
});

test("with one rod the motor takes the right energy, with four it does not in ten iterations", async () => {
    const of = async (rods) => (await run("bar", "thrown", { ...plain, rods })).found["Bullet's motor: joints took"];
    assert.equal((await of(1)).right, true);
    assert.equal((await of(4)).right, false);
    assert.match(await page.textContent("#findings"), /Bullet's motor: joints took[\d. ]+J[\d. ]+WRONG/);
});

test("a foot that breaks has taken M_p times its rotation", async () => {
    const { found } = await run("bar", "thrown", { ...plain, largest: 0.1 });
    assert.equal(found["this library: joints that broke"].came_out, 1);
    near(found["this library: joints took"].came_out, 0.1 * moment(plain), 0.01);
});

test("a cantilever stands level below its plastic moment, and falls above", async () => {
    const share = (mass) => (9.81 * (8 * perLength(plain) + 4 * mass)) / moment(plain);
    assert.ok(share(440) < 0.95 && share(520) > 1.05);
    const sunk = async (mass) => (await run("bar", "loaded by its weight", { ...plain, rods: 8, mass })).found["this library: its tip has sunk"].came_out;
    assert.ok(Math.abs(await sunk(440)) < 1e-6);
    assert.ok((await sunk(520)) > 0.2);
});

test("every scene runs, is drawn, and comes out as it must", async () => {
    const scenes = await page.evaluate(() => live.scenes.map(({ name }) => name));
    assert.deepEqual(scenes, ["frame", "tension", "tipping-car", "gate", "fence", "lamp-post", "paperclip", "bridge", "plate", "roll-cage", "ramp", "bar"]);
    for (const scene of scenes.slice(0, 11)) {
        const { findings, bodies, time } = await run(scene);
        assert.ok(findings.some(({ expected }) => expected !== null), `${scene} says what must come out`);
        for (const { what, came_out, expected, right } of findings) assert.ok(right, `${scene}: ${what}: ${came_out} for ${expected}`);
        assert.ok(bodies > 1 && time > 0.01, `${scene}: ${bodies} bodies, ${time} s`);
    }
});

test("something is drawn, it changes with time, and a joint tells what it is and what is left", async () => {
    await run("tipping-car");
    await page.evaluate(() => replay.setTime(0));
    const start = await pixels(page);
    assert.ok(start.colours > 4, `${start.colours} colours`);
    const fact = async (name) => {
        const facts = await page.$$eval("#facts > *", (items) => items.map((item) => item.textContent));
        return facts[facts.indexOf(name) + 1];
    };
    assert.equal(await fact("life left"), "100.0 % of plastic travel");
    await page.evaluate(() => replay.setTime(replay.end));
    assert.notEqual((await pixels(page)).sum, start.sum);
    assert.equal(await fact("section"), "box 100 x 100 x 4 mm");
    assert.equal(await fact("material"), "steel, 355 MPa");
    assert.equal(await fact("capacity"), "19.64 kN m");
    assert.equal(await fact("life left"), "0.0 % of plastic travel");
    assert.equal(await fact("strength left"), "none");
});

test("a slider moves what comes out, and the address keeps scene and sliders", async () => {
    await run("tension");
    const utilisation = () => page.evaluate(() => live.answer.findings[0].came_out);
    near(await utilisation(), (9.81 * 6000) / 80e3, 1e-3);
    await page.locator("#option-mass").evaluate((input) => {
        input.value = 0.25;
        input.dispatchEvent(new Event("input"));
        input.dispatchEvent(new Event("change"));
    });
    await page.waitForFunction(() => live.answer);
    const mass = await page.evaluate(() => live.values.mass);
    assert.ok(mass > 1000 && mass < 5000, `${mass} kg`);
    near(await utilisation(), (9.81 * mass) / 80e3, 1e-3);
    const again = await open(new URL(page.url()).hash);
    assert.deepEqual(await again.evaluate(() => [live.scene.name, live.values.mass]), ["tension", mass]);
    await again.close();
    const odd = await open("#scene=tension&part=none&with=mass%3D-4%26steel%3Dnan%26other%3D1");
    assert.deepEqual(await odd.evaluate(() => [live.part, live.values.mass, live.values.steel]), ["held", 6000, 4e-4]);
    await odd.close();
});

test("what the sections do not allow is refused in words, a run can be stopped", async () => {
    await page.evaluate(() => live.choose("bar", "thrown", { side: 40, wall: 20 }));
    assert.match(await page.textContent("#running"), /thickness/);
    await page.evaluate(() => void live.choose("ramp", undefined, { rate: 1000 })); // longer than a click may take
    await page.waitForFunction(() => live.shown > 0);
    await page.click("#run");
    assert.equal(await page.textContent("#running"), "stopped");
    const seen = await page.evaluate(() => live.shown);
    await page.waitForTimeout(1000);
    assert.deepEqual(await page.evaluate(() => [live.shown, live.answer]), [seen, undefined]);
    await run("tension");
    assert.deepEqual(faults, []);
});
