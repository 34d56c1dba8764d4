// SPDX-License-Identifier: MIT
//
// Energies over time, and a joint's force over its travel: both show the time, both set it.
import uPlot from "uplot";

const colours = {
    kinetic: "#2f7ed8", potential: "#7aa6c2", elastic: "#2aa198", plastic: "#d33c3c", friction: "#b58900",
    contact: "#cb6b16", joints: "#8a63b5", integration: "#8f8f8f", damping: "#5b8c5a", members: "#6d4c41", vibration: "#00acc1",
    sleep: "#9e9d24", supplied: "#5c6bc0", unexplained: "#e000a0",
};

const ink = () => getComputedStyle(document.body).color;
const line = () => getComputedStyle(document.body).getPropertyValue("--line");
const axis = (label, values) => ({ label, ...values && { values: (_, ticks) => ticks.map((tick) => short(tick)) }, labelSize: 16, labelFont: "11px system-ui", font: "11px system-ui", stroke: ink, grid: { stroke: line }, ticks: { stroke: line }, size: 52 });

/** 12345.6, "N m" -> "12.3 kN m" */
export function short(value, unit = "") {
    if (!Number.isFinite(value)) return "-";
    const size = Math.abs(value);
    const [by, prefix] = [[1e9, "G"], [1e6, "M"], [1e3, "k"]].find(([by]) => size >= by) ?? [1, ""];
    const digits = size === 0 || size >= 1e-3 ? Number((value / by).toPrecision(3)) : value.toExponential(1);
    return `${digits} ${prefix}${unit}`.trimEnd();
}

function widthOf(target) {
    return Math.max(200, target.clientWidth);
}

function keepWidth(plot, target) {
    const observer = new ResizeObserver(() => plot.setSize({ width: widthOf(target), height: plot.height }));
    observer.observe(target);
    return observer;
}

/** What is laid over a plot, so that it is not drawn anew for each frame. */
function overlay(plot, name) {
    const made = document.createElement("i");
    made.className = name;
    plot.over.append(made);
    return made;
}

/** Without a layout: the mark is a layer of its own. */
function put(mark, x, y) {
    mark.style.transform = `translate(${x}px, ${y}px)`;
}

/**
 * Where each energy that there is ends when all are stacked, what is negative below zero; the potential one from the
 * least that it comes to. What was supplied, so much less, is the upper edge less the lower one: a line of its own.
 */
export function stacked(energies) {
    const potential = energies.find(({ name }) => name === "potential")?.values ?? [0];
    const base = potential.reduce((a, b) => (b < a ? b : a));
    const lines = ["supplied", "unexplained"];
    const [above, below] = [[], []];
    const shown = energies.filter(({ name, values }) => !lines.includes(name) && values.some((v) => v !== 0));
    const bands = shown.map(({ name, values }) => ({
        name, values: Array.from(values, (v, i) => {
            const own = name === "potential" ? v - base : v;
            const edge = own < 0 ? below : above;
            return (edge[i] = (edge[i] ?? 0) + own);
        }),
    }));
    const rest = energies.filter(({ name }) => lines.includes(name));
    return { bands, lines: rest.map(({ name, values }) => ({ name, values: Array.from(values, (v) => (name === "supplied" ? v - base : v)) })) };
}

export class EnergyPlot {
    constructor(target, recording, { time, setTime }) {
        this.time = time;
        target.textContent = "";
        if (recording.energies.length === 0) {
            target.textContent = "no ledger was kept";
            return;
        }
        const { bands, lines } = stacked(recording.energies);
        // the highest first, so that lower ones are painted over it
        const all = [...[...bands].reverse(), ...lines];
        const series = all.map(({ name }) => ({
            label: name,
            stroke: colours[name] ?? "#999",
            ...(bands.some((band) => band.name === name) ? { fill: colours[name] ?? "#999", width: 1 } : { width: 2 }),
            ...name === "supplied" && { dash: [6, 4] },
            points: { show: false },
            value: (_, __, ___, at) => (at == null ? "" : short(recording.energies.find((e) => e.name === name).values[at], "J")),
        }));
        const data = [Array.from(recording.times), ...all.map(({ values }) => values)];
        this.plot = new uPlot(
            {
                width: widthOf(target), height: 210, cursor: { drag: { x: false, y: false } }, scales: { x: { time: false } },
                series: [{ label: "time", value: (_, v) => (v == null ? "" : `${v.toFixed(3)} s`) }, ...series],
                axes: [axis("time [s]"), axis("energy [J]", true)],
            },
            data, target,
        );
        this.line = overlay(this.plot, "now");
        this.plot.over.addEventListener("click", () => setTime(this.plot.posToVal(this.plot.cursor.left, "x")));
        this.observer = keepWidth(this.plot, target);
    }
    destroy() {
        this.observer?.disconnect();
        this.plot?.destroy();
    }
    update() {
        if (this.plot) put(this.line, this.plot.valToPos(this.time(), "x"), 0);
    }
}

export class CurvePlot {
    constructor(target, recording, { time, setTime, index }) {
        Object.assign(this, { target, recording, index, setTime, time });
    }
    destroy() {
        this.observer?.disconnect();
        this.plot?.destroy();
        this.plot = undefined;
    }
    /** @param shown  an axis of a joint */
    show(shown) {
        this.destroy();
        if (!shown) return;
        const { axis: name, force, position, turns } = shown;
        // a curve that goes back and forth: uPlot's own paths want x to increase
        const curve = {
            hooks: {
                draw: (plot) => {
                    const { ctx, bbox } = plot;
                    ctx.save();
                    ctx.beginPath();
                    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
                    ctx.clip();
                    ctx.strokeStyle = colours.kinetic;
                    ctx.lineWidth = 1.5 * devicePixelRatio;
                    ctx.beginPath();
                    for (let i = 0; i < force.length; ++i) ctx.lineTo(plot.valToPos(position[i], "x", true), plot.valToPos(force[i], "y", true));
                    ctx.stroke();
                    ctx.restore();
                },
            },
        };
        const range = (values) => {
            let low = Infinity;
            let high = -Infinity;
            for (const v of values) if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
            if (!(high > low)) [low, high] = [(Number.isFinite(low) ? low : 0) - 1, (Number.isFinite(high) ? high : 0) + 1];
            const margin = 0.05 * (high - low);
            return [low - margin, high + margin];
        };
        this.plot = new uPlot(
            {
                mode: 2, width: widthOf(this.target), height: 190, legend: { show: false }, cursor: { drag: { x: false, y: false }, points: { show: false } },
                scales: { x: { time: false, range: range(position) }, y: { range: range(force) } },
                series: [{}, { paths: () => null, facets: [{ scale: "x", auto: false }, { scale: "y", auto: false }] }],
                axes: [axis(turns ? `${name}: rotation [rad]` : `${name}: travel [m]`, true), axis(turns ? "moment [N m]" : "force [N]", true)],
                plugins: [curve],
            },
            [null, [position, force]], this.target,
        );
        this.dot = overlay(this.plot, "dot");
        this.shown = shown;
        this.update();
        this.plot.over.addEventListener("click", () => {
            const { left, top } = this.plot.cursor;
            let best = 0;
            let nearest = Infinity;
            for (let i = 0; i < force.length; ++i) {
                const distance = Math.hypot(this.plot.valToPos(position[i], "x") - left, this.plot.valToPos(force[i], "y") - top);
                if (distance < nearest) [nearest, best] = [distance, i];
            }
            this.setTime(this.recording.times[best]);
        });
        this.observer = keepWidth(this.plot, this.target);
    }
    update() {
        if (!this.plot) return;
        const { force, position } = this.shown;
        const i = this.index();
        put(this.dot, this.plot.valToPos(position[i], "x"), this.plot.valToPos(force[i], "y"));
    }
}
