// SPDX-License-Identifier: MIT
//
// Puts what was compiled into the replay page: node page.mjs WORK FILE. Prints its size.
import { readFile, rename, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";

const [work, file] = process.argv.slice(2);
const here = new URL(".", import.meta.url);
const inert = (id, text) => `<script id="${id}" type="text/plain">${text}</script>`;
const zipped = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");
const glue = await readFile(`${work}/live.js`, "utf8");
const worker = await readFile(new URL("worker.js", here), "utf8");
const script = await readFile(new URL("live.js", here), "utf8");
const panel = await readFile(new URL("panel.html", here), "utf8");
const parts = [
    ["<!--recording-->", inert("wasm", zipped(await readFile(`${work}/live.wasm`))) + inert("worker", zipped(`${glue}\n${worker}`))],
    ["<aside>", `<aside>${panel}`],
    ["</body>", `<script>${script}</script></body>`],
    ["<title>replay</title>", "<title>ductile: scenes, live</title>"],
];
let page = await readFile(`${work}/replay.html`, "utf8");
for (const [place, text] of parts) {
    const at = page.lastIndexOf(place);
    if (at < 0) throw new Error(`the replay page has no ${place}`);
    page = page.slice(0, at) + text + page.slice(at + place.length);
}
await writeFile(`${file}.part`, page);
await rename(`${file}.part`, file);
console.log(`open examples/live/${file} (${(page.length / 1e6).toFixed(2)} MB)`);
