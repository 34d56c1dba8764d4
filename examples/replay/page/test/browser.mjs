// SPDX-License-Identifier: MIT
//
// A real browser and what it draws. To be run where playwright-core is installed. CHROMIUM: its program.
// Drawn by software, which has to be asked for: else nothing is drawn, and tests pass on nothing.
import { createRequire } from "node:module";
import { join } from "node:path";

const { chromium } = createRequire(join(process.cwd(), "package.json"))("playwright-core");

export const launch = () =>
    chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
    });

/** What the browser drew of the scene: canvas, and its pixels as bytes. */
const drawn = () => {
    replay.scene.stale = true;
    replay.scene.render();
    const canvas = replay.scene.renderer.domElement;
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    return { canvas, data: context.getImageData(0, 0, copy.width, copy.height).data };
};

/** Colour of the scene at a place of the page, 0 to 1. */
export const pixelAt = (page, place) =>
    page.evaluate(`(({ x, y }) => {
        const { canvas, data } = (${drawn})();
        const box = canvas.getBoundingClientRect();
        const at = (of, from, size, count) => Math.floor(((of - from) / size) * count);
        const i = 4 * (at(y, box.top, box.height, canvas.height) * canvas.width + at(x, box.left, box.width, canvas.width));
        return Array.from(data.slice(i, i + 3), (value) => value / 255);
    })(${JSON.stringify(place)})`);

/** How many colours the scene has, and a sum of all its pixels. */
export const pixels = (page) =>
    page.evaluate(`(() => {
        const { data } = (${drawn})();
        const colours = new Set();
        let sum = 0;
        for (let i = 0; i < data.length; i += 4) {
            colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
            sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) % 2147483647;
        }
        return { colours: colours.size, sum };
    })()`);
