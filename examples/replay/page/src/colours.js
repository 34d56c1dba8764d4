// SPDX-License-Identifier: MIT
//
// From a share to a colour: grey where nothing is asked, through yellow to red where all is.

const stops = [
    [0.0, [0.55, 0.6, 0.67]],
    [0.5, [0.93, 0.79, 0.25]],
    [1.0, [0.83, 0.18, 0.18]],
];
export const brokenColour = [0.08, 0.08, 0.1];
export const lostColour = [0.61, 0.3, 1.0]; // unreliable
export const stillColour = [0.42, 0.46, 0.42];

export function colourOf(share) {
    const at = Math.min(1, Math.max(0, share));
    const upper = at < stops[1][0] ? 1 : 2;
    const [from, low] = stops[upper - 1];
    const [to, high] = stops[upper];
    const f = (at - from) / (to - from);
    return low.map((c, k) => c + f * (high[k] - c));
}

export const css = (colour) => `rgb(${colour.map((c) => Math.round(255 * c)).join(" ")})`;
export const gradient = `linear-gradient(90deg, ${stops.map(([at, c]) => `${css(c)} ${100 * at}%`).join(", ")})`;
