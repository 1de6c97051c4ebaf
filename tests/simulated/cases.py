"""Cases with a known truth: a defect, a motion, a load, a sensor and its faults, simulated.

The simulation integrates at a step of its own, several times finer than the estimator's, takes the true motion where
the estimator sees joint states interpolated, and adds what the estimator does not model (speed ripple, motor ripple,
coloured noise, spikes, loss).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.signal import lfilter

from hd_monitor.acquisition.motion import MotionTrack
from hd_monitor.acquisition.record import Record
from hd_monitor.acquisition.screening import screen
from hd_monitor.arrays import FloatArray
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.model import (
    Oscillator,
    ParametricModel,
    gauss_times,
)
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings

WARN = 0.05
BOTH_RATIO = 0.87
FINE = 2e-4  # s, longest step of the simulation
MOTIONS = ("dwell", "ripple", "strokes", "run_up", "steps")
"""Constant speed; constant with speed ripple; there and back; a slow run-up; a staircase of speeds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One case.

    Attributes
    ----------
    model : ParametricModel
        The truth. Its torque is the one that acts; `measured` says whether joint states tell it.
    motion : str
        One of `MOTIONS`.
    speed : float
        Wave-generator speed [rpm]: of the dwell, the strokes, the middle of the run-up.
    span : float
        Arc of the strokes [rad].
    duration : float
        [s]
    snr : float
        [dB]
    colour : str
        ``white``, ``red`` or ``hum`` (a machine's tones beside white noise).
    spikes, lost : float
        Parts of the samples that are spikes, or missing.
    measured : bool
        Whether the torque is in the joint states.
    rate : float
        [Hz]
    seed : int
        Of noise and faults.
    """

    model: ParametricModel
    motion: str = "dwell"
    speed: float = 1000.0
    span: float = math.radians(120.0)
    duration: float = 12.0
    snr: float = 20.0
    colour: str = "white"
    spikes: float = 0.0
    lost: float = 0.0
    measured: bool = False
    rate: float = 1000.0
    seed: int = 1

    @property
    def index(self) -> LinePair:
        """True indexes."""
        return LinePair(self.model.circular_spline.index, self.model.flexspline.index)

    @property
    def truth(self) -> Component:
        """Component that the rule of the interface names for the true indexes."""
        smaller, larger = sorted(self.index)
        if larger < WARN:
            return Component.NONE
        if smaller >= WARN and smaller >= BOTH_RATIO * larger:
            return Component.BOTH
        return Component.CIRCULAR_SPLINE if self.index.circular_spline == larger else Component.FLEXSPLINE

    def settings(self, **changes: object) -> JointSettings:
        """Return parameters as a careful user would set them who knows the torque, measured or not."""
        reducer, dynamics = self.model.reducer, self.model.dynamics
        return JointSettings.from_mapping(
            {
                "reducer.flexspline_teeth": reducer.flexspline_teeth,
                "reducer.circular_spline_teeth": reducer.circular_spline_teeth,
                "reducer.mount": reducer.mount.value,
                "dynamics.natural_frequency": dynamics.natural_frequency,
                "dynamics.damping_ratio": dynamics.damping_ratio,
                "dynamics.inertia": dynamics.inertia,
                "load.torque": self.model.torque.mean,
                "load.assumed_uncertainty": 0.1,
                "reducer.transmission_error": 0.0,
            }
            | changes
        )


def output_speed(case: Case, rpm: float | None = None) -> float:
    """Output speed [rad/s] at a wave-generator speed [rpm], the case's own by default."""
    return (case.speed if rpm is None else rpm) * math.tau / 60.0 / case.model.reducer.reduction


def _velocity(case: Case, times: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Output speed [rad/s] at `times` [s]."""
    omega = output_speed(case)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    if case.motion == "dwell":
        return np.full(times.shape, sign * omega)
    if case.motion == "ripple":
        depth, rate = rng.uniform(0.002, 0.02), rng.uniform(0.2, 2.0)
        return np.asarray(sign * omega * (1.0 + depth * np.sin(math.tau * rate * times + rng.uniform(0.0, 6.0))))
    if case.motion == "strokes":
        ramp = max(0.15, 0.05 * case.span / omega)
        whole = case.span / omega
        knots = np.cumsum([0.0, ramp / 2, whole, ramp, whole, ramp / 2])
        levels = np.array([0.0, 1.0, 1.0, -1.0, -1.0, 0.0])
        return np.asarray(sign * omega * np.interp(np.mod(times, knots[-1]), knots, levels))
    if case.motion == "run_up":
        return np.asarray(sign * omega * (0.6 + 0.8 * times / case.duration))
    levels = np.array([0.7, 0.85, 1.0, 1.15])
    place = times / case.duration * levels.size
    step = np.minimum(place.astype(int), levels.size - 1)
    ramp = np.clip((place - step) / 0.08, 0.0, 1.0)
    before = levels[np.maximum(step - 1, 0)]
    return np.asarray(sign * omega * (before + ramp * (levels[step] - before)))


def simulate(case: Case) -> list[Record]:
    """Simulate a case: its records of a second each, as acquisition hands them over."""
    rng = np.random.default_rng(case.seed)
    model, dynamics = case.model, case.model.dynamics
    count = int(case.duration * case.rate)
    fine = math.ceil(1.0 / case.rate / FINE)
    step = 1.0 / case.rate / fine
    # Motion on half steps, so that its cubic through the steps' ends is exact to the fourth order
    times = np.arange((count + 1) * fine + 1, dtype=np.float64) * step
    half = np.arange(2 * (times.size - 1) + 1, dtype=np.float64) * step / 2.0
    v_half = _velocity(case, half, rng)
    v = v_half[::2]
    q = rng.uniform(-3.0, 3.0) + np.concatenate(
        [[0.0], np.cumsum((v_half[:-2:2] + 4.0 * v_half[1::2] + v_half[2::2]) * step / 6.0)]
    )
    path = CubicHermiteSpline(times, q, v)
    gauss = gauss_times(times)
    q_gauss = path(gauss)
    oscillator = Oscillator(dynamics, model.stiffness_fluctuation(q_gauss), step)
    torque = model.torque_at(q)
    response = oscillator.respond(
        model.torque_at(q_gauss) / dynamics.inertia, initial=(torque[0] / dynamics.stiffness, 0.0)
    )
    acceleration = model.acceleration(q, response.displacement, response.velocity)
    return _measure(case, rng, times, path, torque, acceleration[::fine][:count])


def _measure(
    case: Case,
    rng: np.random.Generator,
    times: FloatArray,
    path: CubicHermiteSpline,
    torque: FloatArray,
    acceleration: FloatArray,
) -> list[Record]:
    sampling = np.arange(acceleration.size) / case.rate
    level = float(np.std(acceleration)) * 10.0 ** (-case.snr / 20.0)
    noise = rng.standard_normal(acceleration.size)
    if case.colour == "red":
        noise = lfilter([1.0], [1.0, -0.85], noise)
        noise /= np.std(noise)
    elif case.colour == "hum":
        for frequency in rng.uniform(5.0, 400.0, 3):
            noise = noise + 1.5 * np.cos(math.tau * frequency * sampling + rng.uniform(0.0, 6.0))
        noise /= np.std(noise)
    values = acceleration + level * noise
    hit = rng.random(values.size) < case.spikes
    values[hit] += rng.choice([-1.0, 1.0], int(hit.sum())) * rng.uniform(20.0, 200.0, int(hit.sum())) * level
    values[rng.random(values.size) < case.lost] = np.nan
    present = np.isfinite(values)
    values[present] = screen(values[present]).values
    joint = np.arange(0.0, times[-1], 0.008)
    rows = np.column_stack(
        [
            path(joint) + 2e-6 * rng.standard_normal(joint.size),
            path(joint, 1) + 1e-4 * rng.standard_normal(joint.size),
            np.interp(joint, times, torque) if case.measured else np.full(joint.size, np.nan),
        ]
    )
    track = MotionTrack()
    track.extend(joint, rows)
    motion = track.at(sampling)
    chunk = int(case.rate)
    return [
        Record(
            start=float(sampling[first]),
            period=1.0 / case.rate,
            acceleration=values[first : first + chunk],
            angle=motion.angle[first : first + chunk],
            speed=motion.speed[first : first + chunk],
            torque=motion.torque[first : first + chunk],
            continues=first > 0,
        )
        for first in range(0, values.size - chunk + 1, chunk)
    ]
