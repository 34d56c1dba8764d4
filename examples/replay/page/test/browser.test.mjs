// SPDX-License-Identifier: MIT
//
// The page in a real browser (browser.mjs), from disk. REPLAY_DIR: where replay_test wrote.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { resolve } from "node:path";
import test, { after, before } from "node:test";
import { gunzipSync } from "node:zlib";

import { launch, pixelAt, pixels } from "./browser.mjs";
import { pack, pageOf } from "./made.mjs";
import { brokenColour, colourOf } from "../src/colours.js";

const folder = resolve(process.env.REPLAY_DIR ?? ".");
const file = resolve(folder, "replay_rotor.html");
const expected = JSON.parse(await readFile(resolve(folder, "replay_rotor.json"), "utf8"));
let browser;

before(async () => {
    browser = await launch();
});
after(() => browser?.close());

async function open(path = file, options = {}) {
    const page = await browser.newPage({ viewport: { width: 1000, height: 700 }, ...options });
    page.faults = [];
    page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
    page.on("pageerror", (error) => page.faults.push(error.message));
    page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || page.faults.push(`asked for ${request.url()}`));
    await page.goto(`file://${path}`);
    await page.waitForFunction(() => window.replay || !document.getElementById("message").hidden);
    return page;
}

/** A recording made up, in the page as it was built. */
async function openMade(made, options) {
    const path = resolve(folder, `replay_${made.name}.html`);
    await writeFile(path, pageOf(await readFile(process.env.REPLAY_PAGE, "utf8"), made));
    return open(path, options);
}

const events = (...each) => each.map(([time, kind, joint, name]) => ({ time, kind, joint, name, energy: 0 }));
/** Joints of all kinds, each at a box of its own: two that only guide, and three of which the hinge takes most. */
const kinds = {
    name: "kinds", times: Array.from({ length: 11 }, (_, i) => i / 10),
    bodies: Array.from({ length: 5 }, (_, i) => ({ name: `box ${i}`, half: [0.4, 0.4, 0.4], pose: (t) => [2 * i, 3 * t, 0, 1, 0, 0, 0] })),
    joints: [
        { name: "road", turns: false, facts: [["section", "none: it guides the car"]], sample: (t) => ({ utilisation: 1, plastic: t, absorbed: 5e4 * t, state: 1 }) },
        { name: "guide", turns: false, sample: (t) => ({ utilisation: 1, plastic: t, absorbed: t, state: 1 }) },
        { name: "slider", turns: false, sample: (t) => ({ utilisation: 0.5, plastic: 0.02 * t, absorbed: 40 * t, state: 1, force: -2000, position: 0.02 * t }) },
        {
            name: "hinge", facts: [["section", "box 100 x 100 x 4 mm"], ["material", "S355"], ["capacity", "51.5 kN m"]],
            sample: (t) => ({ utilisation: 0.75, plastic: 0.3 * t, absorbed: 15450 * t, state: 1, force: -51.5e3, position: 0.3 * t, life: t / 2 }),
        },
        { name: "foot", axes: [{ axis: "axial", turns: false, sample: (t) => ({ force: 1e3 * t, position: 1e-3 * t }) }], sample: (t) => ({ utilisation: 1, plastic: 0.01 * t, absorbed: 300 * t, state: t > 0.45 ? 3 : 1 }) },
    ].map((joint, a) => ({ ...joint, a, b: -1, in_a: [0, 0, 0] })),
    events: events([-0.01, "yielded", 4, "foot"], [0.1, "yielded", 0, "road"], [0.2, "yielded", 1, "guide"], [0.3, "yielded", 3, "hinge"], [0.5, "broke", 4, "foot"], [0.7, "unreliable", 2, "slider"]),
    energies: {
        kinetic: (t) => 100 - 40 * t, potential: () => -20, plastic: (t) => 30 * t, friction: (t) => -10 * t, members: (t) => 5 * t,
        vibration: (t) => 4 * t, sleep: (t) => 3 * t, damping: () => 0, integration: (t) => 2 * t, supplied: (t) => 80 - 6 * t, unexplained: () => 0,
    },
};

/** Where a joint is on the page. */
const placeOn = (page, joint) =>
    page.evaluate((joint) => {
        const { markers, camera, renderer } = replay.scene;
        const place = camera.position.clone().fromBufferAttribute(markers.geometry.attributes.position, joint).project(camera);
        const box = renderer.domElement.getBoundingClientRect();
        return { x: box.left + (box.width * (place.x + 1)) / 2, y: box.top + (box.height * (1 - place.y)) / 2 };
    }, joint);
const factsOn = async (page) => {
    const items = await page.$$eval("#facts > *", (items) => items.map((item) => item.textContent));
    return Object.fromEntries(items.flatMap((item, i) => (i % 2 ? [] : [[item, items[i + 1]]])));
};

test("something is drawn, it changes with time, without errors or a network", async () => {
    const page = await open();
    const start = await pixels(page);
    assert.ok(start.colours > 4, `${start.colours} colours`); // background, floor, sides, joint
    await page.evaluate(() => replay.setTime(0.4));
    const later = await pixels(page);
    assert.notEqual(later.sum, start.sum);
    assert.deepEqual(page.faults, []);
    await page.close();
});

test("scrubbing moves both plots' cursors and the numbers are the recording's", async () => {
    const page = await open();
    const line = () => page.$eval("#energy .now", (mark) => new DOMMatrix(mark.style.transform).m41);
    const dot = () => page.$eval("#curve .dot", (mark) => new DOMMatrix(mark.style.transform).m41);
    await page.evaluate(() => replay.setTime(replay.recording.times[0]));
    const before = [await line(), await dot()];
    await page.locator("#scrub").evaluate((scrub) => {
        scrub.value = scrub.max;
        scrub.dispatchEvent(new Event("input"));
    });
    const after = [await line(), await dot()];
    assert.ok(after[0] > before[0] + 100, `${before[0]} to ${after[0]}`);
    assert.ok(Math.abs(after[1] - before[1]) > 50);
    const facts = await page.$$eval("#facts > *", (items) => items.map((item) => item.textContent));
    const fact = (name) => facts[facts.indexOf(name) + 1];
    assert.equal(fact("absorbed"), "96 J");
    assert.equal(fact("plastic travel"), "1.5 rad");
    assert.equal(fact("state"), "broken");
    assert.equal(fact("strength"), "64 N m");
    assert.equal(fact("breaks at"), "1.5 rad");
    assert.equal(fact("life left"), "0.0 % of plastic travel");
    assert.equal(fact("strength left"), "none");
    assert.ok(Math.abs(parseFloat(await page.textContent("#time")) - expected.times.at(-1)) < 1e-4);
    await page.close();
});

test("a click on the energies sets the time", async () => {
    const page = await open();
    const box = await page.locator("#energy .u-over").boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    const { time, end, start } = await page.evaluate(() => ({ time: replay.time, end: replay.end, start: replay.recording.times[0] }));
    assert.ok(time > start + 0.2 * (end - start) && time < end, `${time}`);
    await page.close();
});

test("a broken joint has its colour, and an event leads to its time", async () => {
    const page = await open();
    const colour = async () => pixelAt(page, await placeOn(page, 0));
    await page.evaluate(() => replay.setTime(replay.recording.times[1]));
    const [red, green] = await colour();
    assert.ok(red > 0.7 && green < 0.35, `it flows: red, not ${red} ${green}`);
    await page.click("#events li:last-child button");
    assert.ok(Math.abs((await page.evaluate(() => replay.time)) - expected.broke) < 1e-9);
    await page.evaluate(() => replay.setTime(replay.end));
    const black = await colour(); // a point lets a little of what is below through
    black.forEach((value, k) => assert.ok(value < brokenColour[k] + 0.15, `broken: black, not ${black}`));
    await page.close();
});

test("keys play, step and go to events; the address keeps the state", async () => {
    const page = await open();
    await page.keyboard.press("Home");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => replay.time), expected.times[1]);
    await page.keyboard.press("n");
    await page.evaluate(() => replay.setSpeed(1 / 30)); // so that it does not end meanwhile
    await page.keyboard.press(" ");
    await page.waitForFunction(() => replay.drawn > 5 && replay.time > replay.recording.times[4]);
    await page.keyboard.press(" ");
    await page.evaluate(() => replay.setTime(0.25));
    const url = page.url();
    await page.close();
    const again = await browser.newPage();
    await again.goto(url);
    await again.waitForFunction(() => window.replay);
    assert.ok(Math.abs((await again.evaluate(() => replay.time)) - 0.25) < 1e-4);
    await again.close();
});

test("it is readable on a phone and in the dark", async () => {
    const page = await open(file, { viewport: { width: 390, height: 800 }, colorScheme: "dark" });
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} px wide`);
    assert.match(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), /rgb\(18, 22, 28\)/);
    assert.deepEqual(page.faults, []);
    await page.close();
});

/** The middle of each section of the first bar, at a time, and whether body 0 is drawn as a box. */
const lineAt = (page, time) => page.evaluate((time) => {
    replay.setTime(time);
    const [bar] = replay.scene.bars;
    const line = [];
    for (let i = 0; i < bar.count; ++i) {
        const sum = [0, 0, 0];
        for (let k = 0; k < 8; ++k) for (let c = 0; c < 3; ++c) sum[c] += bar.geometry.attributes.position.array[3 * (8 * i + k) + c] / 8;
        line.push(sum);
    }
    return { line, drawn: [replay.scene.places[3], replay.scene.places[15]] };
}, time);
const nearPoint = (a, b) => assert.ok(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 1e-3, `${a} for ${b}`);

test("two boxes that a joint bends are drawn as one bar, and as boxes once it broke", async () => {
    const template = await readFile(process.env.REPLAY_PAGE, "utf8");
    const bent = (t) => [0.5 + 0.5 * Math.cos(t), 0, -0.5 * Math.sin(t), Math.cos(t / 2), 0, Math.sin(t / 2), 0];
    const made = {
        name: "bent", times: [0, 0.5, 1, 1.01],
        bodies: [{ name: "left", half: [0.49, 0.02, 0.02], pose: () => [0, 0, 0, 1, 0, 0, 0] }, { name: "right", half: [0.49, 0.02, 0.02], pose: bent }],
        joints: [{ name: "joint", a: 1, b: 0, in_a: [-0.5, 0, 0], sample: (t) => ({ state: t > 1 ? 2 : 0 }) }],
    };
    const bentPage = resolve(folder, "replay_bent.html");
    await writeFile(bentPage, pageOf(template, made));
    const page = await open(bentPage);
    const middle = await lineAt(page, 1);
    nearPoint(middle.line[0], [-0.49, 0, 0]);
    nearPoint(middle.line[6], [0.5, 0, 0]);
    nearPoint(middle.line[12], [0.5 + 0.99 * Math.cos(1), 0, -0.99 * Math.sin(1)]);
    assert.deepEqual(middle.drawn, [0, 0]);
    const after = await page.evaluate(() => {
        replay.setTime(1.01);
        return [replay.scene.bars.length, replay.scene.places[3], replay.scene.places[15]];
    });
    assert.deepEqual(after, [0, 1, 1]);
    assert.deepEqual(page.faults, []);
    await page.close();
});

test("a post of one body is drawn bent from its foot on, and straight where that has not turned", async () => {
    const template = await readFile(process.env.REPLAY_PAGE, "utf8");
    const made = {
        name: "post", times: [0, 1],
        bodies: [{ name: "post", half: [0.02, 0.02, 0.5], pose: (t) => [0.5 * Math.sin(t), 0, 0.5 * Math.cos(t), Math.cos(t / 2), 0, Math.sin(t / 2), 0] }],
        joints: [{ name: "foot", a: 0, b: -1, in_a: [0, 0, -0.5], sample: () => ({}) }],
    };
    const postPage = resolve(folder, "replay_post.html");
    await writeFile(postPage, pageOf(template, made));
    const page = await open(postPage);
    const { line, drawn } = await lineAt(page, 1);
    const [x, z] = [Math.sin(1), Math.cos(1)];
    nearPoint(line[0], [0, 0, 0]);
    nearPoint(line[3], [(x - x / 4) / 2, 0, (z + (1 - z) / 4) / 2]); // the chord, and L/8 of what the ends differ by
    nearPoint(line[6], [x, 0, z]);
    assert.equal(drawn[0], 0);
    assert.deepEqual(await page.evaluate(() => (replay.setTime(0), [replay.scene.bars[0].mesh.visible, replay.scene.places[3]])), [false, 1]);
    assert.deepEqual(page.faults, []);
    await page.close();
});

test("boxes that a joint holds at a corner are drawn without a gap", async () => {
    const page = await openMade({
        name: "corner", times: [0, 1],
        bodies: [
            { name: "lying", half: [0.9, 0.1, 0.1], pose: () => [0, 0, 0, 1, 0, 0, 0] },
            { name: "standing", half: [0.1, 0.1, 0.9], pose: () => [1, 0, -1, 1, 0, 0, 0] },
        ],
        joints: [{ name: "joint", a: 0, b: 1, in_a: [1, 0, 0], sample: () => ({}) }],
    });
    const drawn = await page.evaluate(() => replay.scene.shapes.map(({ local }) => [local.elements[12], local.elements[14], local.elements[0], local.elements[10]]));
    const near = (values, wanted) => values.forEach((value, k) => assert.ok(Math.abs(value - wanted[k]) < 1e-6, `${values} for ${wanted}`));
    near(drawn[0], [0.1, 0, 1, 0.1]); // middle along x and z, half lengths along x and z
    near(drawn[1], [0, 0.1, 0.1, 1]);
    assert.deepEqual(page.faults, []);
    await page.close();
});

test("it opens on the joint that took most; what only guides makes no tick and no colour, and can be chosen", async () => {
    const page = await openMade(kinds);
    const shown = await page.evaluate(() => ({
        joint: replay.recording.joints[replay.joint].name,
        ticks: Array.from(document.querySelectorAll("#ticks i"), ({ title, style }) => [title.split(" ")[0], style.left].join(" at ")),
        choice: Array.from(document.querySelectorAll("#joint option"), ({ textContent }) => textContent),
        colours: replay.scene.colours,
    }));
    assert.equal(shown.joint, "hinge");
    assert.deepEqual(shown.ticks, ["foot at 0%", "hinge at 30%", "foot at 50%", "slider at 70%"]);
    assert.deepEqual(shown.choice, ["slider", "hinge", "foot", "road", "guide"]);
    assert.deepEqual(shown.colours.slice(0, 4), [0, 0, 0.5, 0.75].map(colourOf));
    await page.evaluate(() => replay.setTime(0));
    await page.keyboard.press("n");
    assert.equal(await page.evaluate(() => replay.time), 0.3);
    await page.selectOption("#joint", { label: "road" });
    assert.equal((await factsOn(page)).section, "none: it guides the car");
    assert.deepEqual(page.faults, []);
    await page.close();
});

test("plots have the ink of the paper they are on, when that changes too", async () => {
    const page = await openMade(kinds, { colorScheme: "light" });
    await page.emulateMedia({ colorScheme: "dark" });
    const ink = await page.evaluate(() => getComputedStyle(document.body).color);
    assert.equal(ink, "rgb(230, 234, 240)");
    for (const plot of ["energy", "curve"]) {
        await page.waitForFunction((plot) => {
            const canvas = document.querySelector(`#${plot} canvas`);
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            let count = 0;
            for (let i = 0; i < data.length; i += 4) if (data[i] === 230 && data[i + 1] === 234 && data[i + 2] === 240 && data[i + 3] === 255) ++count;
            return count > 20;
        }, plot, { timeout: 5000 });
    }
    await page.close();
});

test("space presses the button that has the focus", async () => {
    const page = await openMade(kinds);
    const state = () => page.evaluate(() => [replay.time, replay.playing]);
    await page.evaluate(() => replay.setTime(0));
    await page.focus("#forth");
    await page.keyboard.press(" ");
    assert.deepEqual(await state(), [0.1, false]);
    await page.focus("#events li:nth-child(5) button");
    await page.keyboard.press(" ");
    assert.deepEqual(await state(), [0.5, false]);
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press(" ");
    assert.equal((await state())[1], true);
    await page.close();
});

test("the address keeps what is followed, and is obeyed when it is changed", async () => {
    const page = await openMade(kinds);
    await page.evaluate(() => replay.setTime(0.2));
    await page.selectOption("#follow", { label: "box 3" });
    await page.evaluate(() => replay.setTime(0.4));
    const url = page.url();
    const seen = () => page.evaluate(() => [replay.scene.followed, replay.time, replay.joint, replay.speed, $("follow"), $("speed"), ...replay.scene.pose()].map((v) => v.value ?? Number(v.toFixed(3))));
    await page.evaluate(() => (window.$ = (id) => document.getElementById(id)));
    const before = await seen();
    assert.deepEqual(before.slice(0, 2), [3, 0.4]);
    await page.evaluate(() => (location.hash = "t=0.9&joint=2&speed=0.1&follow=1"));
    await page.waitForFunction(() => replay.time === 0.9);
    assert.deepEqual((await seen()).slice(0, 6), [1, 0.9, 2, 0.1, "1", "0.1"]);
    await page.evaluate((hash) => (location.hash = hash), new URL(url).hash);
    await page.waitForFunction(() => replay.time === 0.4);
    assert.deepEqual(await seen(), before);
    await page.goto("about:blank");
    await page.goto(url);
    await page.waitForFunction(() => window.replay);
    await page.evaluate(() => (window.$ = (id) => document.getElementById(id)));
    assert.deepEqual(await seen(), before);
    await page.close();
});

test("a click on a joint shows what it is made of, what it bears and what is left", async () => {
    const page = await openMade(kinds);
    await page.evaluate(() => (replay.setJoint(2), replay.setTime(0.6)));
    const { x, y } = await placeOn(page, 3);
    await page.mouse.click(x, y);
    assert.deepEqual(await factsOn(page), {
        state: "has flowed", utilisation: "0.750", moment: "-51.5 kN m", "strength left": "25.0 %", "plastic travel": "0.18 rad",
        "life left": "70.0 % of plastic travel", absorbed: "9.27 kJ", certificate: "0", section: "box 100 x 100 x 4 mm", material: "S355", capacity: "51.5 kN m",
    });
    const slider = await placeOn(page, 2);
    await page.mouse.click(slider.x, slider.y);
    assert.equal((await factsOn(page)).force, "-2 kN");
    assert.equal((await factsOn(page))["plastic travel"], "0.012 m");
    await page.close();
});

test("of a joint with several axes each can be shown", async () => {
    const page = await openMade(kinds);
    assert.equal(await page.isVisible("#axis"), false);
    await page.selectOption("#joint", { label: "foot" });
    await page.evaluate(() => replay.setTime(0.4));
    assert.equal((await factsOn(page)).moment, "0 N m");
    const dot = () => page.$eval("#curve .dot", (mark) => new DOMMatrix(mark.style.transform).m41);
    const before = await dot();
    await page.selectOption("#axis", { label: "axial" });
    assert.equal((await factsOn(page)).force, "400 N");
    assert.notEqual(await dot(), before);
    const again = await browser.newPage();
    await again.goto(page.url());
    await again.waitForFunction(() => window.replay);
    assert.equal((await factsOn(again)).force, "400 N");
    await again.close();
    await page.close();
});

test("while a recording grows it shows the joint that took most, or the one that was chosen", async () => {
    const took = [(t) => 10 * t, (t) => (t < 0.5 ? 0 : 100 * t), () => 0];
    const upTo = (end) => ({
        name: "grows", times: [0, 0.2, 0.4, 0.6, 0.8].filter((t) => t <= end), bodies: kinds.bodies,
        joints: took.map((absorbed, a) => ({ name: `${a}`, a, b: -1, in_a: [0, 0, 0], sample: (t) => ({ absorbed: absorbed(t), plastic: absorbed(t) / 100 }) })),
    });
    const page = await openMade(upTo(0.4));
    const joint = async (end) => {
        await page.evaluate((bytes) => showRecording(Uint8Array.from(bytes), true), [...gunzipSync(pack(upTo(end)))]);
        return page.evaluate(() => replay.joint);
    };
    assert.equal(await joint(0.4), 0);
    assert.equal(await joint(0.6), 1);
    await page.selectOption("#joint", { label: "2" });
    assert.equal(await joint(0.8), 2);
    await page.close();
});

test("a click on the curve sets the time", async () => {
    const page = await openMade(kinds);
    const box = await page.locator("#curve .u-over").boundingBox();
    await page.mouse.click(box.x + box.width * (0.5 + 0.2 / 1.1), box.y + box.height / 2); // at 0.21 rad
    assert.equal(await page.evaluate(() => replay.time), 0.7);
    await page.close();
});

test("the legend tells colours and ticks, each with its unit", async () => {
    const page = await openMade(kinds);
    assert.match(await page.textContent("#legend"), /utilisation.*0.*1 \(flows\).*broken.*unreliable.*yielded.*broke.*unreliable/s);
    const colourAt = (selector) => page.$$eval(selector, (found) => found.map((each) => getComputedStyle(each).backgroundColor));
    assert.deepEqual(await colourAt("#legend i"), (await colourAt("#ticks i")).slice(1));
    assert.equal(new Set(await colourAt("#legend i")).size, 3);
    await page.selectOption("#colour", "plastic");
    assert.match(await page.textContent("#legend"), /0\s*0.3 rad\s*0\s*0.02 m/);
    await page.evaluate(() => replay.setTime(0.5));
    const colours = await page.evaluate(() => replay.scene.colours.slice(2, 4));
    colours.forEach((colour) => colour.forEach((value, k) => assert.ok(Math.abs(value - colourOf(0.5)[k]) < 1e-3, `half of its kind: ${colour}`)));
    await page.close();
});

test("energies are stacked, each in a colour of its own: what is negative below zero, what was put in as a line", async () => {
    const page = await openMade(kinds);
    const { lines, last } = await page.evaluate(() => {
        const { plot } = replay.energy;
        const lines = plot.series.slice(1).filter(({ fill }) => !fill?.()).map(({ label }) => label);
        return { lines, last: Object.fromEntries(plot.series.map(({ label }, i) => [label, Math.round(10 * plot.data[i].at(-1)) / 10])) };
    });
    assert.deepEqual(last, { time: 1, kinetic: 60, potential: 60, plastic: 90, friction: -10, members: 95, vibration: 99, sleep: 102, integration: 104, supplied: 94, unexplained: 0 });
    const marks = await page.$$eval("#energy .u-marker", (marks) => marks.map(({ style }) => style.borderColor));
    assert.equal(new Set(marks).size, marks.length);
    assert.deepEqual(lines, ["supplied", "unexplained"]);
    await page.close();
});

test("what follows, turns, resets, steps and changes the speed does so", async () => {
    const page = await openMade(kinds);
    const camera = () => page.evaluate(() => replay.scene.pose());
    const moved = (from, to) => from.map((v, k) => Number((to[k] - v).toFixed(3)) + 0);
    await page.evaluate(() => replay.setTime(0));
    const start = await camera();
    await page.selectOption("#follow", { label: "box 1" });
    await page.evaluate(() => replay.setTime(0.5));
    assert.deepEqual(moved(start, await camera()), [0, 1.5, 0, 0, 1.5, 0]);
    await page.selectOption("#follow", { label: "nothing" });
    await page.evaluate(() => replay.setTime(0));
    const box = await page.locator("#view canvas").boundingBox();
    await page.mouse.move(box.x + 100, box.y + 100);
    await page.mouse.down();
    await page.mouse.move(box.x + 180, box.y + 130, { steps: 4 });
    await page.mouse.up();
    const turned = moved(start, await camera());
    assert.ok(Math.hypot(...turned.slice(0, 3)) > 1, `${turned}`);
    assert.deepEqual(turned.slice(3), [0, 1.5, 0], "about what was followed");
    await page.click("#reset");
    assert.deepEqual(moved(start, await camera()), [0, 0, 0, 0, 0, 0]);
    await page.click("#forth");
    await page.click("#forth");
    assert.equal(await page.evaluate(() => replay.time), 0.2);
    await page.click("#back");
    assert.equal(await page.evaluate(() => replay.time), 0.1);
    await page.selectOption("#speed", "0.01");
    const began = Date.now();
    await page.click("#play");
    await page.waitForFunction(() => replay.time > 0.105);
    await page.click("#play");
    const passed = await page.evaluate(() => replay.time) - 0.1;
    assert.ok(passed < (0.01 * (Date.now() - began)) / 1000, `${passed} s`);
    await page.close();
});

test("a mark shows where two recordings first differ", async () => {
    const page = await openMade(kinds);
    const compared = async (file, made) => {
        const other = resolve(folder, file);
        await writeFile(other, pageOf("<!--recording-->", made));
        const before = await page.textContent("#message");
        await page.setInputFiles("#compare", other);
        await page.waitForFunction((before) => document.getElementById("message").textContent !== before, before);
        return page.textContent("#message");
    };
    assert.match(await compared("replay_later.html", { ...kinds, hash: (_, i) => (i < 4 ? i : i + 1) }), /differ from 0.4000 s on/);
    assert.equal(await page.$eval("#ticks .differs", (mark) => mark.style.left), "40%");
    assert.equal(await page.evaluate(() => replay.time), 0.4);
    assert.match(await compared("replay_again.html", kinds), /the same, bit for bit/);
    assert.equal(await page.$("#ticks .differs"), null);
    assert.match(await compared("replay_others.html", { ...kinds, name: "others" }), /of another scene/);
    await page.close();
});

test("a file that is cut short says so, a whole one does not", async () => {
    const whole = await readFile(file);
    const cut = resolve(folder, "replay_short.html");
    for (const share of [0.01, 0.1, 0.5, 0.9, 0.999]) {
        await writeFile(cut, whole.subarray(0, share * whole.length));
        const page = await browser.newPage();
        await page.goto(`file://${cut}`);
        await page.waitForSelector("#message", { state: "visible", timeout: 5000 });
        assert.match(await page.textContent("#message"), /^This file is cut short/, `${share}`);
        await page.close();
    }
    const page = await open();
    assert.equal(await page.isVisible("#message"), false);
    await page.close();
});

test("a page whose recording is damaged says so", async () => {
    const text = await readFile(file, "utf8");
    const cut = resolve(folder, "replay_cut.html");
    await writeFile(cut, text.replace(/(<script id="recording"[^>]*>.{400})[^<]*/, "$1"));
    const page = await open(cut);
    assert.match(await page.textContent("#message"), /damaged or cut short/);
    await page.close();
});
