"""How fast is the simulator? Prints its integrator against generic solvers, and each stage as a multiple of real time.

Run it from anywhere: ``python tests/benchmarks/integrator_speed.py``. Every figure is a ratio or a rate of this run.
"""

import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from hd_monitor.model import Oscillator, ParametricModel, StiffnessSeries, gauss_times
from hd_sim_node.drive.rig import Rig
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

MODEL = ParametricModel(
    flexspline=StiffnessSeries((0.06, 0.03, 0.02)),
    circular_spline=StiffnessSeries((0.03, 0.015, 0.01), (0.7, 1.4, 2.1)),
)
Solver = Literal["RK45", "DOP853", "LSODA"]
SPEED_RPM = 850.0
RATE = 2000.0
OMEGA = SPEED_RPM * 2.0 * np.pi / 60.0 / MODEL.reducer.reduction


def best_of(runs: int, work: Callable[[], object]) -> float:
    """Shortest CPU time [s] of some runs: what other processes do should not count."""
    times = []
    for _ in range(runs):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


def scan(seconds: float, rate: float) -> np.ndarray:
    """Displacement [rad] at `rate` by the Magnus-4 scan, one step a sample."""
    times = np.arange(round(seconds * rate) + 1) / rate
    angle = OMEGA * gauss_times(times)
    oscillator = Oscillator(MODEL.dynamics, MODEL.stiffness_fluctuation(angle), 1.0 / rate)
    start = (float(MODEL.static_deflection(0.0)), 0.0)
    return oscillator.respond(MODEL.torque_at(angle) / MODEL.dynamics.inertia, start).displacement


def generic(seconds: float, method: Solver, tolerance: float) -> np.ndarray:
    """Displacement [rad] at RATE by one of scipy's solvers."""
    natural, zeta = MODEL.dynamics.angular_frequency, MODEL.dynamics.damping_ratio
    force = MODEL.torque.mean / MODEL.dynamics.inertia

    def slope(t: float, state: np.ndarray) -> tuple[float, float]:
        stiffness = natural**2 * (1.0 + float(MODEL.stiffness_fluctuation(OMEGA * t)))
        return state[1], force - 2.0 * zeta * natural * state[1] - stiffness * state[0]

    times = np.arange(round(seconds * RATE) + 1) / RATE
    start = (float(MODEL.static_deflection(0.0)), 0.0)
    return np.asarray(
        solve_ivp(slope, (0.0, times[-1]), start, method, times, rtol=tolerance, atol=tolerance * 1e-4).y[0]
    )


def compare_integrators() -> None:
    """Samples per second and error, on the same two seconds; the scan's speed on a longer stretch."""
    seconds = 2.0
    truth = scan(seconds, 32 * RATE)[::32]
    size = np.ptp(truth)
    print(f"integrators at {RATE:g} Hz, {SPEED_RPM:g} rpm (error relative to the vibration's peak to peak)")
    print(f"  {'':24}{'samples/s':>12}{'error':>11}{'scan is faster by':>20}")
    long = 60.0
    ours = long * RATE / best_of(3, lambda: scan(long, RATE))
    error = np.abs(scan(seconds, RATE) - truth).max() / size
    print(f"  {'Magnus-4 scan':24}{ours:12.3g}{error:11.1e}")
    solvers: list[tuple[Solver, float]] = [("RK45", 1e-6), ("DOP853", 1e-9), ("LSODA", 1e-9)]
    for method, tolerance in solvers:
        theirs = seconds * RATE / best_of(1, partial(generic, seconds, method, tolerance))
        error = np.abs(generic(seconds, method, tolerance) - truth).max() / size
        print(f"  {f'solve_ivp {method} {tolerance:.0e}':24}{theirs:12.3g}{error:11.1e}{ours / theirs:20.0f}")


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
    print(f"  {name:36}{seconds / best_of(2, work):8.0f}", flush=True)


if __name__ == "__main__":
    compare_integrators()
    time_stages()
