"""The report of a comparison: what changed, in words and pictures, on one HTML page."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ...model.parameters import Dynamics
from ...orders.rms_curve import SpeedBin
from ...reducer import Reducer
from ..comparison import JointChange
from ..plots.index_change import index_change_plot
from ..plots.rms_curve import compared_rms_plot
from ..plots.style import png
from .page import render, write_files
from .pictures import Picture

_FEWEST_SPEEDS = 3


def write_comparison(folder: Path, content: Mapping[str, Any], changes: Sequence[JointChange]) -> Path:
    """Write the page of a comparison and its pictures into a folder, which is made if it is not there.

    Parameters
    ----------
    folder : Path
    content : mapping
        The comparison's JSON.
    changes : sequence of JointChange

    Raises
    ------
    ParameterError
        If the folder cannot be written.
    """
    sections: list[dict[str, Any]] = [{"change": change, "pictures": list(_pictures(change))} for change in changes]
    page = render("comparison.html.j2", content=content, sections=sections)
    several = len(changes) > 1
    files = {}
    for change, section in zip(changes, sections, strict=True):
        prefix = re.sub(r"[^\w.-]+", "_", change.joint) + "_" if several else ""
        files.update({prefix + picture.name: picture.png for picture in section["pictures"]})
    return write_files(folder, page, files)


def _pictures(change: JointChange) -> Iterator[Picture]:
    figure = _curves(change)
    if figure is not None:
        yield Picture(
            "property_curves",
            "RMS over speed",
            "The property curves before and after. At the dotted speeds a line pair meets the natural frequency.",
            png(figure),
        )
    if change.indexes:
        figure = index_change_plot(
            change.indexes,
            warn=change.after["warn_limit"],
            error=change.after["error_limit"],
            title="Stiffness indexes before and after",
        )
        yield Picture("indexes", "Indexes", "Both splines' indexes with their 95 % bars.", png(figure))


def _curves(change: JointChange) -> Figure | None:
    curves = [[SpeedBin(b["rpm"], b["rms"], b["samples"]) for b in side["rms_curve"]] for side in change[1:3]]
    if max(len(curve) for curve in curves) < _FEWEST_SPEEDS:
        return None
    return compared_rms_plot(curves[0], curves[1], critical=_critical(change.after), title="Vibration over speed")


def _critical(entry: Mapping[str, Any]) -> list[tuple[float, str]]:
    """Speeds [rpm] at which the pairs meet the natural frequency that was found, or else given."""
    parameters = entry.get("parameters", {})
    if "reducer.flexspline_teeth" not in parameters:
        return []
    reducer = Reducer(
        flexspline_teeth=parameters["reducer.flexspline_teeth"],
        circular_spline_teeth=parameters["reducer.circular_spline_teeth"],
        mount=parameters["reducer.mount"],
    )
    natural = parameters.get("dynamics.natural_frequency", Dynamics().natural_frequency)
    count = parameters.get("analysis.harmonics", 3)
    return [(60.0 * natural / (reducer.circular_spline_order * k), f"k = {k}") for k in range(1, count + 1)]
