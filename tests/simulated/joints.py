"""A robot joint as its driver reports it, with a known truth: motion, friction, gravity, lines, noise, uneven stamps.

Independent of the estimator: nothing here knows of strokes, whitening or splines.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.arrays import FloatArray
from hd_monitor.reducer import LinePair, Mount, Reducer
from hd_monitor.settings import JointSettings

MOTIONS = ("harmonics", "strokes", "rotation")
"""A Fourier series as in robot identification; there and back between two ends; turning on with changing speed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JointCase:
    """One random joint.

    Attributes
    ----------
    reducer : Reducer
    motion : str
        One of `MOTIONS`.
    span : float
        Arc of the motion [rad] (one revolution a turn for a rotation).
    top_speed : float
        Output speed [rad/s].
    duration, rate : float
        [s], [Hz]
    lines : tuple of LinePair
        Line amplitudes [A] of the forward and the reverse direction.
    noise : float
        Standard deviation of the current's noise [A].
    redness : float
        Its autoregression coefficient, 0 for white.
    lost, spikes : float
        Parts of the messages that are missing, or carry a spike.
    speed_dependence : float
        Part by which the lines' amplitudes change over the speed range.
    lag : float
        Delay of the current behind the position of the same message [s].
    seed : int
    following : float
        Part of the lines' power that follows the torque behind the friction, from 0 to 1.
    """

    reducer: Reducer
    motion: str
    span: float
    top_speed: float
    duration: float
    rate: float
    lines: tuple[LinePair, LinePair]
    noise: float
    redness: float
    lost: float
    spikes: float
    speed_dependence: float
    lag: float
    seed: int
    following: float = 0.0

    def settings(self, **changes: object) -> JointSettings:
        """Return the parameters of a monitor for this joint."""
        return JointSettings.from_mapping(
            {
                "reducer.flexspline_teeth": self.reducer.flexspline_teeth,
                "reducer.circular_spline_teeth": self.reducer.circular_spline_teeth,
                "reducer.mount": self.reducer.mount.value,
                "input.source": "joint_effort",
            }
            | changes
        )


def random_joint(rng: np.random.Generator, lines: LinePair, **fixed: object) -> JointCase:
    """Draw a joint whose lines have these mean amplitudes, in units of the noise's standard deviation.

    The two directions differ in size, by up to a third either way and for both lines alike, as friction makes them do.
    """
    z1 = int(rng.choice([100, 160, 200, 240]))
    mount = Mount.FLEXSPLINE_FIXED if rng.random() < 0.5 else Mount.CIRCULAR_SPLINE_FIXED
    noise = float(rng.choice([0.03, 0.1, 0.3]))
    sides = 1.0 + rng.uniform(0.0, 0.33) * np.array([1.0, -1.0])
    rate = float(rng.choice([100.0, 125.0, 250.0, 500.0, 1000.0]))
    values: dict[str, object] = {
        "reducer": Reducer(flexspline_teeth=z1, circular_spline_teeth=z1 + 2, mount=mount),
        "motion": str(rng.choice(MOTIONS)),
        "span": float(rng.uniform(math.radians(100.0), math.radians(330.0))),
        "top_speed": float(rng.uniform(0.6, 1.8)) * 160.0 / z1,
        "duration": 60.0,
        "rate": rate,
        "lines": tuple(LinePair(*(noise * side * np.array(lines)).tolist()) for side in sides),
        "noise": noise,
        "redness": float(rng.choice([0.0, 0.5, 0.9])),
        "lost": float(rng.choice([0.0, 0.02])),
        "spikes": float(rng.choice([0.0, 0.002])),
        "speed_dependence": float(rng.uniform(0.0, 0.3)),
        "lag": float(rng.uniform(0.0, 0.004)),
        "seed": int(rng.integers(2**31)),
    }
    return JointCase(**(values | fixed))  # type: ignore[arg-type]


def simulate_joint(case: JointCase) -> JointSamples:
    """Joint states of a case, the effort being a motor current [A]."""
    rng = np.random.default_rng(case.seed)
    true = np.arange(0.0, case.duration, 1.0 / case.rate)
    angle, speed, acceleration = _motion(case, rng, true)
    forward = speed > 0.0
    current = 3.0 * np.sin(angle + 0.4) + 0.8 * np.sin(2.0 * angle + 1.3) + 1.5 * acceleration
    torque = current / math.sqrt(float(np.mean(current**2)))
    current = current + np.tanh(speed / 0.02) * (1.5 + 0.7 * np.exp(-np.abs(speed) / 0.1)) + 0.8 * speed
    reducer = case.reducer
    # The motor's ripple, once a turn of its shaft, and the lines.
    lag = angle - case.lag * speed
    current += case.noise * rng.uniform(0.0, 0.5) * np.cos(reducer.reduction * lag + rng.uniform(0.0, 6.0))
    growth = 1.0 + case.speed_dependence * (np.abs(speed) / case.top_speed - 0.5)
    for pair, side in zip(case.lines, (forward, ~forward), strict=True):
        for amplitude, order in zip(pair, reducer.output_orders, strict=True):
            size, phase = side * growth * amplitude, order * lag + rng.uniform(0.0, math.tau)
            current += size * math.sqrt(1.0 - case.following) * np.cos(phase)
            current += size * math.sqrt(case.following) * torque * np.cos(phase + 1.0)
    white = rng.standard_normal(true.size) * math.sqrt(1.0 - case.redness**2)
    current += case.noise * lfilter([1.0], [1.0, -case.redness], white)
    spikes = rng.random(true.size) < case.spikes
    current += spikes * rng.choice([-1.0, 1.0], true.size) * 20.0 * case.noise
    # The driver: positions in steps of 1e-4 rad, stamps in whole milliseconds and late now and then.
    stamps = np.floor(1e3 * (true + rng.exponential(0.0005, true.size))) / 1e3
    stamps = np.maximum.accumulate(stamps)
    kept = (rng.random(true.size) >= case.lost) & (np.diff(stamps, prepend=-1.0) > 0.0)
    return JointSamples(
        times=stamps[kept],
        angle=np.round(angle[kept], 4),
        speed=np.round(speed[kept], 4),
        effort=current[kept],
    )


def _motion(case: JointCase, rng: np.random.Generator, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Output angle [rad], speed [rad/s] and acceleration [rad/s²]."""
    if case.motion == "harmonics":
        base = 0.05 * math.tau
        angle, speed, acceleration = np.zeros(times.size), np.zeros(times.size), np.zeros(times.size)
        for k in range(1, 6):
            a, p = rng.standard_normal() / k, rng.uniform(0.0, math.tau)
            w = k * base
            angle += a * np.sin(w * times + p)
            speed += a * w * np.cos(w * times + p)
            acceleration -= a * w * w * np.sin(w * times + p)
        scale = min(case.span / np.ptp(angle), case.top_speed / np.abs(speed).max())
        return scale * angle, scale * speed, scale * acceleration
    if case.motion == "rotation":
        w = math.tau * 0.03
        mean, swing = 0.6 * case.top_speed, 0.4 * case.top_speed
        speed = mean + swing * np.sin(w * times)
        return mean * times - swing / w * np.cos(w * times), speed, swing * w * np.cos(w * times)
    # Strokes: trapezoids of different speeds, ramps of a third of a second.
    knots, levels, at, sign = [0.0], [0.0], 0.0, 1.0
    while at < times[-1]:
        level = case.top_speed * rng.uniform(0.5, 1.0)
        plateau = max(case.span / level - 0.33, 0.1)
        for wait, value in ((0.33, level), (plateau, level), (0.33, 0.0), (0.2, 0.0)):
            at += wait
            knots.append(at)
            levels.append(sign * value)
        sign = -sign
    speed = np.interp(times, knots, levels)
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times))])
    return angle, speed, np.gradient(speed, times)
