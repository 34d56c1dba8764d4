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

/** Colours of the scene's middle, as the browser drew them. */
export const pixels = (page) =>
    page.evaluate(() => {
        replay.scene.stale = true;
        replay.scene.render();
        const canvas = replay.scene.renderer.domElement;
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const context = copy.getContext("2d", { willReadFrequently: true });
        context.drawImage(canvas, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        const colours = new Set();
        let sum = 0;
        for (let i = 0; i < data.length; i += 4) {
            colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
            sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) % 2147483647;
        }
        return { colours: colours.size, sum };
    });
