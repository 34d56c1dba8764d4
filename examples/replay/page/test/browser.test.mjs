// SPDX-License-Identifier: MIT
//
// The page in a real browser (browser.mjs), from disk. REPLAY_DIR: where replay_test wrote.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { resolve } from "node:path";
import test, { after, before } from "node:test";

import { launch, pixels } from "./browser.mjs";
import { pageOf } from "./made.mjs";

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
    const colour = () => page.evaluate(() => Array.from(replay.scene.markers.geometry.attributes.color.array.slice(0, 3)));
    await page.evaluate(() => replay.setTime(replay.recording.times[1]));
    const [red, green] = await colour();
    assert.ok(red > 0.8 && green < 0.3, "it flows: red");
    await page.click("#events li:last-child button");
    assert.ok(Math.abs((await page.evaluate(() => replay.time)) - expected.broke) < 1e-9);
    await page.evaluate(() => replay.setTime(replay.end));
    assert.ok((await colour()).every((value) => value < 0.2), "broken: black");
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
    const middle = await page.evaluate(() => {
        replay.setTime(1);
        const [bar] = replay.scene.bars;
        const line = []; // of the middle of each section
        for (let i = 0; i < bar.count; ++i) {
            const sum = [0, 0, 0];
            for (let k = 0; k < 8; ++k) for (let c = 0; c < 3; ++c) sum[c] += bar.geometry.attributes.position.array[3 * (8 * i + k) + c] / 8;
            line.push(sum);
        }
        return { line, drawn: [replay.scene.places[3], replay.scene.places[15]] };
    });
    const near = (a, b) => assert.ok(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 1e-3, `${a} for ${b}`);
    near(middle.line[0], [-0.49, 0, 0]);
    near(middle.line[6], [0.5, 0, 0]);
    near(middle.line[12], [0.5 + 0.99 * Math.cos(1), 0, -0.99 * Math.sin(1)]);
    assert.deepEqual(middle.drawn, [0, 0]);
    const after = await page.evaluate(() => {
        replay.setTime(1.01);
        return [replay.scene.bars.length, replay.scene.places[3], replay.scene.places[15]];
    });
    assert.deepEqual(after, [0, 1, 1]);
    assert.deepEqual(page.faults, []);
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
