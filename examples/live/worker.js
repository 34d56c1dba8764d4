// SPDX-License-Identifier: MIT
//
// Behind what emscripten made, in a worker: gets the compiled module, then wishes; posts recordings as
// they grow, and the answer.
let live;

onmessage = async ({ data: { module, wish } }) => {
    try {
        live ??= makeLive({
            instantiateWasm: (imports, done) => {
                WebAssembly.instantiate(module, imports).then(done, (error) => postMessage({ fault: `WebAssembly: ${error.message}` }));
                return {};
            },
            show: (bytes, kept) => postMessage({ bytes, kept }, [bytes.buffer]),
        });
        const made = await live;
        const text = wish ? made.ccall("live_play", "string", ["string"], [JSON.stringify(wish)]) : made.ccall("live_scenes", "string", [], []);
        postMessage({ answer: JSON.parse(text) });
    } catch (error) {
        postMessage({ fault: `WebAssembly: ${error.message ?? error}` });
    }
};
