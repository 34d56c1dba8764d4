#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Limit loads of frames of rigid bodies whose joints share ellipsoids: limit_load.py < STATICS

One frame a line, as structures_bullet_double "[.statics]" prints them; of each the factor of its weights at which it
falls, from below and above, and what the elastic frame makes of the weights at factor 1: the largest share of a
joint's strength, and the energy [J].

    kinematic   λ = min Σ |P∘(Bᵀu)|  with  w·u = 1      B equilibrium matrix, P capacities, w weights
    static      λ = max λ            with  B f = -λ w,  |f/P| <= 1

The kinematic sum is smoothed, √(|z|² + ε²), and minimised by Newton for ever smaller ε. The z/√(|z|² + ε²) of its
minimum are forces in equilibrium inside the surfaces, so that each ε brackets λ by both theorems.
"""

import json
import sys

import numpy as np


def statics(frame):
    """B, w, P, k."""
    bodies, joints = np.array(frame["bodies"]), frame["joints"]
    equilibrium = np.zeros((6 * len(bodies), 6 * len(joints)))
    capacity, stiffness = [], []
    for j, joint in enumerate(joints):
        numbers = np.array(joint["numbers"])
        place, axes = numbers[:3], numbers[3:12].reshape(3, 3).T
        capacity.append(numbers[12:18])
        stiffness.append(numbers[18:24])
        for body, sign in ((joint["a"], 1), (joint["b"], -1)):
            if body < 0:
                continue
            x, y, z = place - bodies[body, 1:]
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            rows, forces = slice(6 * body, 6 * body + 3), slice(6 * j, 6 * j + 3)
            moments = slice(6 * j + 3, 6 * j + 6)
            equilibrium[rows, forces] += sign * axes
            equilibrium[6 * body + 3:6 * body + 6, forces] += sign * cross @ axes
            equilibrium[6 * body + 3:6 * body + 6, moments] += sign * axes
    weights = np.zeros(6 * len(bodies))
    weights[2::6] = -9.81 * bodies[:, 0]
    return equilibrium, weights, np.concatenate(capacity), np.concatenate(stiffness)


def elastic(equilibrium, weights, capacity, stiffness):
    forces = -stiffness * (equilibrium.T @ np.linalg.solve(equilibrium * stiffness @ equilibrium.T, weights))
    return np.linalg.norm((forces / capacity).reshape(-1, 6), axis=1).max(), np.sum(forces**2 / stiffness) / 2


def newton(rows, weights, u, epsilon):
    """The minimum of the smoothed sum from u on, and its forces over their capacities."""
    def shares(u):
        z = (rows @ u).reshape(-1, 6)
        length = np.sqrt((z * z).sum(1) + epsilon * epsilon)
        return length, z / length[:, None]

    size = len(u)
    for _ in range(30):
        length, f = shares(u)
        gradient = rows.T @ f.ravel()
        tangent = (np.eye(6) - f[:, :, None] * f[:, None, :]) / length[:, None, None]
        hessian = rows.T @ np.einsum("qij,qjn->qin", tangent, rows.reshape(-1, 6, size)).reshape(-1, size)
        scale = np.sqrt(np.maximum(np.diag(hessian), 1e-12 * np.diag(hessian).max()))
        normal = weights / scale
        normal /= np.linalg.norm(normal)
        system = np.block([[hessian / np.outer(scale, scale) + 1e-14 * np.eye(size), normal[:, None]],
                           [normal[None, :], np.zeros((1, 1))]])
        change = np.linalg.solve(system, np.append(-gradient / scale, 0))[:size] / scale
        decrement, share = -gradient @ change, 1.0
        while shares(u + share * change)[0].sum() > length.sum() - 1e-4 * share * decrement and share > 1e-8:
            share /= 2
        u = u + share * change
        if decrement < 1e-9 * length.sum():
            break
    return u, shares(u)[1]


def limit_load(equilibrium, weights, capacity, stiffness):
    """λ from below and from above."""
    rows = (equilibrium * capacity).T
    u = np.linalg.solve(equilibrium * stiffness @ equilibrium.T, weights)
    u /= weights @ u
    epsilon, below, above = np.abs(rows @ u).max(), 0, np.inf
    for _ in range(60):
        u, f = newton(rows, weights, u, epsilon)
        carried = rows.T @ f.ravel()
        factor = carried @ weights / (weights @ weights)
        above = min(above, np.linalg.norm((rows @ u).reshape(-1, 6), axis=1).sum() / (weights @ u))
        if np.linalg.norm(carried - factor * weights) < 1e-6 * np.linalg.norm(factor * weights):
            below = max(below, factor)
        if above - below < 2e-5 * above:
            break
        epsilon /= 3
    return below, above


def main():
    print("seed  bodies  joints  from below  from above  elastic use  energy")
    for line in sys.stdin:
        if not line.startswith("{"):
            continue
        frame = json.loads(line)
        of_frame = statics(frame)
        below, above = limit_load(*of_frame)
        use, energy = elastic(*of_frame)
        print(f"{frame['seed']:4}  {len(frame['bodies']):6}  {len(frame['joints']):6}  {below:10.5f}  {above:10.5f}"
              f"  {use:11.6f}  {energy:8.6g}", flush=True)


if __name__ == "__main__":
    main()
