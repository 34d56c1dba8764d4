// SPDX-License-Identifier: MIT
//
// Bundles the page into one file: node build.mjs [FILE]. Prints its size.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname } from "node:path";

const file = process.argv[2] ?? "dist/replay.html";
const here = new URL(".", import.meta.url);
const bundled = await build({
    entryPoints: [new URL("src/main.js", here).pathname],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    legalComments: "inline",
    loader: { ".css": "text" },
    write: false,
});
const script = bundled.outputFiles[0].text.replaceAll("</script", "<\\/script");
const style =
    (await readFile(new URL("node_modules/uplot/dist/uPlot.min.css", here), "utf8")) +
    (await readFile(new URL("src/style.css", here), "utf8"));
const page = await readFile(new URL("src/page.html", here), "utf8");
const put = (text, place, what) => {
    if (!text.includes(place)) throw new Error(`page.html has no ${place}`);
    return text.replace(place, () => what);
};
let html = put(page, "/*style*/", style);
html = put(html, "/*script*/", script);
await mkdir(dirname(file), { recursive: true });
await writeFile(file, html);
console.log(`${file}: ${(html.length / 1e6).toFixed(2)} MB`);
