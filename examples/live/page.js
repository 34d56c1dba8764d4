// SPDX-License-Identifier: MIT
//
// The page of live.cpp: sliders, what must come out, three bars side by side. `window.live` is for
// tests and the console.
"use strict";
const $ = (id) => document.getElementById(id);
const gravity = 9.81;
// in the order of Wish in live.cpp
const wishes = [
    { key: "loaded", name: "what happens", choices: [["thrown: a post turns about its foot", 0], ["loaded: a cantilever under its weight", 1]], value: 0 },
    { key: "rods", name: "rods", low: 1, high: 16, step: 1, value: 4 },
    { key: "length", name: "length", unit: "m", low: 1, high: 8, step: 0.5, value: 4 },
    { key: "side", name: "section: side", unit: "mm", low: 40, high: 200, step: 5, value: 100, by: 1e-3 },
    { key: "wall", name: "section: wall", unit: "mm", low: 2, high: 12, step: 0.5, value: 4, by: 1e-3 },
    { key: "yield", name: "steel", choices: [["S235", 235e6], ["S355", 355e6], ["S460", 460e6], ["S690", 690e6]], value: 355e6 },
    { key: "mass", name: "mass on the tip", unit: "kg", low: 0, high: 600, step: 10, value: 100 },
    { key: "speed", name: "speed of the tip", unit: "m/s", low: 0, high: 30, step: 0.5, value: 10 },
    { key: "largest", name: "breaks after", unit: "rad", low: 0.05, high: 1.5, step: 0.05, value: 1 },
    { key: "rate", name: "frames", unit: "a second", low: 15, high: 1000, step: 1, value: 60, curve: true },
    { key: "iterations", name: "iterations of the solver", low: 1, high: 200, step: 1, value: 10 },
    { key: "direct", name: "solver of Bullet", choices: [["sequential impulse (default)", 0], ["Dantzig (direct)", 1]], value: 0 },
];
const pace = { key: "pace", name: "time runs", choices: [["as it does", 1], ["at a quarter", 0.25], ["at a 20th", 0.05]], value: 0.05 };
const names = ["this library", "Bullet's motor", "Bullet's spring"];
const colours = ["#2f7ed8", "#cb6b16", "#8a63b5"];
const ended = 0.4; // what is drawn of a time that is long over [s]

function say(text) {
    $("message").textContent = text;
}

class Live {
    constructor(module) {
        this.module = module;
        this.values = Object.fromEntries([...wishes, pace].map(({ key, value }) => [key, value]));
        this.shown = {};
        for (const wish of [...wishes, pace]) this.control(wish);
        $("again").addEventListener("click", () => this.start());
        addEventListener("keydown", (event) => {
            if (event.key !== " " || event.target.closest("select, input, button")) return;
            event.preventDefault();
            this.start();
        });
        this.start();
        let last;
        const frame = (now) => {
            requestAnimationFrame(frame);
            if (last !== undefined && this.held !== true) this.run(Math.min(0.1, (now - last) / 1000) * this.values.pace);
            last = now;
            this.draw();
        };
        requestAnimationFrame(frame);
    }

    control({ key, name, unit, low, high, step, value, choices, curve }) {
        const label = document.createElement("label");
        const output = document.createElement("output");
        const input = document.createElement(choices ? "select" : "input");
        label.append(name, output, input);
        input.id = key;
        if (choices) {
            for (const [text, each] of choices) input.append(new Option(text, each, each === value, each === value));
        } else {
            Object.assign(input, { type: "range", min: curve ? Math.log(low) : low, max: curve ? Math.log(high) : high, step: curve ? "any" : step });
            input.value = curve ? Math.log(value) : value;
        }
        const shown = (this.shown[key] = () => (output.textContent = choices ? "" : `${this.values[key]} ${unit ?? ""}`));
        input.addEventListener("input", () => {
            this.values[key] = curve ? Math.round(Math.exp(input.value)) : Number(input.value);
            shown();
            if (key !== "pace") this.start();
        });
        shown();
        $("controls").append(label);
    }

    /** Sets values by key and starts again. */
    set(values) {
        Object.assign(this.values, values);
        for (const { key, curve } of [...wishes, pace]) {
            $(key).value = curve ? Math.log(this.values[key]) : this.values[key];
            this.shown[key]();
        }
        this.start();
    }

    start() {
        const at = this.module._live_wish() / 8;
        wishes.forEach(({ key, by = 1 }, i) => (this.module.HEAPF64[at + i] = this.values[key] * by));
        const fault = this.module.UTF8ToString(this.module._live_start());
        say(fault);
        this.failed = fault !== "";
        this.owed = 0;
        this.traces = names.map(() => []);
        if (!this.failed) this.read();
    }

    /** So many seconds of the bars' own time. */
    run(seconds) {
        if (this.failed) return;
        const end = this.end();
        for (this.owed += seconds; this.owed >= 1 / this.values.rate - 1e-9; this.owed -= 1 / this.values.rate) {
            if (this.state.time > end) continue;
            this.module._live_step();
            this.read();
        }
    }

    /** Where there is no more to see [s]. */
    end() {
        const { loaded, speed, length } = this.values;
        return loaded ? 3 : Math.min(10, ended + (speed > 0 ? 4 * this.must().turn / (speed / length) : 0));
    }

    read() {
        const { HEAPF64 } = this.module;
        let at = this.module._live_state() / 8;
        const take = () => HEAPF64[at++];
        const state = { time: take(), moment: take(), energy: take(), share: take(), rods: take() };
        state.bars = names.map(() => {
            const bar = { kinetic: take(), taken: take(), turn: take(), cost: take(), broken: take(), doubtful: take() };
            bar.rods = Array.from({ length: state.rods }, () => [take(), take(), take()]);
            return bar;
        });
        this.state = state;
        state.bars.forEach((bar, i) => this.traces[i].push([state.time, this.measure(bar)]));
    }

    /** By the mechanics: where it comes to rest, or what is left when it breaks. */
    must() {
        const { energy, moment, share } = this.state;
        const { loaded, largest } = this.values;
        if (loaded) return { stands: share < 1, turn: 0, taken: 0, kinetic: 0 };
        const breaks = energy > moment * largest;
        const taken = breaks ? moment * largest : energy;
        return { breaks, turn: taken / moment, taken, kinetic: energy - taken };
    }

    /** What the plot and the first row show of a bar: turn of its foot, or how far its tip has sunk. */
    measure(bar) {
        return this.values.loaded ? -this.tip(bar)[1] : bar.turn;
    }

    tip(bar) {
        const [, end] = this.ends(bar, bar.rods.length - 1);
        return end;
    }

    /** Of a rod: the last one's centre is shifted towards its tip by the mass there. */
    ends(bar, k) {
        const [x, z, turn] = bar.rods[k];
        const part = this.values.length / this.state.rods;
        const own = this.rodMass() * part;
        const shift = k === bar.rods.length - 1 ? (this.values.mass * part) / 2 / (own + this.values.mass) : 0;
        const along = this.values.loaded ? [Math.cos(turn), -Math.sin(turn)] : [Math.sin(turn), Math.cos(turn)];
        return [-part / 2 - shift, part / 2 - shift].map((s) => [x + s * along[0], z + s * along[1]]);
    }

    over() {
        return this.state.time > this.end() - 0.3;
    }

    draw() {
        if (this.failed) return;
        const must = this.must();
        this.write(must);
        const canvas = $("view");
        const wide = canvas.clientWidth * devicePixelRatio;
        if (canvas.width !== Math.round(wide)) Object.assign(canvas, { width: Math.round(wide), height: Math.round(wide * 0.375) });
        const { width, height } = canvas;
        const ink = canvas.getContext("2d");
        const style = getComputedStyle(document.body);
        ink.clearRect(0, 0, width, height);
        const panel = width / 4;
        const scale = (0.8 * Math.min(height, panel)) / this.values.length;
        const { loaded } = this.values;
        this.state.bars.forEach((bar, i) => {
            const foot = [panel * i + (loaded ? 0.1 : 0.25) * panel, loaded ? 0.3 * height : 0.92 * height];
            const line = (points, colour, thick, dash = []) => {
                ink.strokeStyle = colour;
                ink.lineWidth = thick;
                ink.setLineDash(dash);
                ink.beginPath();
                for (const [x, z] of points) ink.lineTo(foot[0] + scale * x, foot[1] - scale * z);
                ink.stroke();
                ink.setLineDash([]);
            };
            const length = this.values.length;
            const way = loaded ? [length, 0] : [length * Math.sin(must.turn), length * Math.cos(must.turn)];
            if (!must.breaks && !(loaded && !must.stands)) line([[0, 0], way], style.getPropertyValue("--faint"), 1.5, [6, 6]);
            bar.rods.forEach((_, k) => {
                const ends = this.ends(bar, k);
                line(ends, colours[i], Math.max(3, scale * this.values.side * 1e-3));
                if (k < bar.rods.length - 1) return;
                ink.fillStyle = colours[i];
                ink.beginPath();
                ink.arc(foot[0] + scale * ends[1][0], foot[1] - scale * ends[1][1], 4 + 3 * Math.cbrt(this.values.mass / 10), 0, 7);
                ink.fill();
            });
            line(loaded ? [[0, -0.12 * length], [0, 0.12 * length]] : [[-0.15 * length, 0], [0.15 * length, 0]], style.color, 3);
            ink.fillStyle = style.color;
            ink.font = `${13 * devicePixelRatio}px system-ui`;
            ink.fillText(names[i], panel * i + 4, 16 * devicePixelRatio);
        });
        this.plot(ink, 3 * panel, panel, height, must, style);
    }

    rodMass() {
        const [a, b] = [this.values.side * 1e-3, (this.values.side - 2 * this.values.wall) * 1e-3];
        return 7850 * (a * a - b * b);
    }

    /** What is measured, over time. */
    plot(ink, left, wide, high, must, style) {
        const most = Math.max(0.02, 1.3 * must.turn, this.values.loaded ? 0.25 * this.values.length : 0);
        const x = (t) => left + 0.12 * wide + (0.84 * wide * t) / this.end();
        const y = (turn) => 0.9 * high - (0.8 * high * Math.max(-0.05 * most, Math.min(1.1 * most, turn))) / most;
        const line = (points, colour, dash = []) => {
            ink.strokeStyle = colour;
            ink.lineWidth = 2;
            ink.setLineDash(dash);
            ink.beginPath();
            for (const [t, turn] of points) ink.lineTo(x(t), y(turn));
            ink.stroke();
            ink.setLineDash([]);
        };
        line([[0, 1.1 * most], [0, 0], [this.end(), 0]], style.getPropertyValue("--faint"));
        if (!must.breaks && !(this.values.loaded && !must.stands)) line([[0, must.turn], [this.end(), must.turn]], style.getPropertyValue("--faint"), [6, 6]);
        this.traces.forEach((trace, i) => line(trace, colours[i]));
        ink.fillStyle = style.color;
        ink.font = `${12 * devicePixelRatio}px system-ui`;
        ink.fillText(this.values.loaded ? `tip, ${most.toFixed(1)} m in ${this.end().toFixed(1)} s` : `foot, ${most.toFixed(2)} rad in ${this.end().toFixed(2)} s`, left + 0.2 * wide, 34 * devicePixelRatio);
    }

    write(must) {
        const { state } = this;
        const percent = (value) => `${(100 * value).toFixed(1)} %`;
        const joule = (value) => `${value.toFixed(1)} J`;
        const { loaded } = this.values;
        $("time").textContent = `${state.time.toFixed(3)} s`;
        $("must").textContent = loaded
            ? `Plastic moment ${(state.moment / 1e3).toFixed(2)} kN m; the weight, all of it after 1 s, asks ${percent(state.share)} of it at the root: ${must.stands ? "it stands, level, and nothing flows" : "it falls"}.`
            : `Plastic moment ${(state.moment / 1e3).toFixed(2)} kN m; the post has ${joule(state.energy)}: its foot ${must.breaks ? `breaks after ${this.values.largest} rad, ${joule(must.kinetic)} are left` : `stops it after E/M_p = ${must.turn.toFixed(4)} rad`}.`;
        const rows = [
            loaded ? ["its tip has sunk [m]", must.stands ? "0" : "", (bar) => this.measure(bar).toFixed(4)] : ["turn of the foot [rad]", must.breaks ? "" : must.turn.toFixed(4), (bar) => bar.turn.toFixed(4)],
            ["joints took", loaded ? (must.stands ? "0 J" : "") : joule(must.taken), (bar) => joule(bar.taken)],
            ["still moving", loaded && !must.stands ? "" : joule(must.kinetic), (bar) => joule(bar.kinetic)],
            ["broken joints", must.breaks ? "1" : "0", (bar) => `${bar.broken}`],
            ["dearest frame", "", (bar) => `${bar.cost.toFixed(2)} ms`],
        ];
        const verdict = (bar) => {
            if (!this.over()) return "";
            if (loaded) return Math.abs(this.measure(bar)) < 0.02 * this.values.length === must.stands;
            return must.breaks ? bar.broken > 0 && Math.abs(bar.taken - must.taken) < 0.02 * must.taken : Math.abs(bar.turn - must.turn) < 0.02 * must.turn + 1e-4;
        };
        const made = rows.map(([name, want, of]) => [name, want, ...state.bars.map(of)]);
        made.push(["right to 2 %?", "", ...state.bars.map((bar) => ({ "": "", true: "yes", false: "no" })[verdict(bar)])]);
        const body = $("rows");
        made.forEach((row, i) => {
            const line = body.children[i] ?? body.appendChild(document.createElement("tr"));
            row.forEach((text, k) => {
                const cell = line.children[k] ?? line.appendChild(document.createElement("td"));
                if (cell.textContent === text) return;
                cell.textContent = text;
                cell.className = text === "yes" ? "good" : text === "no" ? "bad" : "";
            });
        });
    }
}

makeLive().then((module) => (window.live = new Live(module)), (error) => say(`WebAssembly: ${error}`));
