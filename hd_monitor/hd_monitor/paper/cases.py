"""The cases that the figures are computed for, read from YAML: the paper's own, or a user's reducer."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..errors import HdMonitorError, ParameterError
from ..model import ParametricModel, StiffnessSeries, Torque
from ..model.pitch_error import PitchErrors
from ..model.static_test import StaticTestBed
from ..parameter import flatten
from ..settings import PARAMETERS, JointSettings
from .reading import Reader, read_file

PAPER_FILE = "paper.yaml"
ASSUMED: Mapping[str, Any] = {"reducer.transmission_error": 0.0, "load.assumed_uncertainty": 0.1}
"""What the paper takes for granted, and a case unless it says otherwise: no transmission error, a torque known well."""
GRAVITY = 9.80665  # m/s² per g


class Range(NamedTuple):
    """Evenly spaced values from start to stop, both included."""

    start: float
    stop: float
    step: float

    @property
    def values(self) -> FloatArray:
        """The values, shape (count,)."""
        return np.asarray(
            self.start + self.step * np.arange(round((self.stop - self.start) / self.step) + 1), dtype=np.float64
        )


class Sweep(NamedTuple):
    """A sweep of the circular spline's line ωo2/2π: start and stop [Hz], rate [Hz/s]."""

    start: float
    stop: float
    rate: float


class PitchErrorCase(NamedTuple):
    """The circular spline's pitch errors, their tolerance [m] and the stiffening by interference [1/m]."""

    errors: PitchErrors
    tolerance: float
    sensitivity: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A reducer with its defects, and the settings of its figures.

    The settings are those of a monitor of this reducer; the defects are not among them.
    """

    name: str
    model: ParametricModel
    sensor_radius: float
    """[m]"""
    settings: JointSettings
    speed: float
    """Wave-generator speed of the spectra [rpm]."""
    speeds: Range
    """Wave-generator speeds of the property curve [rpm]."""
    scales: Range
    """Factors on the indexes for the stability chart."""
    sweep: Sweep
    static_test: StaticTestBed
    static_step: float
    """Angle between two positions of the static test [rad of the wave generator]."""
    pitch_error: PitchErrorCase | None
    """Source of the circular spline's fluctuation in `model`, if not given directly."""
    ignored: tuple[str, ...] = ()
    """Names in a file shared with others that mean nothing here."""

    def in_g(self, acceleration: Any) -> Any:
        """Tangential acceleration at the sensor [g] for a torsional acceleration [rad/s²]."""
        return acceleration * (self.sensor_radius / GRAVITY)


class Cases(dict[str, Case]):
    """Cases by name; a missing one is an error that names the file."""

    def __init__(self, cases: Mapping[str, Case], source: str) -> None:
        super().__init__(cases)
        self._source = source

    def __missing__(self, name: str) -> Case:
        """Refuse an unknown name."""
        raise ParameterError(f"{self._source} has no case {name!r}, which a figure needs; has it been edited?")


def paper_file() -> Path:
    """Return the installed (or, in a checkout, the source) file with the paper's cases.

    Raises
    ------
    HdMonitorError
        If it is not installed.
    """
    here = Path(__file__)
    above = [*here.parents, *here.resolve().parents]
    above += [Path(p) for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    for folder in above:
        for part in ("share/hd_monitor/config", "config"):
            candidate = folder / part / PAPER_FILE
            if candidate.is_file():
                return candidate
    raise HdMonitorError(
        f"{PAPER_FILE} is not installed in share/hd_monitor/config of any folder above {here.parent}, so the paper's "
        "cases are unknown; install hd_monitor with its data files, or give the file with --params"
    )


def load_paper_cases(path: Path | None = None) -> Cases:
    """Read the paper's cases, by default from the installed file."""
    path = path or paper_file()
    content = read_file(path)
    cases = content.pop("cases", None)
    if not isinstance(cases, Mapping):
        raise ParameterError(f"{path} has no `cases`; it is not a file with the paper's cases")
    common = flatten(content)
    return Cases(
        {name: _case(f"{path.name}: {name}", common | flatten(own or {})) for name, own in cases.items()}, path.name
    )


def load_own_case(path: Path) -> Case:
    """Read a user's reducer, from plain YAML or from a ROS parameter file.

    A ROS file may hold parameters of others too; the case names those that mean nothing here as `ignored`. In plain
    YAML they are refused.

    Raises
    ------
    HdMonitorError
        If the file or a value in it is invalid, or no spline has a defect: nothing would vibrate.
    """
    content = read_file(path)
    shared = False
    if len(content) == 1:
        (only,) = content.values()
        if isinstance(only, Mapping) and "ros__parameters" in only:
            content, shared = dict(only["ros__parameters"] or {}), True
    case = _case(path.name, content, shared=shared)
    if not (case.model.flexspline.index or case.model.circular_spline.index):
        raise ParameterError(
            f"{path} gives no stiffness index, so nothing would vibrate; give flexspline.beta or circular_spline.beta"
        )
    return case


def has_cases(path: Path) -> bool:
    """Whether the file holds cases of the paper rather than one reducer."""
    return isinstance(read_file(path).get("cases"), Mapping)


def _case(source: str, values: Mapping[str, Any], *, shared: bool = False) -> Case:
    reader = Reader(source, values)
    series = {
        name: StiffnessSeries(reader.numbers(f"{name}.beta"), reader.numbers(f"{name}.phase"))
        for name in ("flexspline", "circular_spline")
    }
    known = {parameter.name for parameter in PARAMETERS}
    given = {name: reader.left.pop(name) for name in list(reader.left) if name in known}
    settings = JointSettings.from_mapping({**ASSUMED, **given})
    reducer, dynamics = settings.reducer, settings.dynamics
    torque = Torque(
        mean=reader.number("torque.mean", settings.load.torque),
        load_order=int(reader.number("torque.load_order", 2)),
        **reader.numbers_below("torque", "load_fluctuation", "load_phase", "drive_fluctuation", "drive_phase"),
    )
    gear = None
    if any(name.startswith("pitch_error.") for name in reader.left):
        eccentricity, scatter = (reader.number(f"pitch_error.{name}", 0.0) for name in ("eccentricity", "scatter"))
        gear = PitchErrorCase(
            PitchErrors.of_eccentric_gear(reducer.circular_spline_teeth, eccentricity, scatter=scatter),
            tolerance=reader.number("pitch_error.tolerance", np.inf),
            sensitivity=reader.number("pitch_error.sensitivity", 0.0),
        )
        if series["circular_spline"].beta:
            raise ParameterError(f"{source}: give circular_spline.beta or pitch_error, which determines it, not both")
        series["circular_spline"] = gear.errors.stiffness_series(gear.sensitivity)
    model = ParametricModel(reducer=reducer, dynamics=dynamics, torque=torque, **series)
    fn = dynamics.natural_frequency
    resonance = 60.0 * fn / reducer.circular_spline_order
    top = 1.8 * resonance
    case = Case(
        name=source.rpartition(": ")[2],
        model=model,
        sensor_radius=settings.input.sensor_radius,
        settings=settings,
        speed=reader.number("speed", resonance / 2.0),
        speeds=Range(*reader.range("speeds", top / 30.0, top, "step", top / 30.0)),
        scales=Range(*reader.range("scales", 0.0, 4.0, "step", 0.2)),
        sweep=Sweep(*reader.range("sweep", 1.0, 2.2 * fn, "rate", 0.6 * (fn / 55.0) ** 2)),
        static_step=np.deg2rad(reader.number("static_test.step", 30.0)),
        static_test=StaticTestBed(**reader.numbers_below("static_test", *(f.name for f in fields(StaticTestBed)))),
        pitch_error=gear,
        ignored=tuple(sorted(reader.left)),
    )
    if reader.left and not shared:
        raise ParameterError(
            f"{source}: {', '.join(sorted(reader.left))}: no such value; check the spelling against "
            "config/my_reducer.yaml"
        )
    if case.speed <= 0.0 or case.speeds.start <= 0.0 or case.sweep.start <= 0.0:
        raise ParameterError(f"{source}: speed, speeds.start and sweep.start must be above 0")
    return case
