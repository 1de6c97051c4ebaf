"""Geometry of a harmonic drive: its orders, line frequencies and the travel that separates them."""

import math
from dataclasses import dataclass
from enum import StrEnum
from numbers import Real
from typing import NamedTuple

from .errors import GeometryError, ParameterError

WAVE_GENERATOR_LOBES = 2
"""An elliptic wave generator meshes at two opposite places."""

ARCMIN = math.pi / 10_800.0
"""One minute of arc in radians: catalogues state transmission errors in it, peak to peak."""


class Mount(StrEnum):
    """The spline that stands still."""

    CIRCULAR_SPLINE_FIXED = "circular_spline_fixed"
    FLEXSPLINE_FIXED = "flexspline_fixed"


class LinePair(NamedTuple):
    """One value for the circular spline's (left, lower) line and one for the flexspline's (right, higher)."""

    circular_spline: float
    flexspline: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Reducer:
    """A harmonic drive with a two-lobe wave generator.

    Parameters
    ----------
    flexspline_teeth : int
        Teeth of the flexspline, z1.
    circular_spline_teeth : int
        Teeth of the circular spline, z2; larger than z1 by a multiple of the two lobes, nearly always by 2.
    mount : Mount or str
        The spline that stands still; the other one is the output.

    Raises
    ------
    GeometryError
        If no harmonic drive with these numbers could be assembled; the message says why.

    Notes
    -----
    A stiffness defect of the circular spline repeats with ``circular_spline_order`` cycles per wave-generator
    revolution and one of the flexspline with ``flexspline_order`` (Gu et al. 2021, section 2.1). Seen from the
    output the two are whole numbers in both mounts: z1 cycles per revolution for the circular spline and z2 for
    the flexspline (with a tooth difference of 2).

    Examples
    --------
    >>> rig = Reducer(flexspline_teeth=160, circular_spline_teeth=162)
    >>> rig.reduction, rig.circular_spline_order, rig.flexspline_order
    (80.0, 2.0, 2.025)
    >>> rig.line_frequencies(speed_rpm=750.0)
    LinePair(circular_spline=25.0, flexspline=25.3125)
    """

    flexspline_teeth: int = 160
    circular_spline_teeth: int = 162
    mount: Mount = Mount.CIRCULAR_SPLINE_FIXED

    def __post_init__(self) -> None:
        """Refuse impossible geometries."""
        for name in ("flexspline_teeth", "circular_spline_teeth"):
            value: object = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Real) or not float(value).is_integer():
                raise GeometryError(f"{name} = {value!r} is not a whole number; a gear has whole teeth: count them")
            object.__setattr__(self, name, round(float(value)))
        z1, z2 = self.flexspline_teeth, self.circular_spline_teeth
        if z1 < 1:
            raise GeometryError(f"flexspline_teeth = {z1} is not a number of teeth; count those of the flexspline")
        if z2 <= z1:
            raise GeometryError(
                f"circular_spline_teeth = {z2} is not above flexspline_teeth = {z1}: the flexspline runs inside the "
                "circular spline and has fewer teeth (usually 2 fewer); are the two numbers swapped?"
            )
        if (z2 - z1) % WAVE_GENERATOR_LOBES:
            raise GeometryError(
                f"the tooth difference {z2} - {z1} = {z2 - z1} is odd: a two-lobe wave generator meshes at two "
                "opposite places, which then would not fit at once; the difference must be even (usually 2)"
            )
        if z2 - z1 > z1 // 2:
            raise GeometryError(
                f"the tooth difference {z2} - {z1} = {z2 - z1} requires the flexspline to deflect by more than a "
                "quarter of its size, which none survives; check the tooth numbers (the difference is usually 2)"
            )
        try:
            object.__setattr__(self, "mount", Mount(self.mount))
        except ValueError:
            names = ", ".join(m.value for m in Mount)
            raise GeometryError(f"mount = {self.mount!r} is unknown; choose one of: {names}") from None

    @property
    def tooth_difference(self) -> int:
        """Teeth that the circular spline has more than the flexspline, z2 - z1."""
        return self.circular_spline_teeth - self.flexspline_teeth

    @property
    def reduction(self) -> float:
        """Wave-generator revolutions per output revolution (magnitude)."""
        output_from = self.flexspline_teeth if self.mount is Mount.CIRCULAR_SPLINE_FIXED else self.circular_spline_teeth
        return output_from / self.tooth_difference

    @property
    def output_orders(self) -> LinePair:
        """Cycles of the first line pair per output revolution: (z1, z2) for a tooth difference of 2, in both mounts."""
        scale = WAVE_GENERATOR_LOBES / self.tooth_difference
        return LinePair(self.flexspline_teeth * scale, self.circular_spline_teeth * scale)

    @property
    def circular_spline_order(self) -> float:
        """Cycles of the circular spline's first line per wave-generator revolution."""
        return self.output_orders.circular_spline / self.reduction

    @property
    def flexspline_order(self) -> float:
        """Cycles of the flexspline's first line per wave-generator revolution."""
        return self.output_orders.flexspline / self.reduction

    def line_frequencies(self, speed_rpm: float, k: int = 1) -> LinePair:
        """Frequencies [Hz] of the k-th line pair at a wave-generator speed [rpm].

        With the circular spline fixed its line is at ``2 n / 60`` and the flexspline's at ``2 n / 60 * z2 / z1``.
        """
        self._check_harmonic(k)
        per_second = k * abs(speed_rpm) / 60.0
        return LinePair(self.circular_spline_order * per_second, self.flexspline_order * per_second)

    def line_separation(self, speed_rpm: float, k: int = 1) -> float:
        """Distance [Hz] of the two lines of the k-th pair at a wave-generator speed [rpm].

        With the circular spline fixed this is eq. 5 of Gu et al. 2021, ``k n / 30 (z2 / z1 - 1)``.
        """
        pair = self.line_frequencies(speed_rpm, k)
        return pair.flexspline - pair.circular_spline

    def travel_to_separate(self, k: int = 1, *, window: str = "hann") -> float:
        """Output travel [rad] after which a Fourier spectrum shows the k-th pair as two lines.

        The pair is exactly 2k cycles per output revolution apart at any speed, so what counts is travel, not time:
        180°/k for a rectangular window, twice that for a Hann window (whose main lobe is twice as wide).

        Raises
        ------
        ParameterError
            If `k` is below 1 or the window is neither ``'hann'`` nor ``'boxcar'``.
        """
        self._check_harmonic(k)
        widths = {"boxcar": 1.0, "hann": 2.0}
        if window not in widths:
            raise ParameterError(f"window = {window!r} is unknown; choose 'hann' or 'boxcar'")
        return widths[window] * math.tau / (WAVE_GENERATOR_LOBES * k)

    @staticmethod
    def _check_harmonic(k: int) -> None:
        if k < 1:
            raise ParameterError(f"k = {k}: line pairs are counted from 1")
