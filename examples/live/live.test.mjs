// SPDX-License-Identifier: MIT
//
// The live page in a real browser, from disk. To be run where playwright-core is installed, as in
// build/release/examples/replay/page. CHROMIUM: its program; LIVE_PAGE: what build.sh made.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";
import test, { after, before } from "node:test";

const { chromium } = createRequire(join(process.cwd(), "package.json"))("playwright-core");
let browser;
let page;
const faults = [];

before(async () => {
    browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
    });
    page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
    page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
    page.on("pageerror", (error) => faults.push(error.message));
    page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || faults.push(`asked for ${request.url()}`));
    await page.goto(`file://${process.env.LIVE_PAGE}`);
    await page.waitForFunction(() => window.live);
});
after(() => browser?.close());

const plain = { loaded: 0, rods: 4, length: 4, side: 100, wall: 4, yield: 355e6, mass: 100, speed: 10, largest: 1, rate: 60, iterations: 10, direct: 0 };
/** The three bars so many seconds on. */
const bars = (values, seconds) =>
    page.evaluate(([values, seconds]) => {
        live.held = true;
        live.set(values);
        live.run(seconds);
        return live.state.bars.map((bar) => ({ ...bar, measured: live.measure(bar) }));
    }, [{ ...plain, ...values }, seconds]);
/** M_p and the mass of a metre, by hand. */
const moment = ({ side, wall, yield: strength }) => (strength * ((side / 1e3) ** 3 - ((side - 2 * wall) / 1e3) ** 3)) / 4;
const perLength = ({ side, wall }) => 7850 * ((side / 1e3) ** 2 - ((side - 2 * wall) / 1e3) ** 2);
const near = (value, wanted, within) => assert.ok(Math.abs(value - wanted) <= within * Math.abs(wanted), `${value} for ${wanted}`);

test("a thrown post stops after E/M_p, whatever its rods, frames and section", async () => {
    for (const other of [{ rods: 1 }, { rods: 4 }, { rods: 16 }, { rate: 15 }, { rate: 1000 }, { side: 150, wall: 6, yield: 235e6, length: 6 }]) {
        const values = { ...plain, ...other };
        const { length, mass, speed } = values;
        const energy = 0.5 * (perLength(values) / 3 * length ** 3 + mass * length ** 2) * (speed / length) ** 2;
        const [ours] = await bars(other, 0.5);
        near(ours.turn, energy / moment(values), 0.01);
        near(ours.taken, energy, 0.01);
        assert.ok(ours.kinetic < 1e-3 * energy, `${ours.kinetic} J`);
    }
});

test("with one rod the motor takes the right energy, with four it does not in ten iterations", async () => {
    const [, one] = await bars({ rods: 1 }, 0.5);
    assert.ok(one.kinetic < 1);
    const [, four] = await bars({ rods: 4 }, 0.5);
    assert.ok(four.kinetic > 1000);
});

test("a foot that breaks has taken M_p times its rotation", async () => {
    const [ours] = await bars({ largest: 0.1 }, 0.3);
    assert.equal(ours.broken, 1);
    near(ours.taken, 0.1 * moment(plain), 0.01);
});

test("a cantilever stands level below its plastic moment, and falls above", async () => {
    const share = (mass) => (9.81 * (8 * perLength(plain) + 4 * mass)) / moment(plain);
    assert.ok(share(440) < 0.95 && share(520) > 1.05);
    const [stands] = await bars({ loaded: 1, rods: 8, mass: 440 }, 2.9);
    assert.ok(Math.abs(stands.measured) < 1e-6 && stands.taken < 1e-6, `${stands.measured} m, ${stands.taken} J`);
    const [falls] = await bars({ loaded: 1, rods: 8, mass: 520 }, 2.9);
    assert.ok(falls.measured > 0.2, `${falls.measured} m`);
});

test("it is drawn, it moves, the table says who is right", async () => {
    const drawn = () =>
        page.evaluate(() => {
            live.draw();
            const canvas = document.getElementById("view");
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return data.reduce((sum, value, i) => (sum * 31 + value * (i % 97)) % 2147483647, 7);
        });
    await bars({}, 0);
    const start = await drawn();
    await bars({}, 0.05);
    assert.notEqual(await drawn(), start);
    await bars({}, 2);
    await drawn();
    const cells = await page.$$eval("#rows tr:last-child td", (row) => row.map((cell) => cell.textContent));
    assert.deepEqual(cells.slice(2), ["yes", "no", "no"]);
});

test("a slider starts anew; a wall thicker than the section is refused in words", async () => {
    await bars({}, 0.2);
    await page.locator("#rods").evaluate((input) => {
        input.value = 6;
        input.dispatchEvent(new Event("input"));
    });
    assert.deepEqual(await page.evaluate(() => [live.state.rods, live.state.time]), [6, 0]);
    await bars({ wall: 60 }, 0);
    assert.match(await page.textContent("#message"), /thickness/);
    await bars({}, 0);
    assert.equal(await page.textContent("#message"), "");
    assert.deepEqual(faults, []);
});
