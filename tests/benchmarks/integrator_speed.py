"""How fast is the simulator? Prints its integrators against generic solvers, and each stage as a multiple of real time.

    python tests/benchmarks/integrator_speed.py

Every figure is a ratio or a rate of this run. Integrators are compared at equal error: each with the coarsest step or
the loosest tolerance that keeps θ'' within 1e-5 of its peak to peak. scipy's solvers get the equation of motion in
plain Python numbers, the fastest form for them.
"""

import math
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Literal
from unittest import mock

from hd_monitor.process import set_up_process

set_up_process()  # as every program of this project: one thread for linear algebra

import numpy as np
from scipy.integrate import solve_ivp

from hd_monitor.arrays import FloatArray
from hd_monitor.errors import ParameterError
from hd_monitor.model import Oscillator, ParametricModel, StiffnessSeries, gauss_times
from hd_sim_node.drive import rig as rig_module
from hd_sim_node.drive.effects import Effects
from hd_sim_node.drive.elasticity import Elasticity, Hysteresis
from hd_sim_node.drive.friction import Friction
from hd_sim_node.drive.rig import Rig, advance_together
from hd_sim_node.drive.transmission_error import ErrorSeries, TransmissionErrors
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.hd_sim_node.drive import plain

Solver = Literal["RK45", "DOP853", "LSODA"]

MODEL = ParametricModel(
    flexspline=StiffnessSeries((0.06, 0.03, 0.02)),
    circular_spline=StiffnessSeries((0.03, 0.015, 0.01), (0.7, 1.4, 2.1)),
)
BETAS = {"beta1": ((0.06, 0.03, 0.02), (0.0, 0.0, 0.0)), "beta2": ((0.03, 0.015, 0.01), (0.7, 1.4, 2.1))}
ERROR = ErrorSeries((0.5, 0.2, 0.1))
EFFECTS = Effects(
    errors=TransmissionErrors(flexspline=ERROR, circular_spline=ERROR, wave_generator=ERROR),
    elasticity=Elasticity(ratios=(0.8, 1.0, 1.2), torques=(4.0, 12.0)),
    hysteresis=Hysteresis(torque=0.5),
    friction=Friction(coulomb=1.0, stribeck=0.5, viscous=0.4),
)
PLAIN = {
    **dict.fromkeys(("e0", "e1", "e2"), ((0.5, 0.2, 0.1), (0.0, 0.0, 0.0))),
    "ratios": (0.8, 1.0, 1.2),
    "corners": (4.0, 12.0),
    "loop": (0.5, 1.0),
    "coulomb": 1.0,
    "stribeck": (0.5, 0.05),
    "viscous": 0.4,
}
SPEED_RPM, RATE, SECONDS, ALLOWED = 850.0, 1000.0, 1.0, 1e-5
TIMES = np.arange(round(SECONDS * RATE)) / RATE
OMEGA = SPEED_RPM * math.tau / 60.0 / MODEL.reducer.reduction
PROGRAMME = SpeedProgramme(times=[0.0, 1.0], speeds=[SPEED_RPM, SPEED_RPM])
STEPS = [2.0 ** (-step / 4) for step in range(-10, 15)]
"""Factors on the lengths of the steps, from coarse to fine."""
TOLERANCES = [10.0 ** (-step / 4) for step in range(14, 44)]
SOLVERS: tuple[Solver, ...] = ("RK45", "DOP853", "LSODA")
TOGETHER = 1000
_FINEST, _COMMON = 50_400, 5040
"""Steps per second of the scan taken for exact, and how many of them lie between the instants compared."""


def cpu(work: Callable[[], object], *, runs: int = 3, least: float = 0.1) -> float:
    """CPU time [s] of the work, the shortest of several runs' means: what other processes do should not count."""
    best, repeat = math.inf, 1
    for _ in range(runs):
        begun = time.process_time()
        for _ in range(repeat):
            work()
        best = min(best, (time.process_time() - begun) / repeat)
        repeat = max(repeat, math.ceil(least / max(best, 1e-6)))
    return best


def coarsest[T](choices: Iterable[T], run: Callable[[T], FloatArray], truth: FloatArray) -> tuple[T, float]:
    """Find the first of the choices, from coarse to fine, that meets the error allowed; return it and its error."""
    for choice in choices:
        try:
            error = float(np.abs(run(choice) - truth).max() / np.ptp(truth))
        except ParameterError:  # a step that does not resolve the oscillation
            continue
        if error <= ALLOWED:
            return choice, error
    raise RuntimeError(f"no choice keeps the error below {ALLOWED:g}")


def scan(rate: float, seconds: float = SECONDS) -> FloatArray:
    """Displacement [rad] of the linear drive at `rate` [Hz] by the scan, one step a sample."""
    times = np.arange(round(seconds * rate) + 1) / rate
    angle = OMEGA * gauss_times(times)
    oscillator = Oscillator(MODEL.dynamics, MODEL.stiffness_fluctuation(angle), 1.0 / rate)
    start = (float(MODEL.static_deflection(0.0)), 0.0)
    return oscillator.respond(MODEL.torque_at(angle) / MODEL.dynamics.inertia, start).displacement


@contextmanager
def steps_scaled(factor: float) -> Iterator[None]:
    """Lengthen the rig's steps by a factor."""
    with ExitStack() as stack:
        for name in ("PHASE_STEP", "MARCH_NATURAL", "MARCH_FORCED", "MARCH_FRICTION"):
            stack.enter_context(mock.patch.object(rig_module, name, factor * getattr(rig_module, name)))
        yield


def drive(effects: Effects, factor: float, drives: int = 1) -> FloatArray:
    """θ'' of a rig, or of the first of several that turn together from different angles, a quarter second at a time."""
    with steps_scaled(factor):
        rigs = [Rig(MODEL, PROGRAMME, rate=RATE, start_angle=0.01 * n, effects=effects) for n in range(drives)]
        chunks = [advance_together(rigs, TIMES.size // 4)[0].acceleration for _ in range(4)]
    return np.concatenate(chunks)


def generic(given: dict[str, Any], method: Solver, tolerance: float) -> tuple[FloatArray, Callable[[], FloatArray]]:
    """θ'' by one of scipy's solvers, and its work alone, which returns the states."""
    slope, start = plain.equation(lambda t: OMEGA * t, lambda t: OMEGA, **(BETAS | given))

    def solve() -> FloatArray:
        end = float(TIMES[-1])
        return np.asarray(solve_ivp(slope, (0.0, end), start, method, TIMES, rtol=tolerance, atol=1e-4 * tolerance).y)

    return np.array([slope(t, state)[1] for t, state in zip(TIMES, solve().T, strict=True)]), solve


def show(ours: dict[str, tuple[float, str]], given: dict[str, Any], truth: FloatArray) -> None:
    """Print our integrators, (CPU a simulated second [s], remark) by name, and scipy's as multiples of them."""
    print(f"  {'':30}{'CPU a second':>14}" + "".join(f"{name:>22}" for name in ours))
    for name, (taken, remark) in ours.items():
        print(f"  {name:30}{1e3 * taken:11.3g} ms  {remark}")
    for method in SOLVERS:
        tolerance, error = coarsest(TOLERANCES, lambda tolerance: generic(given, method, tolerance)[0], truth)  # noqa: B023
        theirs = cpu(generic(given, method, tolerance)[1], runs=2) / SECONDS
        ratios = "".join(f"{theirs / taken:20.0f} x" for taken, _ in ours.values())
        print(
            f"  {f'solve_ivp {method} {tolerance:.0e}':30}{1e3 * theirs:11.3g} ms{ratios}   error {error:.1e}",
            flush=True,
        )


def compare_linear() -> None:
    """Print the scan, alone and in the rig, against generic solvers."""
    print(f"a linear drive at {SPEED_RPM:g} rpm, error {ALLOWED:g}; the columns say how many times faster we are")
    parts = [n for n in range(50, 9, -1) if _FINEST % n == 0]
    fine = scan(float(_FINEST))
    every, error = coarsest(parts, lambda n: scan(_FINEST / n)[:: _COMMON // n], fine[::_COMMON])
    rate = _FINEST / every
    long = 60.0
    alone = cpu(lambda: scan(rate, long)) / long
    truth = drive(Effects(), STEPS[-1])
    factor, rig_error = coarsest(STEPS, lambda factor: drive(Effects(), factor), truth)
    rig = cpu(lambda: drive(Effects(), factor)) / SECONDS
    show({"scan": (alone, f"{rate:g} steps, error {error:.1e}"), "rig": (rig, f"error {rig_error:.1e}")}, {}, truth)


def compare_real() -> None:
    """Print the rig with all effects, alone and many at once, against generic solvers."""
    print(f"\na drive with all effects at {SPEED_RPM:g} rpm, error {ALLOWED:g}")
    truth = drive(EFFECTS, STEPS[-1])
    factor, error = coarsest(STEPS, lambda factor: drive(EFFECTS, factor), truth)
    alone = cpu(lambda: drive(EFFECTS, factor)) / SECONDS
    together = cpu(lambda: drive(EFFECTS, factor, TOGETHER), runs=1) / SECONDS / TOGETHER
    name = f"each of {TOGETHER}"
    show({"one rig": (alone, f"error {error:.1e}"), name: (together, "")}, PLAIN, truth)
    print(f"  {TOGETHER} rigs at once are {alone / together:.1f} times as fast as a loop over them")


def time_stages() -> None:
    """Each stage of the simulator over its default programme, 2 kHz in blocks, as a multiple of real time."""
    settings = RigSettings.from_mapping({"cycles": 1, "sensor.rate": RATE})
    seconds = settings.duration
    print(f"\nstages over {seconds:g} s of the default programme at {RATE:g} Hz, times real time")
    programme = SpeedProgramme(times=settings.programme.times, speeds=settings.programme.speeds, cycles=1)

    def rig() -> None:
        source = Rig(settings.model, programme, rate=RATE)
        for _ in range(round(seconds * 4)):
            source.advance(round(RATE / 4))

    def simulate() -> None:
        for stretch in Simulation(settings):
            for _ in stretch.schedule():
                pass

    report("motion (rig.advance)", seconds, rig)
    report("all messages as arrays", seconds, simulate)
    try:
        from hd_sim_node.bag import write_bag
    except ModuleNotFoundError:
        print("  (no bags: rosbags is not installed)")
        return
    samples = RigSettings.from_mapping({"cycles": 1, "sensor.rate": 1000.0, "publish": "samples"})
    with tempfile.TemporaryDirectory() as folder:
        for name, contents in (("bag of blocks", settings), ("bag of single samples at 1 kHz", samples)):
            report(name, seconds, lambda: write_bag(contents, Path(folder) / str(time.monotonic_ns())))  # noqa: B023


def report(name: str, seconds: float, work: Callable[[], object]) -> None:
    """Time a stage and print it."""
    print(f"  {name:36}{seconds / cpu(work, runs=2, least=0.0):8.0f}", flush=True)


if __name__ == "__main__":
    compare_linear()
    compare_real()
    time_stages()
