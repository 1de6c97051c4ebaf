"""A simulated run as the messages would carry it, and a monitor that is fed with it."""

from collections.abc import Sequence

import numpy as np

from hd_monitor.assessment import Assessment
from hd_monitor.contract import Block
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.model import ParametricModel, StiffnessSeries
from hd_monitor.model.simulation import constant_speed, simulate
from hd_monitor.monitor import Monitor
from hd_monitor.settings import JointSettings
from hd_monitor.sources import Quantity

EPOCH = 1_700_000_000_250_000_000
RATE = 1000
BLOCK = 100
PAPER = {"reducer.transmission_error": 0.0}
"""The recording is of the paper's world, where only the stiffness fluctuates."""
SETTINGS = JointSettings.from_mapping(PAPER | {"reducer.serial": "SHG-20-80 no. 7"})

SOUND, WORN = (0.012, 0.008, 0.004), (0.075, 0.045, 0.03)
UNITS = {
    Component.NONE: (SOUND, SOUND),
    Component.CIRCULAR_SPLINE: (WORN, SOUND),
    Component.FLEXSPLINE: (SOUND, WORN),
    Component.BOTH: (WORN, WORN),
}


class Recording:
    """Arrays of a simulated run at one speed: what the messages would carry."""

    def __init__(self, component: Component = Component.FLEXSPLINE, rpm: float = 1000.0, seconds: float = 12.0) -> None:
        cs, fs = UNITS[component]
        model = ParametricModel(
            circular_spline=StiffnessSeries(cs, (0.4, 1.0, -2.0)), flexspline=StiffnessSeries(fs, (-1.2, 0.3, 2.5))
        )
        run = simulate(model, constant_speed(model.reducer, rpm), duration=seconds, rate=4.0 * RATE)
        rng = np.random.default_rng(20)
        self.stamps = EPOCH + np.rint(run.times[::4] * 1e9).astype(np.int64)
        self.values = run.acceleration[::4] + rng.normal(0.0, 0.3, self.stamps.size)
        self.joint_stamps = self.stamps[::10]
        self.position = run.output_angle[::40]
        self.velocity = np.full(self.position.size, float(run.output_angle[-1] / run.times[-1]))
        self.effort = np.full(self.position.size, 10.0)

    def blocks(self) -> list[Block]:
        return [
            Block(int(self.stamps[i]), 1.0 / RATE, i // BLOCK, self.values[i : i + BLOCK])
            for i in range(0, self.values.size - BLOCK + 1, BLOCK)
        ]

    def feed_motion(self, monitor: Monitor, chosen: slice = slice(None)) -> None:
        monitor.add(
            Quantity.MOTION,
            self.joint_stamps[chosen],
            self.position[chosen],
            self.velocity[chosen],
            self.effort[chosen],
        )


def run(recording: Recording, blocks: Sequence[Block] | None = None, settings: JointSettings = SETTINGS) -> Monitor:
    monitor = Monitor(settings)
    recording.feed_motion(monitor)
    for block in recording.blocks() if blocks is None else blocks:
        monitor.add_block(block)
    monitor.finish()
    return monitor


def latest(monitor: Monitor) -> Assessment:
    assert monitor.latest is not None
    return monitor.latest
