"""Random cases: another reducer, defect, motion, load, noise and sensor fault each."""

import math

import numpy as np

from hd_monitor.model import (
    Dynamics,
    ParametricModel,
    StiffnessSeries,
    Torque,
    growth_rate,
)
from hd_monitor.reducer import Mount, Reducer

from .cases import BOTH_RATIO, MOTIONS, WARN, Case, output_speed

TEETH = ((160, 162), (160, 162), (200, 202), (100, 102), (120, 122))
HARMONICS = 3


def random_case(rng: np.random.Generator, **fixed: object) -> Case:
    """Draw a case; `fixed` replaces what is drawn."""
    while True:
        case = _draw(rng, fixed)
        if not _ambiguous(case) and _stable(case):
            return case


def _draw(rng: np.random.Generator, fixed: dict[str, object]) -> Case:
    z1, z2 = TEETH[rng.integers(len(TEETH))]
    mount = Mount.CIRCULAR_SPLINE_FIXED if rng.random() < 0.5 else Mount.FLEXSPLINE_FIXED
    reducer = Reducer(flexspline_teeth=z1, circular_spline_teeth=z2, mount=mount)
    dynamics = Dynamics(
        natural_frequency=55.0 if rng.random() < 0.5 else float(rng.uniform(25.0, 80.0)),
        damping_ratio=float(rng.uniform(0.015, 0.05)),
        inertia=float(rng.choice([0.29, 0.1, 1.0])),
    )
    kind = rng.choice(["healthy", "one", "both"], p=[0.2, 0.6, 0.2])
    if kind == "healthy":
        sizes = rng.uniform(0.0, 0.9 * WARN, 2)
    else:
        larger = rng.uniform(1.1 * WARN, 0.13)
        sizes = larger * np.array([1.0, rng.uniform(0.9, 1.0) if kind == "both" else rng.uniform(0.0, 0.8)])
        sizes = rng.permutation(sizes)
    circular, flex = (_series(rng, float(size)) for size in sizes)
    mean = dynamics.inertia * float(rng.uniform(15.0, 60.0))
    load = rng.choice(["none", "order 1", "order 2"], p=[0.4, 0.2, 0.4])
    torque = Torque(
        mean=mean,
        load_order=1 if load == "order 1" else 2,
        load_fluctuation=0.0 if load == "none" else mean * float(rng.uniform(0.1, 3.0)),
        load_phase=float(rng.uniform(0.0, math.tau)),
    )
    speed = float(rng.uniform(300.0, 2800.0))
    if rng.random() < 0.4:  # on the flank of a resonance fn / k
        line = dynamics.natural_frequency / rng.integers(1, 4) * rng.uniform(0.95, 1.05)
        speed = float(np.clip(line * 60.0 / reducer.circular_spline_order, 200.0, 3300.0))
    motion = str(rng.choice(MOTIONS))
    values: dict[str, object] = {
        "model": ParametricModel(
            reducer=reducer, dynamics=dynamics, circular_spline=circular, flexspline=flex, torque=torque
        ),
        "motion": motion,
        "speed": speed,
        "span": math.radians(float(rng.uniform(90.0, 330.0))),
        "duration": float(rng.choice([8.0, 12.0, 20.0])),
        "snr": float(rng.uniform(15.0, 30.0)),
        "colour": str(rng.choice(["white", "white", "red", "hum"])),
        "spikes": float(rng.choice([0.0, 0.0, 0.002])),
        "lost": float(rng.choice([0.0, 0.0, 0.01, 0.05])),
        "measured": bool(rng.random() < 0.4),
        "rate": 1000.0,
        "seed": int(rng.integers(2**31)),
    }
    case = Case(**(values | fixed))  # type: ignore[arg-type]
    if case.motion in ("dwell", "ripple"):
        # at least 90° of travel, however slow
        needed = math.pi / 2.0 / output_speed(case)
        case = Case(**(_fields(case) | {"duration": max(case.duration, math.ceil(needed + 1.0))}))  # type: ignore[arg-type]
    return case


def _fields(case: Case) -> dict[str, object]:
    return {name: getattr(case, name) for name in Case.__dataclass_fields__}


def _series(rng: np.random.Generator, index: float) -> StiffnessSeries:
    sizes = rng.uniform(0.3, 1.0, HARMONICS) * 0.6 ** np.arange(HARMONICS)
    sizes *= index / np.linalg.norm(sizes)
    return StiffnessSeries(tuple(sizes.tolist()), tuple(rng.uniform(0.0, math.tau, HARMONICS).tolist()))


def _ambiguous(case: Case) -> bool:
    """Whether a change of some per cent in an index would change the truth's name."""
    smaller, larger = sorted(case.index)
    near_limit = abs(larger / WARN - 1.0) < 0.08
    near_both = larger >= WARN and smaller > 0.9 * WARN and abs(smaller / larger / BOTH_RATIO - 1.0) < 0.03
    near_second = smaller / larger > BOTH_RATIO and abs(smaller / WARN - 1.0) < 0.05
    return bool(near_limit or near_both or near_second)


def _stable(case: Case) -> bool:
    return all(growth_rate(case.model, rpm) < -0.5 for rpm in speeds(case))


def speeds(case: Case) -> list[float]:
    """Wave-generator speeds [rpm] at which the case dwells, or that it passes."""
    return {
        "dwell": [case.speed],
        "ripple": [case.speed],
        "strokes": [case.speed],
        "run_up": np.linspace(0.6 * case.speed, 1.4 * case.speed, 7).tolist(),
        "steps": [f * case.speed for f in (0.7, 0.85, 1.0, 1.15)],
    }[case.motion]
