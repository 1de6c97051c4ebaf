"""The drive's equation of motion written out once more, in plain numbers and for a generic solver."""

import math
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp

ARCMIN = math.pi / 180 / 60
NOTHING = {
    "beta1": ((), ()),  # flexspline: amplitudes, phases
    "beta2": ((), ()),
    "e1": ((), ()),  # arcmin peak to peak, phases
    "e2": ((), ()),
    "e0": ((), ()),  # wave generator
    "ratios": (1.0, 1.0, 1.0),
    "corners": (5.0, 20.0),  # N·m
    "loop": (0.0, 1.0),  # N·m, arcmin
    "coulomb": 0.0,
    "stribeck": (0.0, 0.05),
    "creep": 0.01,
    "viscous": 0.0,
    "drift": (0.0, 0.0, 0.0, 600.0),  # natural frequency, damping ratio, friction, s
    "growth": (1.0, 1.0, 0.0, 60.0),  # flexspline, circular spline, start and length in s
    "fn": 55.0,
    "zeta": 0.023,
    "inertia": 0.29,
    "load": lambda t, q: 10.0,
    "inertia_factor": lambda t: 1.0,
}


def equation(q, speed, **given):
    """The right-hand side for (θ, θ', z) of a 160/162 drive with a fixed circular spline along q(t), and the start."""
    p = SimpleNamespace(**(NOTHING | given))
    j0, omega = p.inertia, 2 * math.pi * p.fn
    k0, (k1, k2, k3) = j0 * omega**2, p.ratios
    t1, t2 = p.corners
    corner1 = t1 / (k1 * k0)
    corner2 = corner1 + (t2 - t1) / (k2 * k0)
    loop, length = p.loop[0], p.loop[1] * ARCMIN
    fs, cs, growth_start, growth_length = p.growth

    def series(terms, order, angle):
        return sum(b * math.cos(i * order * angle + f) for i, (b, f) in enumerate(zip(*terms, strict=True), 1))

    def slope_of(terms, order, angle):
        pairs = enumerate(zip(*terms, strict=True), 1)
        return sum(-b * i * order * math.sin(i * order * angle + f) for i, (b, f) in pairs)

    def step_up(x, width):  # max(x, 0), rounded
        return 0.5 * (x + math.sqrt(x * x + width * width))

    def elastic(u):
        def both(corner):
            return step_up(u - corner, 0.1 * corner) - step_up(-u - corner, 0.1 * corner)

        return k1 * u + (k2 - k1) * both(corner1) + (k3 - k2) * both(corner2)

    def friction(v):
        sliding = p.coulomb + p.stribeck[0] / (1 + (v / p.stribeck[1]) ** 2)
        return sliding * v / math.hypot(v, p.creep) + p.viscous * v

    def parts(t):
        angle, rate = q(t), speed(t)
        warm = 1 - math.exp(-t / p.drift[3])
        share = min(1.0, max(0.0, (t - growth_start) / growth_length))
        moving = growth_start <= t < growth_start + growth_length
        g1, g2 = 1 + (fs - 1) * share, 1 + (cs - 1) * share
        r1, r2 = ((f - 1) / growth_length if moving else 0.0 for f in (fs, cs))
        half = ARCMIN / 2
        k = g1 * series(p.beta1, 162, angle) + g2 * series(p.beta2, 160, angle)
        e1, e2, e0 = series(p.e1, 162, angle), series(p.e2, 160, angle), series(p.e0, 80, angle)
        e = half * (g1 * e1 + g2 * e2 + e0)
        turning = g1 * slope_of(p.e1, 162, angle) + g2 * slope_of(p.e2, 160, angle) + slope_of(p.e0, 80, angle)
        de = half * (turning * rate + r1 * e1 + r2 * e2)
        stiffness = k0 * (1 + p.drift[0] * warm) ** 2
        damping = 2 * p.zeta * omega * j0 * (1 + p.drift[1] * warm) * (1 + p.drift[0] * warm)
        return angle, rate, k, e, de, stiffness, damping, 1 + p.drift[2] * warm

    def slope(t, state):
        x, v, z = state
        angle, rate, k, e, de, stiffness, damping, rubbing = parts(t)
        twist_rate = v + de
        torque = p.load(t, angle) - rubbing * friction(rate + v)
        torque -= damping * twist_rate + stiffness * (1 + k) * elastic(x + e) + loop * z
        return v, torque / (j0 * p.inertia_factor(t)), (twist_rate - abs(twist_rate) * z) / length

    angle, rate, k, e, _, stiffness, _, _ = parts(0.0)
    level = (p.load(0.0, angle) - friction(rate)) / (stiffness * (1 + k))
    low, high = -1.0, 1.0
    for _ in range(100):  # bisection
        middle = 0.5 * (low + high)
        low, high = (middle, high) if elastic(middle) < level else (low, middle)
    return slope, (low - e, 0.0, 0.0)


def solve(q, speed, times, *, method="DOP853", tolerance=1e-10, longest=2e-4, **given):
    """θ, θ' and θ'' at `times` by one of scipy's solvers."""
    slope, start = equation(q, speed, **given)
    found = solve_ivp(
        slope, (0.0, times[-1]), start, method, times, rtol=tolerance, atol=1e-4 * tolerance, max_step=longest
    ).y
    acceleration = np.array([slope(t, state)[1] for t, state in zip(times, found.T, strict=True)])
    return found[0], found[1], acceleration
