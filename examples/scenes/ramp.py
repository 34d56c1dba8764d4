# SPDX-License-Identifier: MIT
#
# What the scene `ramp` must come to, by a calculation of its own, without the library: ramp and
# cars in the plane, integrated in steps of 20 us (semi-implicit Euler; of a quarter of it no figure
# differs in its last digit but one). Contacts of wheels are stiff springs with dashpots, which is what
# a contact without a bounce comes to; struts are guided by stiff springs.
#
#   python3 ramp.py              prints what ramp.cpp quotes
#   python3 ramp.py 5e-6         in other steps [s]
import math
import sys

GRAVITY = 9.81
MASS, LENGTH, THICK, GAP = 2160.0, 18.0, 0.04, 0.02
PIVOT = (60.0, 5.0)
SPRING = MASS * LENGTH**2 / 12 * (2 * math.pi) ** 2  # 1 Hz of the ramp's turn about its middle
DASHPOT = 2 * 0.2 * MASS * LENGTH**2 / 12 * 2 * math.pi
MOMENT, LIFE = 0.12 * SPRING, 0.4
PAD = (41.0, 5.8)
CHASSIS, AXLE, RADIUS, BASE, HEIGHT = 680.0, 50.0, 0.4, 0.9, 0.7
STRUT = CHASSIS / 2 * (2 * math.pi * 4) ** 2
STRUT_DASHPOT = 2 * 0.7 * CHASSIS / 2 * 2 * math.pi * 4
CHASSIS_INERTIA = CHASSIS * (3.0**2 + 0.9**2) / 12 + 2 * AXLE * RADIUS**2 * 2 / 5  # wheels turn with it
STIFF, DULL = 5e7, 5e4  # contacts, guides [N/m], [N s/m]


class Ramp:
    def __init__(self, dashpot):
        self.dashpot = dashpot
        long = LENGTH - 2 * GAP
        self.inertia = MASS * ((long**2 + THICK**2) / 12 + (LENGTH / 2) ** 2)
        self.turn = self.rate = self.plastic = self.travel = self.work = 0.0

    def moment(self, dt):
        elastic = self.turn - self.plastic
        moment = SPRING * elastic + self.dashpot * self.rate
        if abs(moment) > MOMENT:  # spring and dashpot together carry no more: the rest flows
            moment = math.copysign(MOMENT, moment)
            flow = (self.rate - (moment - SPRING * elastic) / self.dashpot) * dt
            self.plastic += flow
            self.travel += abs(flow)
            self.work += moment * flow
        return moment

    def step(self, dt, outer):
        load = MASS * GRAVITY * LENGTH / 2 * math.cos(self.turn) + outer
        tip = PIVOT[1] - (LENGTH - GAP) * math.sin(self.turn) - THICK / 2 * math.cos(self.turn)
        if tip < 0:  # on the ground
            speed = -(LENGTH - GAP) * math.cos(self.turn) * self.rate
            load -= max(0.0, -STIFF * tip - DULL * speed) * (LENGTH - GAP) * math.cos(self.turn)
        self.rate += (load - self.moment(dt)) / self.inertia * dt
        self.turn += self.rate * dt


class Car:
    """Chassis x, z, pitch, then the two axles x, z: places and speeds."""

    def __init__(self, x, speed, dashpot):
        z = PAD[1] + RADIUS
        self.dashpot = dashpot
        self.chassis, self.speed = [x, z + HEIGHT, 0.0], [speed, 0.0, 0.0]
        self.axles = [[x - BASE, z], [x + BASE, z]]
        self.speeds = [[speed, 0.0], [speed, 0.0]]

    def touch(self, at, speed, ramp):
        """Force on a wheel, and its moment on the ramp, which turns clockwise about its pivot."""
        c, s = math.cos(ramp.turn), math.sin(ramp.turn)
        top = lambda along: (PIVOT[0] - along * c - THICK / 2 * s, PIVOT[1] - along * s + THICK / 2 * c)
        force, moment = [0.0, 0.0], 0.0
        for on_ramp, a, b in ((0, (-60.0, PAD[1]), PAD), (1, top(LENGTH - GAP), top(GAP)),
                              (0, (PIVOT[0], PIVOT[1] + THICK / 2), (400.0, PIVOT[1] + THICK / 2))):
            ux, uz = b[0] - a[0], b[1] - a[1]
            share = ((at[0] - a[0]) * ux + (at[1] - a[1]) * uz) / (ux * ux + uz * uz)
            share = min(1.0, max(0.0, share))
            px, pz = a[0] + share * ux, a[1] + share * uz
            nx, nz = at[0] - px, at[1] - pz
            far = math.hypot(nx, nz)
            if far >= RADIUS:
                continue
            nx, nz = nx / far, nz / far
            rx, rz = px - PIVOT[0], pz - PIVOT[1]
            vx, vz = (-ramp.rate * -rz, ramp.rate * rx) if on_ramp else (0.0, 0.0)
            closing = (speed[0] - vx) * nx + (speed[1] - vz) * nz
            push = max(0.0, STIFF * (RADIUS - far) - DULL * closing)
            force[0] += push * nx
            force[1] += push * nz
            if on_ramp:  # the ramp's turn moves a point at (rx, rz) by (rz, rx) a radian
                moment -= push * (nx * rz + nz * rx)
        return force, moment

    def step(self, dt, ramp):
        x, z, pitch = self.chassis
        c, s = math.cos(pitch), math.sin(pitch)
        pull = [0.0, -CHASSIS * GRAVITY, 0.0]
        outer = 0.0
        for at, speed, side in zip(self.axles, self.speeds, (-BASE, BASE)):
            # the strut's foot in the chassis; along its x guided, along its z sprung
            dx, dz = at[0] - x, at[1] - z
            along, up = dx * c + dz * s - side, -dx * s + dz * c + HEIGHT
            wx, wz = speed[0] - self.speed[0] + self.speed[2] * dz, speed[1] - self.speed[1] - self.speed[2] * dx
            guided = -STIFF / 10 * along - DULL / 10 * (wx * c + wz * s)
            sprung = -STRUT * up - self.dashpot * (-wx * s + wz * c)
            fx, fz = guided * c - sprung * s, guided * s + sprung * c
            force, moment = self.touch(at, speed, ramp)
            outer += moment
            speed[0] += (fx + force[0]) / AXLE * dt
            speed[1] += ((fz + force[1]) / AXLE - GRAVITY) * dt
            pull[0] -= fx
            pull[1] -= fz
            pull[2] -= dx * fz - dz * fx
        for i, m in enumerate((CHASSIS, CHASSIS, CHASSIS_INERTIA)):
            self.speed[i] += pull[i] / m * dt
            self.chassis[i] += self.speed[i] * dt
        for at, speed in zip(self.axles, self.speeds):
            at[0] += speed[0] * dt
            at[1] += speed[1] * dt
        return outer


def run(dt, speeds, share):
    """`share`: of the dashpots."""
    ramp = Ramp(max(share * DASHPOT, 100.0))
    for _ in range(round(10 / dt)):
        ramp.step(dt, 0.0)
    print(f"own weight: {100 * ramp.travel / LIFE:.2f} % of {LIFE} rad, {ramp.work:.1f} J, turn {ramp.turn:.5f} rad")
    for number, speed in enumerate(speeds):
        before, work = ramp.travel, ramp.work
        car = Car(PAD[0] - 2 - 6 * number, speed, share * STRUT_DASHPOT)
        car.chassis[1] -= CHASSIS * GRAVITY / 2 / STRUT  # as it stands
        landed = None
        for i in range(round(4 / dt)):
            outer = car.step(dt, ramp)
            ramp.step(dt, outer)
            if landed is None and outer > 0:
                landed = (i * dt, car.axles[1][0])
        print(f"{speed} m/s: lands at {landed[1]:.2f} m after {landed[0]:.3f} s, {100 * (ramp.travel - before) / LIFE:.2f} %, "
            f"{ramp.work - work:.0f} J, turn {ramp.turn:.5f} rad, car at {car.chassis[0]:.2f} m, {car.speed[0]:.3f} m/s")


if __name__ == "__main__":
    for share in (1.0, 0.0):
        print("with dashpots" if share > 0 else "without")
        run(float(sys.argv[1]) if len(sys.argv) > 1 else 2e-5, [9.86, 13.72, 13.72], share)
