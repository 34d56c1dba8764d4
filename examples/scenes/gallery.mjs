// SPDX-License-Identifier: MIT
//
// Takes the pictures of the gallery, and its one replay, from the replays, in headless Chromium, drawn
// by software:
//
//   build/release/bin/scenes --out examples/scenes/out
//   cd build/release/examples/replay/page        (where playwright-core is installed)
//   node SOURCE/examples/scenes/gallery.mjs SOURCE/examples/scenes/out SOURCE/examples/scenes/gallery
import { copyFile, mkdir, stat } from "node:fs/promises";
import { join, resolve } from "node:path";

import { launch, pixels } from "../replay/page/test/browser.mjs";

const [from, to] = process.argv.slice(2).map((path) => resolve(path));
const largest = 60e3; // bytes
/** Of each scene: the replay, and the share of its time at which it is seen. */
const shots = [
    ["frame", "frame-ball-bullet", 0.25],
    ["tension", "tension-held-bullet", 1],
    ["tipping-car", "tipping-car-foot-breaks-bullet", 0.25],
    ["gate", "gate-hit-bullet", 0.73],
    ["fence", "fence-vehicle-bullet", 0.9],
    ["lamp-post", "lamp-post-4-rods-bullet", 1],
    ["paperclip", "paperclip-wire-1-bullet", 0.97],
    ["bridge", "bridge-10-percent-80-t-bullet", 0.72],
    ["plate", "plate-5-t-dropped-bullet", 1],
    ["hoop", "roll-cage-level-bullet", 0.7],
    ["roll-cage", "roll-cage-roll-over-bullet", 0.5],
    ["ramp", "ramp-cars-bullet", 0.5],
];

await mkdir(to, { recursive: true });
const browser = await launch();
try {
    for (const [scene, replay, share] of shots) {
        const page = await browser.newPage({ viewport: { width: 900, height: 560 } });
        await page.goto(`file://${join(from, replay)}.html`);
        await page.waitForFunction(() => window.replay);
        await page.evaluate((share) => {
            const start = replay.recording.times[0];
            replay.setTime(start + share * (replay.end - start));
        }, share);
        const { colours } = await pixels(page);
        if (colours < 4) throw new Error(`${replay}: nothing is drawn`);
        const picture = join(to, `${scene}.jpg`);
        await page.screenshot({ path: picture, type: "jpeg", quality: 70 });
        const { size } = await stat(picture);
        if (size > largest) throw new Error(`${picture}: ${size} bytes, at most ${largest}`);
        console.log(`${scene}.jpg ${size} bytes`);
        await page.close();
    }
    await copyFile(join(from, "bridge-10-percent-80-t-bullet.html"), join(to, "bridge.html"));
} finally {
    await browser.close();
}
