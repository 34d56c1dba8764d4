// SPDX-License-Identifier: MIT
//
// Chooses a scene, a part of it and its numbers, has them run in a worker, and shows the recording as
// it grows (showRecording of the replay page) and what must come out. The choice is in the address.
// `window.live` is for tests and the console.
(() => {
    const $ = (id) => document.getElementById(id);
    const common = [
        { name: "rate", about: "frames a second", unit: "1/s", value: 60, low: 15, high: 1000, part: "" },
        { name: "tolerance", about: "of a frame; 0: steps as they are", unit: "%", value: 1, low: 0, high: 10, part: "" },
    ];
    const digits = (value) => `${Number(value.toPrecision(4))}`;
    const bytesOf = async (id) => {
        const zipped = Uint8Array.from(atob($(id).textContent), (c) => c.charCodeAt(0));
        return new Response(new Blob([zipped]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    };
    const made = (name, properties, ...children) => {
        const element = Object.assign(document.createElement(name), properties);
        element.append(...children);
        return element;
    };

    class Live {
        constructor(module, worker) {
            Object.assign(this, { module, script: worker });
            this.values = {};
            this.running = false;
            this.answer = undefined;
        }

        /** A new worker, in place of one that is at work. */
        start(wish) {
            this.worker?.terminate();
            this.worker = new Worker(this.script);
            this.piece = undefined;
            this.free = 0;
            clearTimeout(this.timer);
            return new Promise((resolve) => {
                this.worker.onerror = (event) => resolve({ fault: event.message });
                this.worker.onmessage = ({ data }) => {
                    if (data.bytes) return this.take(data);
                    const fault = this.draw(); // the last piece, before what it comes to
                    resolve(fault || !data.answer ? { fault: fault ?? data.fault } : data.answer);
                };
                this.worker.postMessage({ module: this.module, wish });
            });
        }

        async open() {
            this.scenes = await this.start();
            if (this.scenes.fault) return this.fail(this.scenes.fault);
            for (const { name } of this.scenes) $("scene").append(made("option", { value: name, textContent: name }));
            $("scene").addEventListener("change", () => this.choose($("scene").value));
            $("part").addEventListener("change", () => this.choose(this.scene.name, $("part").value));
            $("run").addEventListener("click", () => (this.running ? this.stop() : this.run()));
            const asked = new URLSearchParams(location.hash.slice(1));
            const values = Object.fromEntries([...new URLSearchParams(asked.get("with") ?? "")].map(([key, value]) => [key, Number(value)]));
            this.choose(asked.get("scene") ?? "bar", asked.get("part"), values);
        }

        choose(name, part, values = {}) {
            this.scene = this.scenes.find((scene) => scene.name === name) ?? this.scenes[0];
            this.part = this.scene.parts.find((each) => each === part) ?? this.scene.parts[0];
            $("scene").value = this.scene.name;
            $("part").replaceChildren(...this.scene.parts.map((each) => made("option", { value: each, textContent: each })));
            $("part").value = this.part;
            this.options = [...this.scene.options.filter((option) => option.part === "" || option.part === this.part), ...common];
            this.values = {};
            $("options").replaceChildren(...this.options.map((option) => this.slider(option, values[option.name])));
            return this.run();
        }

        /** By its logarithm where it goes over more than a decade. */
        slider(option, wanted) {
            const { name, about, unit, value, low, high } = option;
            const whole = unit === "-" && Number.isInteger(low) && Number.isInteger(high);
            const log = low > 0 && high / low > 10;
            const place = (v) => (log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low));
            const valueAt = (share) => {
                const v = Math.min(high, Math.max(low, log ? low * (high / low) ** share : low + (high - low) * share));
                return whole ? Math.round(v) : v;
            };
            const shown = made("output");
            const input = made("input", { type: "range", id: `option-${name}`, min: 0, max: 1, step: "any" });
            const set = (v) => {
                this.values[name] = v;
                shown.textContent = `${digits(v)}${unit === "-" ? "" : ` ${unit}`}`;
            };
            const valid = wanted >= low && wanted <= high; // nan is not
            set(valid ? wanted : value);
            input.value = place(this.values[name]);
            input.addEventListener("input", () => set(Number(digits(valueAt(Number(input.value))))));
            input.addEventListener("change", () => this.run());
            return made("label", {}, `${name}: ${about}`, shown, input);
        }

        set(name, value) {
            const option = this.options.find((each) => each.name === name);
            $(`option-${name}`).parentElement.replaceWith(this.slider(option, value));
        }

        async run() {
            const { rate, tolerance, ...options } = this.values;
            this.remember();
            this.running = true;
            this.answer = undefined;
            this.began = performance.now();
            $("run").textContent = "stop";
            $("running").className = "";
            $("running").textContent = "running";
            $("findings").replaceChildren();
            $("doubts").textContent = "";
            this.shown = 0;
            const number = (this.number = (this.number ?? 0) + 1);
            const answer = await this.start({ scene: this.scene.name, part: this.part, frame: 1 / rate, tolerance: tolerance / 100, options });
            if (number !== this.number || !this.running) return;
            this.halt();
            this.answer = answer;
            if (answer.fault) return this.fail(answer.fault);
            this.tell(answer);
        }

        stop() {
            this.halt();
            this.worker.terminate();
            this.piece = undefined;
            $("running").textContent = "stopped";
        }

        halt() {
            this.running = false;
            $("run").textContent = "run";
        }

        /** Nothing: nothing failed. */
        fail(text) {
            if (!text) return;
            this.halt();
            $("running").className = "fault";
            $("running").textContent = text;
        }

        /** A piece; where more come than can be drawn in a third of the time, the last one is. */
        take(piece) {
            if (!this.piece) this.timer = setTimeout(() => this.fail(this.draw()), Math.max(0, this.free - performance.now()));
            this.piece = piece;
        }

        /** Says why not where it cannot. */
        draw() {
            if (!this.piece) return undefined;
            const { bytes, kept } = this.piece;
            this.piece = undefined;
            const began = performance.now();
            try {
                showRecording(bytes, !kept);
            } catch (error) {
                return `it cannot be shown: ${error.message}`;
            }
            ++this.shown;
            const rest = () => (this.free = performance.now() + 2 * (performance.now() - began));
            requestAnimationFrame(() => setTimeout(rest)); // once it is drawn
            rest();
            $("running").textContent = `${replay.end.toFixed(2)} s of it, after ${((performance.now() - this.began) / 1000).toFixed(1)} s`;
            return undefined;
        }

        tell({ findings, doubted, frames, spent, dearest }) {
            const took = (performance.now() - this.began) / 1000;
            const each = frames > 0 ? `; ${frames} frames in ${spent.toFixed(2)} s, the dearest ${(1e3 * dearest).toFixed(1)} ms` : "";
            $("running").textContent = `done in ${took.toFixed(1)} s${each}${this.shown === 0 ? ". It has no picture: numbers alone" : ""}`;
            $("doubts").textContent = doubted.length > 0 ? `The World does not vouch for ${doubted.join(", ")}: it left a joint unsolved, or more of the work unresolved than the tolerance. More frames a second may help.` : "";
            const head = made("tr", {}, ...["", "came out", "must come out", ""].map((text) => made("th", { textContent: text })));
            $("findings").replaceChildren(head, ...findings.map(({ what, unit, came_out, expected, right }) => {
                const verdict = expected === null ? "told" : right ? "right" : "WRONG";
                const cells = [what, `${came_out === null ? "no number" : digits(came_out)} ${unit}`, expected === null ? "" : digits(expected), verdict];
                return made("tr", { className: right ? "" : "wrong" }, ...cells.map((text) => made("td", { textContent: text })));
            }));
        }

        remember() {
            const state = new URLSearchParams(location.hash.slice(1));
            state.set("scene", this.scene.name);
            state.set("part", this.part);
            state.set("with", new URLSearchParams(Object.entries(this.values)).toString());
            history.replaceState(null, "", `#${state}`);
        }
    }

    Promise.all([bytesOf("wasm").then((bytes) => WebAssembly.compile(bytes)), bytesOf("worker")]).then(
        async ([module, worker]) => {
            window.live = new Live(module, URL.createObjectURL(new Blob([worker], { type: "text/javascript" })));
            await window.live.open();
        },
        (error) => ($("running").textContent = `WebAssembly: ${error.message}`),
    );
})();
