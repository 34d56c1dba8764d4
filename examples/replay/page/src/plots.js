// SPDX-License-Identifier: MIT
//
// Energies over time, and a joint's force over its travel: both show the time, both set it.
import uPlot from "uplot";

const colours = {
    kinetic: "#2f7ed8", potential: "#7aa6c2", elastic: "#2aa198", plastic: "#d33c3c", friction: "#b58900",
    contact: "#cb6b16", joints: "#8a63b5", integration: "#8f8f8f", damping: "#5b8c5a", unexplained: "#e000a0",
};

const ink = () => getComputedStyle(document.body).color;
const line = () => getComputedStyle(document.body).getPropertyValue("--line");
const axis = (label) => ({ label, labelSize: 16, labelFont: "11px system-ui", font: "11px system-ui", stroke: ink, grid: { stroke: line }, ticks: { stroke: line }, size: 52 });

/** 12345.6 -> "12.3 k" */
export function short(value) {
    if (!Number.isFinite(value)) return "-";
    const size = Math.abs(value);
    for (const [by, unit] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]]) {
        if (size >= by) return `${Number((value / by).toPrecision(3))} ${unit}`;
    }
    return size === 0 || size >= 1e-3 ? `${Number(value.toPrecision(3))}` : value.toExponential(1);
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

/** Where each energy ends when all are stacked; what is negative is drawn as nothing. */
export function stacked(energies) {
    const shown = energies.filter(({ name }) => name !== "supplied" && name !== "unexplained");
    const count = shown.length ? shown[0].values.length : 0;
    const top = new Float64Array(count);
    return shown.map(({ name, values }) => {
        const base = name === "potential" ? values.reduce((a, b) => (b < a ? b : a), Infinity) : 0;
        for (let i = 0; i < count; ++i) top[i] += Math.max(0, values[i] - base);
        return { name, values: Array.from(top) };
    });
}

export class EnergyPlot {
    constructor(target, recording, { time, setTime }) {
        this.time = time;
        target.textContent = "";
        const bands = stacked(recording.energies);
        const unexplained = recording.energies.find(({ name }) => name === "unexplained");
        if (bands.length === 0) {
            target.textContent = "no ledger was kept";
            return;
        }
        // the highest first, so that lower ones are painted over it
        const order = bands.map((_, i) => bands.length - 1 - i);
        const series = order.map((i) => ({
            label: bands[i].name,
            stroke: colours[bands[i].name] ?? "#999",
            fill: colours[bands[i].name] ?? "#999",
            width: 1,
            points: { show: false },
            value: (_, __, ___, at) => (at == null ? "" : `${short(recording.energies.find((e) => e.name === bands[i].name).values[at])} J`),
        }));
        const data = [Array.from(recording.times), ...order.map((i) => bands[i].values)];
        if (unexplained) {
            series.push({ label: "unexplained", stroke: colours.unexplained, width: 2, points: { show: false }, value: (_, v) => (v == null ? "" : `${short(v)} J`) });
            data.push(Array.from(unexplained.values));
        }
        this.plot = new uPlot(
            {
                width: widthOf(target), height: 210, cursor: { drag: { x: false, y: false } }, scales: { x: { time: false } },
                series: [{ label: "time", value: (_, v) => (v == null ? "" : `${v.toFixed(3)} s`) }, ...series],
                axes: [axis("time [s]"), { ...axis("energy [J]"), values: (_, ticks) => ticks.map(short) }],
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
    show(number) {
        this.destroy();
        const joint = this.recording.joints[number];
        if (!joint) return;
        const { force, position, turns } = joint;
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
                axes: [
                    { ...axis(turns ? `${joint.axis}: rotation [rad]` : `${joint.axis}: travel [m]`), values: (_, ticks) => ticks.map(short) },
                    { ...axis(turns ? "moment [N m]" : "force [N]"), values: (_, ticks) => ticks.map(short) },
                ],
                plugins: [curve],
            },
            [null, [position, force]], this.target,
        );
        this.dot = overlay(this.plot, "dot");
        this.number = number;
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
        const { force, position } = this.recording.joints[this.number];
        const i = this.index();
        put(this.dot, this.plot.valToPos(position[i], "x"), this.plot.valToPos(force[i], "y"));
    }
}
