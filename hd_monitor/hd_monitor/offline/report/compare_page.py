"""The report of a comparison: what changed, in words and pictures, on one HTML page."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ...model.parameters import Dynamics
from ...orders.rms_curve import SpeedBin
from ...reducer import Reducer
from ..comparison import JointChange
from ..plots.index_change import index_change_plot
from ..plots.rms_curve import rms_plot
from ..plots.style import png
from .page import write_page
from .pictures import FEWEST_SPEEDS, pair_speeds

_NAMES = ("property_curves", "indexes")


def write_comparison(folder: Path, content: Mapping[str, Any], changes: Sequence[JointChange]) -> Path:
    """Write the page of a comparison, whose JSON is `content`, as `write_page` does."""
    sections = [{"joint": change.joint, "change": change, "pictures": _pictures(change)} for change in changes]
    return write_page(folder, "offline/report/comparison.html.j2", content, sections, _NAMES)


def _pictures(change: JointChange) -> dict[str, bytes]:
    drawn = {}
    sides = change.before, change.after
    curves = [[SpeedBin(b["rpm"], b["rms"], b["samples"]) for b in side["rms_curve"]] for side in sides]
    if max(map(len, curves)) >= FEWEST_SPEEDS:
        critical = _critical(change.after)
        drawn["property_curves"] = rms_plot(*curves, critical=critical, title="Vibration over speed")
    if change.indexes and not change.relative:
        limits = {"warn": change.after["warn_limit"], "error": change.after["error_limit"]}
        drawn["indexes"] = index_change_plot(change.indexes, **limits, title="Stiffness indexes before and after")
    return {name: png(figure) for name, figure in drawn.items()}


def _critical(entry: Mapping[str, Any]) -> list[tuple[float, str]]:
    """Speeds [rpm] at which the pairs meet the natural frequency that was given."""
    parameters = entry.get("parameters", {})
    if "reducer.flexspline_teeth" not in parameters:
        return []
    names = ("flexspline_teeth", "circular_spline_teeth", "mount")
    reducer = Reducer(**{name: parameters[f"reducer.{name}"] for name in names})
    natural = parameters.get("dynamics.natural_frequency", Dynamics().natural_frequency)
    return pair_speeds(reducer, natural, parameters.get("analysis.harmonics", 3))
