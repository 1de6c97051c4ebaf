"""The curves beside the statuses: which topic is whose, and how its array is read."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from .. import contract
from ..arrays import FloatArray
from ..cdr import decode_multi_arrays
from ..errors import LayoutError
from .reading import TOO_LARGE

NAMES = (contract.ZOOM_SPECTRUM, contract.RMS_CURVE, contract.RMS_BASELINE)


class Curve(NamedTuple):
    """Points of a curve, by rising abscissa."""

    x: tuple[float, ...]
    """Frequencies [Hz] or wave-generator speeds [rpm]."""
    y: tuple[float, ...]
    """Amplitudes [rad/s²] or RMS [m/s²]."""


def topic_of(topics: Collection[str], node: str, joint: str, name: str) -> str | None:
    """Find a joint's topic: below its name where a node watches several joints, else beside the node; None without.

    Examples
    --------
    >>> topic_of({"/arm/elbow/rms_curve"}, "/arm/hd_monitor_node", "elbow", "rms_curve")
    '/arm/elbow/rms_curve'
    """
    namespace = node.rpartition("/")[0]
    return next((topic for topic in (f"{namespace}/{joint}/{name}", f"{namespace}/{name}") if topic in topics), None)


def curve_from(message: bytes, name: str) -> Curve:
    """Read a serialised array of one of the topics in `NAMES`.

    Raises
    ------
    LayoutError
        If it is not laid out as the contract says.
    """
    groups, faults = decode_multi_arrays([message])
    if faults:
        raise LayoutError(faults[0].reason)
    sizes = tuple(dimension.size for dimension in groups[0].dimensions)
    data = groups[0].data[0]
    planar = name == contract.ZOOM_SPECTRUM
    if len(sizes) != 2 or sizes[0] * sizes[1] != data.size or sizes[0 if planar else 1] < 2:
        raise LayoutError(f"an array of {name} announces {sizes} and carries {data.size} values: no points of a curve")
    table = data.reshape(sizes)
    return _curve(table.T if planar else table)


def curve_of(x: Sequence[float] | FloatArray, y: Sequence[float] | FloatArray) -> Curve:
    """Return the points that are not damaged."""
    table = np.column_stack([np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)])
    return _curve(table)


def _curve(rows: FloatArray) -> Curve:
    sound = rows[(np.abs(rows[:, :2]) < TOO_LARGE).all(axis=1)]  # NaN is not
    return Curve(tuple(sound[:, 0].tolist()), tuple(sound[:, 1].tolist()))
