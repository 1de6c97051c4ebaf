"""The rows of the fault campaign: what is wrong, and the words that name it. See faults.py."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tests.studies.spoiling import (
    Change,
    cut,
    degrees,
    half_a_period_later,
    hole,
    joint,
    joint_twice,
    jumping,
    mains,
    not_a_number,
    replaced,
    samples,
    scratched,
    second_publisher,
    stamp,
    until,
)

from hd_monitor.contract import NANOSECONDS


@dataclass(frozen=True, kw_only=True)
class Fault:
    """A row of the campaign.

    Attributes
    ----------
    fault : str
        What is wrong, for the page.
    cause : str
        Words that name it: they stand in the reason wherever the verdict is undetermined.
    gap : str
        What is not as it should be yet: the cause is not named, or the fault goes unnoticed.
    rig, monitor : mapping
        Parameters of the simulator and of the monitor.
    motion : mapping
        Parameters of another rig, whose joint states are sent instead.
    blocks, joints : callable or None
        Change the messages with the vibration, and the joint states.
    storage, damage
        The messages go through a bag of this kind, whose file is changed so.
    """

    fault: str
    cause: str = ""
    gap: str = ""
    rig: Mapping[str, Any] = field(default_factory=dict)
    monitor: Mapping[str, Any] = field(default_factory=dict)
    motion: Mapping[str, Any] = field(default_factory=dict)
    blocks: Change | None = None
    joints: Change | None = None
    storage: str = "mcap"
    damage: Callable[[bytearray], bytes] | None = None


SAMPLES: dict[str, Any] = {"publish": "samples"}
"""Parameters of a rig that sends single samples; the monitor's are these."""
TAKES_SAMPLES = {"input.source": "accel_stamped"}

FAULTS: dict[str, Fault] = {
    # The sensor
    "dead": Fault(
        fault="sensor dead: noise alone is left",
        rig={"sensor.fault": "dead"},
        cause="hears nothing",
    ),
    "dies": Fault(
        fault="sensor dead from the sixth second on",
        rig={"sensor.fault": "dead", "sensor.fault_after": 6.0},
        cause="no longer hears",
    ),
    "stuck": Fault(
        fault="sensor stuck: the last value is repeated", rig={"sensor.fault": "stuck"}, cause="did not change"
    ),
    "dying": Fault(
        fault="sensor dying over 12 s",
        rig={"sensor.fault": "dying", "sensor.fault_time": 12.0},
        cause="the sensor's gain",
    ),
    "gain": Fault(fault="gain 20 % too large", rig={"sensor.gain": 1.2}),
    "half": Fault(
        fault="gain half of what it should be",
        rig={"sensor.gain": 0.5},
        cause="the sensor's gain",
    ),
    "sign": Fault(fault="sensor mounted the wrong way round", rig={"sensor.gain": -1.0}),
    "offset": Fault(fault="offset of 50 rad/s²", rig={"sensor.offset": 50.0}),
    "noise": Fault(fault="noise a hundred times stronger", rig={"sensor.noise": 10.0}, cause="against the noise"),
    "spikes": Fault(fault="20 spikes a second", rig={"sensor.spike_rate": 20.0}),
    "clipping": Fault(fault="clipping at 2 rad/s²", rig={"sensor.full_scale": 2.0}, cause="clip"),
    "coarse": Fault(
        fault="steps of 5 rad/s²",
        rig={"sensor.resolution": 5.0},
        cause="comes in steps",
    ),
    "filtered": Fault(
        fault="anti-aliasing filter at 20 Hz",
        rig={"sensor.bandwidth": 20.0},
        cause="bandwidth",
    ),
    "mains": Fault(fault="mains hum, 50 Hz", blocks=samples(mains), cause="mains hum"),
    "not finite": Fault(fault="all samples NaN", blocks=samples(not_a_number), cause="not finite"),
    "holes": Fault(fault="one sample of each block NaN", blocks=samples(hole)),
    # Clocks
    "20 ms": Fault(
        fault="sensor's clock 20 ms ahead", rig={"sensor.clock_offset": 0.02}, cause="stamps of the vibration lag"
    ),
    "50 ms": Fault(
        fault="sensor's clock 50 ms ahead", rig={"sensor.clock_offset": 0.05}, cause="stamps of the vibration lag"
    ),
    "2 s": Fault(
        fault="sensor's clock 2 s ahead", rig={"sensor.clock_offset": 2.0}, cause="stamps of the vibration lag"
    ),
    "60 s": Fault(fault="sensor's clock a minute ahead", rig={"sensor.clock_offset": 60.0}, cause="the stamps"),
    "drift": Fault(fault="sensor's clock 100 ppm fast", rig={"sensor.clock_drift": 100.0}),
    "fast": Fault(
        fault="sensor's clock 2 % fast", rig={"sensor.clock_drift": 20_000.0}, cause="clock of the vibration"
    ),
    "fifo": Fault(
        fault="single samples stamped as they are read from a FIFO of 16",
        rig=SAMPLES | {"sensor.fifo": 16},
        monitor=TAKES_SAMPLES,
    ),
    "jitter": Fault(
        fault="single samples stamped with 2 ms of jitter",
        rig=SAMPLES | {"sensor.jitter": 0.002},
        monitor=TAKES_SAMPLES,
    ),
    "clock reset": Fault(
        fault="joint states' clock set back by an hour",
        joints=stamp(lambda t, n: t - 3600 * NANOSECONDS * (n > 600)),
        cause="the stamps",
    ),
    "stamps 0": Fault(fault="joint states without stamps", joints=stamp(lambda t, n: 0), cause="the stamps"),
    # Transport
    "loss": Fault(fault="a tenth of the blocks lost", rig={"transport.loss": 0.1}),
    "half lost": Fault(fault="half of the blocks lost", rig={"transport.loss": 0.5}),
    "duplicates": Fault(fault="a fifth of the blocks sent twice", rig={"transport.duplicates": 0.2}),
    "late": Fault(fault="a tenth of the blocks overtaken by later ones", rig={"transport.late": 0.1}),
    "unplugged": Fault(fault="sensor unplugged after 6 s", blocks=until(6.0, 20.0), cause="No vibration signal"),
    "driver ends": Fault(fault="joint states end after 6 s", joints=until(6.0, 100.0), cause="No joint states"),
    "no sensor": Fault(fault="no sensor at all", blocks=until(0.0, 20.0), cause="vibration signal"),
    "two sensors": Fault(fault="two publishers of blocks", blocks=second_publisher, cause="two publishers"),
    "half a period": Fault(
        fault="two publishers of single samples, half a period apart",
        rig=SAMPLES,
        monitor=TAKES_SAMPLES,
        blocks=half_a_period_later,
        cause="publishers",
    ),
    # Wrong messages
    "label": Fault(
        fault="blocks with another label", blocks=replaced(b"torsional_a", b"tangential_"), cause="labelled"
    ),
    "cut off": Fault(fault="blocks cut off by 8 bytes", blocks=lambda _, data: [data[:-8]], cause="cut off"),
    "other type": Fault(
        fault="blocks of another type", blocks=lambda _, data: [b"\0\1\0\0" + bytes(40)], cause="dimensions"
    ),
    "other joint": Fault(
        fault="joint states of several others, without this one",
        joints=replaced(b"joint", b"elbow"),
        monitor={"input.joint_name": "wrist"},
        cause="is not in joint_states",
    ),
    "joint twice": Fault(fault="the joint's name twice in a message", joints=joint_twice),
    "mixed up": Fault(
        fault="joint states of another joint, which turns steadily",
        motion={"programme": "fixed"},
        cause="of this joint",
    ),
    "mixed up too": Fault(
        fault="vibration of a joint that turns steadily, joint states of one that swings",
        rig={"programme": "fixed"},
        motion={"programme": "strokes"},
        cause="of this joint",
    ),
    # Joint states
    "velocity 0": Fault(
        fault="velocities all 0", rig={"joint_states.velocity": "zero"}, cause="zero while the positions move"
    ),
    "reversed velocity": Fault(
        fault="velocities of the wrong sign", rig={"joint_states.velocity": "reversed"}, cause="opposite sign"
    ),
    "no velocity": Fault(fault="no velocities", rig={"joint_states.velocity": "missing"}),
    "late velocity": Fault(
        fault="velocities late by a 50 ms filter",
        rig={"joint_states.velocity": "filtered", "joint_states.velocity_time_constant": 0.05},
    ),
    "noisy velocity": Fault(fault="velocities with noise of 0.1 rad/s", rig={"joint_states.velocity_noise": 0.1}),
    "wrapped": Fault(fault="positions wrapped at ±π", rig={"joint_states.wrapped": True, "start_angle": 150.0}),
    "quantised": Fault(
        fault="positions in steps of 0.01 rad", rig={"joint_states.resolution": 0.01}, cause="come in steps"
    ),
    "jumping": Fault(
        fault="positions jump by up to 6 rad",
        joints=joint(jumping),
        cause="jump by",
    ),
    "degrees": Fault(fault="positions and velocities in degrees", joints=joint(degrees), cause="in rad"),
    "NaN positions": Fault(
        fault="positions NaN", joints=joint(lambda values, _: values.put(0, math.nan)), cause="joint states"
    ),
    "other sense": Fault(fault="positions and velocities counted the other way", rig={"joint_states.reversed": True}),
    "joint 20 ms": Fault(
        fault="joint states stamped 20 ms late",
        rig={"joint_states.delay": 0.02},
        cause="stamps of the joint states lag",
    ),
    "joint 50 ms": Fault(
        fault="joint states stamped 50 ms late",
        rig={"joint_states.delay": 0.05},
        cause="stamps of the joint states lag",
    ),
    "joint jitter": Fault(
        fault="joint states stamped with 5 ms of jitter",
        rig={"joint_states.jitter": 0.005},
        cause="jitter by",
    ),
    "joint loss": Fault(fault="a third of the joint states lost", rig={"joint_states.loss": 0.33}),
    "slow": Fault(fault="5 joint states a second", rig={"joint_states.rate": 5.0}),
    # Efforts
    "no effort": Fault(fault="no efforts", rig={"joint_states.effort": "none"}),
    "effort scale": Fault(
        fault="efforts half of the true ones", rig={"joint_states.effort_scale": 0.5}, cause="the effort's unit"
    ),
    "effort sign": Fault(fault="efforts of the wrong sign", rig={"joint_states.effort_scale": -1.0}),
    "effort bias": Fault(
        fault="efforts 10 N·m too large",
        rig={"joint_states.effort_bias": 10.0},
        cause="and offset",
    ),
    "effort noise": Fault(
        fault="efforts with noise of 20 N·m",
        rig={"joint_states.effort_noise": 20.0},
        cause="scatter",
    ),
    "slow effort": Fault(
        fault="efforts measured once a second",
        rig={"joint_states.effort_rate": 1.0, "torque.gravity": 8.0},
        cause="change only every",
    ),
    # Parameters
    "teeth": Fault(
        fault="tooth numbers of another reducer",
        monitor={"reducer.flexspline_teeth": 200, "reducer.circular_spline_teeth": 202},
        cause="check teeth",
    ),
    "mount": Fault(fault="the other spline given as the fixed one", monitor={"reducer.mount": "flexspline_fixed"}),
    # Bags
    "MCAP cut off": Fault(fault="MCAP file cut off after two thirds", damage=cut),
    "SQLite cut off": Fault(fault="SQLite file cut off after two thirds", damage=cut, storage="sqlite3"),
    "MCAP scratched": Fault(fault="200 bytes in the middle of an MCAP file overwritten", damage=scratched),
    "SQLite scratched": Fault(
        fault="200 bytes in the middle of a SQLite file overwritten",
        damage=scratched,
        storage="sqlite3",
    ),
}
