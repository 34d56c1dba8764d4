// SPDX-License-Identifier: MIT
//
// The files of every scene: none is too large, and each glb is valid glTF. SCENES_DIR: a folder of each scene.
import assert from "node:assert/strict";
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import test from "node:test";

import validator from "gltf-validator";

const folder = process.env.SCENES_DIR;
const files = (await readdir(folder, { recursive: true })).filter((file) => /-(bullet|ode)\.(html|glb)$/.test(file));

test("a replay takes at most 2 MB, its glb 25 MB and nothing that is not glTF", async () => {
    assert.ok(files.length > 0 && files.length % 2 === 0, `${files.length} files`);
    for (const file of files) {
        const bytes = await readFile(join(folder, file));
        const most = file.endsWith("glb") ? 25e6 : 2e6;
        assert.ok(bytes.length <= most, `${file}: ${bytes.length} bytes, at most ${most}`);
        if (!file.endsWith("glb")) continue;
        const { issues } = await validator.validateBytes(new Uint8Array(bytes));
        assert.equal(issues.numErrors + issues.numWarnings, 0, `${file}: ${JSON.stringify(issues.messages)}`);
    }
});
