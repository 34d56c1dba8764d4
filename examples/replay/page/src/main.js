// SPDX-License-Identifier: MIT
//
// The replay page: time, controls, and what they show. `window.replay` is for tests, the console, and
// a page that makes its recordings itself and calls `showRecording`.
import { css, gradient, brokenColour, lostColour } from "./colours.js";
import { CurvePlot, EnergyPlot, short } from "./plots.js";
import { broken, decode, decodeLaidDown, firstDifference, flowed, foremost, fromBase64, ofPage, placeOf, RecordingError, unreliable } from "./recording.js";
import { Scene } from "./scene.js";

const $ = (id) => document.getElementById(id);
const speeds = [1 / 1000, 1 / 300, 1 / 100, 1 / 30, 1 / 10, 1 / 4, 1 / 2, 1, 2, 4];

function say(message) {
    $("message").textContent = message;
    $("message").className = "";
    $("message").hidden = false;
}

function option(value, text) {
    const made = document.createElement("option");
    made.value = value;
    made.textContent = text;
    return made;
}

class Replay {
    constructor(recording) {
        this.playing = false;
        this.chosen = false; // the joint, by whoever looks
        this.speed = 1;
        this.colour = "utilisation";
        this.drawn = 0;
        this.scene = new Scene($("view"), recording);
        for (const speed of speeds) $("speed").append(option(speed, speed < 1 ? `1/${Math.round(1 / speed)}` : `${speed}`));
        this.take(recording);
        this.listen();
        this.restore();
        this.loop();
    }

    take(recording) {
        this.recording = recording;
        this.time = recording.times[0];
        this.end = recording.times[recording.times.length - 1];
        this.joint = foremost(recording.joints);
        this.axis = 0;
        this.marks = recording.events.filter(({ joint }) => !recording.joints[joint]?.helper);
        this.shown = undefined;
        this.energy?.destroy();
        this.curve?.destroy();
        const shown = { time: () => this.time, setTime: (time) => this.setTime(time), index: () => this.index() };
        this.energy = new EnergyPlot($("energy"), recording, shown);
        this.curve = new CurvePlot($("curve"), recording, shown);
        this.describe();
    }

    /**
     * Another recording, or this one where it has grown: then a joint that was chosen stays, and whoever was at its end is.
     * `growing`: it will be shown for a moment only, as when it plays.
     */
    show(recording, growing = false) {
        this.growing = growing;
        const grown = recording.name === this.recording.name && recording.joints.length === this.recording.joints.length;
        const { time, joint, axis, end } = this;
        this.scene.show(recording);
        this.take(recording);
        this.legend();
        this.chosen &&= grown;
        if (this.chosen) this.setJoint(joint, axis);
        else this.setJoint(this.joint);
        $("follow").value = String(this.scene.followed);
        this.setTime(grown && time < end ? time : this.end);
    }

    index() {
        return placeOf(this.recording.times, this.time).index;
    }

    describe() {
        const { recording } = this;
        document.title = recording.name;
        $("name").textContent = recording.name;
        $("engine").textContent = recording.engine;
        $("about").textContent = recording.about;
        for (const list of ["follow", "joint", "ticks", "events"]) $(list).textContent = "";
        $("follow").append(option(-1, "nothing"));
        recording.bodies.forEach((body, i) => body.moves && $("follow").append(option(i, body.name)));
        const helpers = document.createElement("optgroup");
        helpers.label = "what only guides";
        recording.joints.forEach((joint, i) => (joint.helper ? helpers : $("joint")).append(option(i, joint.name)));
        if (helpers.firstChild) $("joint").append(helpers);
        const start = recording.times[0];
        const span = this.end - start || 1;
        for (const event of this.marks) {
            const tick = document.createElement("i");
            tick.className = event.kind;
            tick.title = `${event.name} ${event.kind}, ${event.time.toFixed(4)} s`;
            tick.style.left = `${Math.max(0, (100 * (event.time - start)) / span)}%`;
            $("ticks").append(tick);
        }
        for (const event of recording.events) {
            const line = document.createElement("li");
            const button = document.createElement("button");
            if (!this.marks.includes(event)) button.className = "helper";
            button.textContent = `${event.time.toFixed(3)} s  ${event.name} ${event.kind}${event.energy > 0 ? `, ${short(event.energy, "J")}` : ""}`;
            button.addEventListener("click", () => {
                this.choose(event.joint);
                this.setTime(event.time);
            });
            line.append(button);
            $("events").append(line);
        }
        if (recording.events.length === 0) $("events").textContent = "nothing yielded or broke";
        $("scrub").min = start;
        $("scrub").max = this.end;
    }

    legend() {
        const plastic = this.colour === "plastic";
        const travels = Object.entries(this.scene.largest).filter(([, most]) => most > 0).map(([unit, most]) => short(most, unit));
        const ends = plastic ? travels : ["1 (flows)"];
        const kinds = [...new Set(this.marks.map(({ kind }) => kind))]; // words of the library
        $("legend").innerHTML = `<div>${plastic ? "plastic travel" : "utilisation of strength"}</div>
            <div class="bar" style="background:${gradient}"></div>
            ${ends.map((end) => `<div class="ends"><span>0</span> <span>${end}</span></div>`).join("")}
            <span style="color:${css(brokenColour)}">&#9679;</span> broken
            <span style="color:${css(lostColour)}">&#9679;</span> unreliable
            <div>${kinds.map((kind) => `<i class="${kind}"></i> ${kind}`).join(" ")}</div>`;
    }

    listen() {
        $("play").addEventListener("click", () => this.play(!this.playing));
        $("back").addEventListener("click", () => this.step(-1));
        $("forth").addEventListener("click", () => this.step(1));
        $("scrub").addEventListener("input", () => this.setTime(Number($("scrub").value)));
        $("speed").addEventListener("change", () => this.setSpeed(Number($("speed").value)));
        $("colour").addEventListener("change", () => this.setColour($("colour").value));
        $("joint").addEventListener("change", () => this.choose(Number($("joint").value)));
        $("axis").addEventListener("change", () => this.choose(this.joint, Number($("axis").value)));
        $("follow").addEventListener("change", () => this.setFollowed(Number($("follow").value)));
        $("reset").addEventListener("click", () => this.scene.reset());
        $("compare").addEventListener("change", () => this.compare($("compare").files[0]));
        const canvas = this.scene.renderer.domElement;
        let down;
        canvas.addEventListener("pointerdown", (event) => (down = event));
        canvas.addEventListener("click", (event) => {
            if (Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) > 4) return;
            const joint = this.scene.pick(event);
            if (joint >= 0) this.choose(joint);
        });
        this.scene.controls.addEventListener("end", () => this.remember());
        addEventListener("hashchange", () => this.restore());
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
            for (const { plot } of [this.energy, this.curve]) plot?.redraw(false, true);
        });
        addEventListener("keydown", (event) => {
            if (event.target.closest?.(`select, input[type=file]${event.key === " " ? ", button" : ""}`)) return;
            const keys = {
                " ": () => this.play(!this.playing), ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1),
                Home: () => this.setTime(this.recording.times[0]), End: () => this.setTime(this.end),
                r: () => this.scene.reset(), "+": () => this.faster(1), "-": () => this.faster(-1), n: () => this.nextEvent(),
            };
            if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
            event.preventDefault();
            keys[event.key]();
        });
    }

    faster(by) {
        const at = speeds.indexOf(this.speed);
        this.setSpeed(speeds[Math.min(speeds.length - 1, Math.max(0, at + by))]);
    }

    nextEvent() {
        const next = this.marks.find((event) => event.time > this.time + 1e-9);
        if (next) this.setTime(next.time);
    }

    play(on) {
        if (on && this.time >= this.end) this.time = this.recording.times[0];
        this.playing = on;
        this.last = undefined;
        $("play").textContent = on ? "pause" : "play";
        if (!on) this.remember();
    }

    step(by) {
        this.play(false);
        const { times } = this.recording;
        const { index, share } = placeOf(times, this.time);
        const to = by < 0 && share > 0 ? index : index + by;
        this.setTime(times[Math.min(times.length - 1, Math.max(0, to))]);
    }

    setSpeed(speed) {
        this.speed = speed;
        $("speed").value = String(speed);
        this.remember();
    }

    setColour(colour) {
        this.colour = colour;
        $("colour").value = colour;
        this.legend();
        this.draw();
        this.remember();
    }

    choose(joint, axis) {
        this.chosen = true;
        this.setJoint(joint, axis);
    }

    setJoint(joint, axis = 0) {
        this.joint = joint;
        const axes = this.recording.joints[joint]?.axes ?? [];
        this.axis = axes[axis] ? axis : 0;
        if (joint >= 0) $("joint").value = String(joint);
        $("axis").replaceChildren(...axes.map((each, i) => option(i, each.axis)));
        $("axis").value = String(this.axis);
        $("axis").hidden = axes.length < 2;
        this.curve.show(axes[this.axis]);
        this.facts();
        this.remember();
    }

    setFollowed(body) {
        this.scene.setFollowed(body);
        $("follow").value = String(body);
        this.remember();
    }

    setTime(time) {
        this.time = Math.min(this.end, Math.max(this.recording.times[0], time));
        this.draw();
        if (!this.playing) this.remember();
    }

    draw() {
        $("scrub").value = this.time;
        $("time").textContent = `${this.time.toFixed(4)} s`;
        this.scene.update(this.time, this.colour);
        this.energy.update();
        const index = this.index();
        if (index === this.shown) return;
        this.shown = index;
        this.curve.update();
        this.facts();
    }

    /** Numbers of the joint that is shown, at the sample that is shown. */
    facts() {
        const joint = this.recording.joints[this.joint];
        if (!joint) return;
        const i = this.index();
        const state = joint.state[i];
        const { force, turns } = joint.axes[this.axis];
        const words = state & broken ? "broken" : state & unreliable ? "unreliable" : state & flowed ? "has flowed" : "holds";
        const rows = [
            ["state", words],
            ["utilisation", joint.utilisation[i].toFixed(3)],
            [turns ? "moment" : "force", short(force[i], turns ? "N m" : "N")],
            ["strength left", state & broken ? "none" : `${Math.max(0, 100 * (1 - joint.utilisation[i])).toFixed(1)} %`],
            ["plastic travel", short(joint.plastic[i], joint.rotates ? "rad" : "m")],
            ["life left", Number.isNaN(joint.life[i]) ? "without end" : `${(100 * (1 - joint.life[i])).toFixed(1)} % of plastic travel`],
            ["absorbed", short(joint.absorbed[i], "J")],
            ["certificate", short(joint.residual[i])],
            ...joint.facts,
        ];
        const shown = $("facts");
        while (shown.children.length > 2 * rows.length) shown.lastChild.remove();
        rows.flat().forEach((text, k) => {
            const item = shown.children[k] ?? shown.appendChild(document.createElement(k % 2 ? "dd" : "dt"));
            if (item.textContent !== String(text)) item.textContent = text;
        });
    }

    async compare(file) {
        if (!file) return;
        try {
            const other = await decode(ofPage(await file.text()));
            const at = firstDifference(this.recording, other);
            document.querySelector("#ticks .differs")?.remove();
            if (other.name !== this.recording.name) return say(`${file.name} is of another scene: ${other.name}`);
            if (at < 0) return say("both recordings are the same, bit for bit");
            const time = this.recording.times[Math.min(at, this.recording.times.length - 1)];
            const tick = document.createElement("i");
            tick.className = "differs";
            tick.title = `differs from ${time.toFixed(4)} s on`;
            tick.style.left = `${(100 * (time - this.recording.times[0])) / (this.end - this.recording.times[0] || 1)}%`;
            $("ticks").append(tick);
            say(`the recordings differ from ${time.toFixed(4)} s on`);
            this.setTime(time);
        } catch (error) {
            say(`${file.name}: ${error.message}`);
        }
    }

    /** The state is in the address: t, speed, joint, axis, colour, what is followed, camera. */
    remember() {
        const state = new URLSearchParams(location.hash.slice(1)); // others have words there too
        const own = { t: this.time.toFixed(5), speed: this.speed, joint: this.joint, axis: this.axis, colour: this.colour, follow: this.scene.followed, camera: this.scene.pose().map((v) => v.toFixed(3)).join(",") };
        for (const [key, value] of Object.entries(own)) state.set(key, value);
        history.replaceState(null, "", `#${state}`);
    }

    restore() {
        const state = new URLSearchParams(location.hash.slice(1));
        const number = (key) => (state.has(key) ? Number(state.get(key)) : NaN);
        this.scene.setFollowed(-1);
        this.setSpeed(speeds.find((each) => Math.abs(each - number("speed")) < 1e-9) ?? 1);
        this.setColour(state.get("colour") === "plastic" ? "plastic" : "utilisation");
        if (this.recording.joints[number("joint")]) this.choose(number("joint"), number("axis"));
        else this.setJoint(this.joint);
        this.setTime(Number.isFinite(number("t")) ? number("t") : this.time);
        const camera = (state.get("camera") ?? "").split(",").map(Number);
        if (camera.length === 6 && camera.every(Number.isFinite)) this.scene.setPose(camera);
        this.setFollowed(this.recording.bodies[number("follow")]?.moves ? number("follow") : -1);
    }

    /** Drawn coarser while it plays where frames take longer than 1/30 s, sharp when it stands. */
    pace(now) {
        if (!this.playing) {
            this.pacing = undefined;
            if (this.growing) return this.scene.setSharpness(0.5);
            return this.scene.setSharpness(1);
        }
        this.pacing ??= { since: now, frames: 0 };
        if (++this.pacing.frames < 8) return;
        const each = (now - this.pacing.since) / this.pacing.frames;
        if (each > 34) this.scene.setSharpness(Math.max(0.4, 0.75 * this.scene.sharpness));
        this.pacing = { since: now, frames: 0 };
    }

    loop() {
        const frame = (now) => {
            requestAnimationFrame(frame);
            this.pace(now);
            if (this.playing) {
                const passed = this.last === undefined ? 0 : (now - this.last) / 1000;
                this.last = now;
                this.setTime(this.time + this.speed * passed);
                if (this.time >= this.end) this.play(false);
            }
            if (this.scene.render()) ++this.drawn;
        };
        requestAnimationFrame(frame);
    }
}

/** Bytes as packed.hpp lays them down, not zipped; `growing`: there will be more. */
window.showRecording = (bytes, growing) => {
    const recording = decodeLaidDown(bytes);
    if (window.replay) window.replay.show(recording, growing);
    else window.replay = new Replay(recording);
};

async function start() {
    $("message").hidden = true; // that the script does not run
    if (document.getElementById("live")) return;
    try {
        const script = document.getElementById("recording");
        if (!script) throw new RecordingError("there is no recording in this page");
        window.replay = new Replay(await decode(fromBase64(script.textContent)));
    } catch (error) {
        say(error.message);
        if (!(error instanceof RecordingError)) throw error;
    }
}

start();
