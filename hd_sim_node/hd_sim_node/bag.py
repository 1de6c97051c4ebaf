"""The simulated rig written to a rosbag2 bag: the node's messages, without ROS and without waiting for a clock."""

import heapq
import math
import shutil
import sqlite3
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from rosbags.interfaces import Connection, Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer, WriterError
from rosbags.typesys import Stores, get_typestore

from hd_monitor import contract
from hd_monitor.contract import NANOSECONDS
from hd_monitor.errors import OutputError, ParameterError

from .messages.encoding import MESSAGE_TYPES, encode
from .settings import RigSettings
from .simulation import Simulation

STORAGES = {"mcap": StoragePlugin.MCAP, "sqlite3": StoragePlugin.SQLITE3}
COMPRESSIONS = {"none": CompressionMode.NONE, "file": CompressionMode.FILE, "message": CompressionMode.MESSAGE}

_STORE = get_typestore(Stores.ROS2_JAZZY)
_FOREVER = QosTime(sec=9_223_372_036, nsec=854_775_807)
_QOS = Qos(
    QosHistory.KEEP_LAST,
    10,
    QosReliability.RELIABLE,
    QosDurability.VOLATILE,
    _FOREVER,
    _FOREVER,
    QosLiveliness.AUTOMATIC,
    _FOREVER,
    False,
)


class BagError(OutputError):
    """The bag cannot be written."""


class BagSummary(NamedTuple):
    """What was written."""

    path: Path
    duration: float
    """Simulated time [s]."""
    messages: dict[str, int]
    """By topic."""


def write_bag(
    rigs: RigSettings | Sequence[RigSettings],
    path: str | Path,
    *,
    storage: str = "mcap",
    compression: str = "none",
    start: int = 0,
    namespace: str = "",
    progress: Callable[[float], object] | None = None,
) -> BagSummary:
    """Simulate one rig or several and write what the nodes would publish.

    Parameters
    ----------
    rigs : RigSettings or sequence of RigSettings
        A programme without end runs once. With several rigs, each has its vibration topics below its joint's name,
        and all share ``joint_states``.
    path : path-like
        Folder to create.
    storage : str
        ``'mcap'`` or ``'sqlite3'``.
    compression : str
        ``'none'``, ``'file'`` or ``'message'`` (Zstandard).
    start : int
        Stamp of the start [ns].
    namespace : str
        Prefix of every topic.
    progress : callable, optional
        Called now and then with the fraction done.

    Returns
    -------
    BagSummary

    Raises
    ------
    BagError
        If the folder exists or cannot be written; nothing is left of it where the disk was full.
    ParameterError
        If joints share a name, or a rig is unstable and ``unstable`` is ``refuse``.
    """
    rigs = [rigs] if isinstance(rigs, RigSettings) else list(rigs)
    names = [rig.joint.name for rig in rigs]
    if len(set(names)) != len(names):
        raise ParameterError(f"joint_states.name is {' and '.join(names)}: several rigs need joints of different names")
    rigs = [
        rig
        if math.isfinite(rig.duration)
        else RigSettings.from_mapping({**rig.values, "duration": rig.programme.cycle_duration})
        for rig in rigs
    ]
    prefix = "/" + namespace.strip("/") + "/" if namespace.strip("/") else "/"
    streams = []
    for rig, name in zip(rigs, names, strict=True):
        simulation, below = Simulation(rig), f"{name}/" if len(rigs) > 1 else ""
        topics = {t: prefix + (t if t == contract.JOINT_STATES else below + t) for t in simulation.topics}
        streams.append(_serialised(simulation, start, topics))
    end = max(rig.duration for rig in rigs)
    try:
        writer = Writer(path, version=9, storage_plugin=STORAGES[storage])
        writer.set_compression(COMPRESSIONS[compression], CompressionFormat.ZSTD)
        with writer:
            connections: dict[str, Connection] = {}
            counts: Counter[str] = Counter()
            for number, (due, topic, kind, data) in enumerate(heapq.merge(*streams, key=lambda message: message[0])):
                if topic not in connections:
                    connections[topic] = writer.add_connection(
                        topic, kind, typestore=_STORE, offered_qos_profiles=[_QOS]
                    )
                writer.write(connections[topic], start + due, data)
                counts[topic] += 1
                if progress is not None and number % 5000 == 0:
                    progress(due / NANOSECONDS / end)
    except WriterError as error:
        raise BagError(f"{path} cannot be written: {error}") from error
    except (OSError, sqlite3.Error) as error:
        shutil.rmtree(path, ignore_errors=True)  # it was made here: the writer refuses what exists
        raise BagError(f"{path} cannot be written: {getattr(error, 'strerror', None) or error}") from error
    return BagSummary(Path(path), end, counts)


def _serialised(simulation: Simulation, epoch: int, names: Mapping[str, str]) -> Iterator[tuple[int, str, str, bytes]]:
    """Yield (due [ns] since the start, topic in the bag, message type, message) in the order of going out."""
    for stretch in simulation:
        encoded = encode(stretch, simulation.settings, epoch)
        for due, topic, row in stretch.schedule():
            yield due, names[topic], MESSAGE_TYPES[topic], encoded[topic][row]
