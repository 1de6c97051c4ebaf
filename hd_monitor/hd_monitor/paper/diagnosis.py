"""The verdict of the monitor itself, fed with the simulated vibration of a case."""

import math

import numpy as np

from ..assessment import Assessment
from ..contract import NANOSECONDS, Block
from ..diagnosis.verdict import Component
from ..errors import HdMonitorError
from ..monitor import Monitor
from ..sources import Quantity
from .cases import Case
from .exhibit import Claim
from .records import REVOLUTIONS, output_frequency, steady_record

SENSOR_NOISE = 0.2
"""Standard deviation of the noise put on the vibration [rad/s²]: 11 mg at 0.55 m, an ordinary MEMS sensor's."""

_MOTION_RATE = 100.0  # Hz, of the joint states
_BLOCKS_PER_SECOND = 5
_SEED = 2021


def diagnose(case: Case) -> Assessment:
    """Return the last assessment of a monitor that watches a steady run and knows none of the case's defects.

    Raises
    ------
    HdMonitorError
        If the run is too short for an assessment.
    """
    record = steady_record(case.model, case.speed)
    noise = np.random.default_rng(_SEED).normal(0.0, SENSOR_NOISE, record.acceleration.size)
    samples = record.acceleration + noise
    seconds = (samples.size - 1) / record.rate
    monitor = Monitor(case.settings)

    motion = np.arange(math.floor(seconds * _MOTION_RATE) + 1) / _MOTION_RATE
    omega = 2.0 * math.pi * output_frequency(record)
    angle = record.output_angle[0] + omega * motion
    stamps = np.rint(motion * NANOSECONDS).astype(np.int64)
    monitor.add(Quantity.MOTION, stamps, angle, np.full(motion.size, omega), np.full(motion.size, np.nan))
    blocks = np.array_split(np.arange(samples.size), max(1, round(motion[-1] * _BLOCKS_PER_SECOND)))
    for number, part in enumerate(blocks):
        start = round(float(part[0]) / record.rate * NANOSECONDS)
        monitor.add_block(Block(start, 1.0 / record.rate, number, samples[part]))
    assessment = monitor.finish()
    if assessment is None:
        raise HdMonitorError(
            f"{REVOLUTIONS} output revolutions at {case.speed:g} rpm last {seconds:.2f} s, too "
            "short for the monitor; choose a lower speed"
        )
    return assessment


def verdict_claim(case: Case, statement: str, paper: str, component: Component, note: str = "") -> Claim:
    """Hold the monitor's verdict on a case against the part that the paper names."""
    assessment = diagnose(case)
    verdict, found = assessment.verdict, assessment.identification
    words = f"{verdict.component.value} ({verdict.level.name})"
    if found is not None:
        (circular, flex), (circular_std, flex_std) = found.index, found.index_std
        words += f"; circular spline {circular:.2%} ± {circular_std:.2%}, flexspline {flex:.2%} ± {flex_std:.2%}"
    passed = verdict.component is component and (verdict.level > 0) == (component is not Component.NONE)
    return Claim(statement=statement, paper=paper, ours=words, passed=passed, note=note)
