// SPDX-License-Identifier: MIT
//
// Frames a second of the page, drawn by software in headless Chromium: 500 boxes that move, 400
// joints, 10 s of 30 samples. Prints the median of three runs of 4 s of each PAGE, in turn.
//
//   node test/speed.mjs PAGE...       replay.html as it was built; beside each other: compared
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { chromium } from "playwright-core";

import { pageOf } from "./made.mjs";

const times = Array.from({ length: 300 }, (_, i) => i / 30);
const bodies = Array.from({ length: 500 }, (_, b) => {
    const [x, y] = [b % 25, Math.floor(b / 25)];
    const turn = (t) => 0.5 * Math.sin(t + y);
    return {
        name: `box ${b}`, half: [0.4, 0.2, 0.1],
        pose: (t) => [x + 0.3 * Math.sin(t + b), y + 0.3 * Math.cos(t + b), 1 + 0.5 * Math.sin(2 * t + x), Math.cos(turn(t) / 2), 0, 0, Math.sin(turn(t) / 2)],
    };
});
const joints = Array.from({ length: 400 }, (_, j) => ({
    name: `joint ${j}`, a: j, b: j + 1, in_a: [0.4, 0, 0],
    sample: (t) => ({ utilisation: Math.abs(Math.sin(t + j)), plastic: 0.01 * t, absorbed: 10 * t, state: t > 5 ? 1 : 0, force: Math.sin(t + j), position: Math.cos(t) }),
}));

const folder = await mkdtemp(join(tmpdir(), "replay-"));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
try {
    const pages = [];
    for (const [i, path] of process.argv.slice(2).entries()) {
        const file = join(folder, `${i}.html`);
        await writeFile(file, pageOf(await readFile(path, "utf8"), { name: "500 boxes", times, bodies, joints }));
        pages.push({ path, file, rates: [], ready: [] });
    }
    for (let run = 0; run < 3; ++run) {
        for (const each of pages) {
            const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
            page.on("pageerror", (error) => console.error(error.message));
            const start = performance.now();
            await page.goto(`file://${each.file}`);
            await page.waitForFunction(() => window.replay?.drawn > 0);
            each.ready.push((performance.now() - start) / 1000);
            const rate = await page.evaluate(async () => {
                replay.setTime(0);
                replay.play(true);
                await new Promise((done) => setTimeout(done, 500));
                const [drawn, now] = [replay.drawn, performance.now()];
                await new Promise((done) => setTimeout(done, 4000));
                return (1000 * (replay.drawn - drawn)) / (performance.now() - now);
            });
            each.rates.push(rate);
            await page.close();
        }
    }
    const median = (values) => values.toSorted((a, b) => a - b)[1];
    for (const { path, rates, ready } of pages) console.log(`${path}: ${median(rates).toFixed(1)} frames a second, ready after ${median(ready).toFixed(2)} s`);
} finally {
    await browser.close();
    await rm(folder, { recursive: true });
}
