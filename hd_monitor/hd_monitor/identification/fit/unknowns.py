"""The unknowns of the estimation, and their places in one vector."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import BoolArray, ComplexArray, FloatArray
from ...model.parameters import Dynamics
from ...settings import Uncertainty
from ..segment.segment import FREQUENCY_MARGIN
from .hardening import LEVELS

TORQUE_LINES: Mapping[int, str] = {1: "", 2: ""}
"""Orders [cycles per output revolution] of unknown torques that are fitted along, and the part that each accuses.

The first two are the load's (gravity, and the fluctuation that mimics the other spline) and accuse nothing. A row that
names a part is said to stand out as soon as the data support it.
"""

EXACT = Uncertainty(
    natural_frequency=0.0,
    damping=0.0,
    inertia=0.0,
    hardening=0.0,
    measured_torque=0.0,
    assumed_torque=0.0,
    delay=0.0,
    clock_drift=0.0,
)
"""Nothing of what is given is in doubt."""

LARGEST_BETA = 0.1
"""Standard deviation of the first β before any data; of the k-th a k-th part, as pitch errors fall with their order."""

MEASURED_LOAD, ASSUMED_LOAD = 1.0, 2.0
"""Standard deviations of load fluctuations, in units of the reference torque, beside a measured torque or not."""

RELATIVE = 1.5
"""Standard deviation of ln(torque) where nothing is known of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknowns:
    """Layout of the vector of unknowns.

    The parts come in the order of the properties below; phasors as all their real parts, then all imaginary parts.

    Attributes
    ----------
    harmonics : int
        Line pairs, k = 1 … harmonics.
    load_orders : tuple of int
        Cycles per output revolution of the unknown load fluctuations.
    transmission_error : float
        Size [arcmin peak to peak] of the transmission error that is expected at each line before any data; 0: there is
        none, and none is fitted.
    uncertainty : Uncertainty
        How sure the scalars are that the parameters give.
    """

    harmonics: int
    load_orders: tuple[int, ...]
    transmission_error: float = 0.0
    uncertainty: Uncertainty = EXACT

    @property
    def circular_spline(self) -> slice:
        """Place of the circular spline's β phasors, one a harmonic."""
        return slice(0, 2 * self.harmonics)

    @property
    def flexspline(self) -> slice:
        """Place of the flexspline's β phasors."""
        return slice(2 * self.harmonics, 4 * self.harmonics)

    @property
    def stiffness(self) -> slice:
        """Place of all β."""
        return slice(0, 4 * self.harmonics)

    @property
    def load(self) -> slice:
        """Place of the load phasors, one an order, in units of the reference torque."""
        return slice(4 * self.harmonics, 4 * self.harmonics + 2 * len(self.load_orders))

    @property
    def circular_spline_error(self) -> slice:
        """Place of the phasors of the circular spline's transmission error [arcmin peak to peak], one a harmonic."""
        return slice(self.load.stop, self.load.stop + (2 * self.harmonics if self.transmission_error else 0))

    @property
    def flexspline_error(self) -> slice:
        """Place of the phasors of the flexspline's transmission error [arcmin peak to peak]."""
        circular_spline = self.circular_spline_error
        return slice(circular_spline.stop, 2 * circular_spline.stop - circular_spline.start)

    @property
    def displacement(self) -> slice:
        """Place of all transmission errors; empty where none is expected."""
        return slice(self.circular_spline_error.start, self.flexspline_error.stop)

    @property
    def frequency(self) -> int:
        """Place of ln(fn / given fn)."""
        return int(self.displacement.stop)

    @property
    def damping(self) -> int:
        """Place of ln(ζ / given ζ)."""
        return self.frequency + 1

    @property
    def torque(self) -> int:
        """Place of ln(torque / inertia), over that of those given."""
        return self.frequency + 2

    @property
    def delay(self) -> int:
        """Place of the time [s] by which the motion's stamps lag behind the vibration's."""
        return self.frequency + 3

    @property
    def drift(self) -> int:
        """Place of the rate [s/s] at which that time grows."""
        return self.frequency + 4

    @property
    def inertia(self) -> int:
        """Place of the part of the inertia whose own acceleration winds up the reducer beside the known torque."""
        return self.frequency + 5

    @property
    def hardening(self) -> slice:
        """Place of ln(stiffness / that at the reference torque), one at each other of the hardening's `LEVELS`."""
        return slice(self.frequency + 6, self.frequency + 5 + len(LEVELS))

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.hardening.stop)

    def load_line(self, order: int) -> list[int]:
        """Places of the real and the imaginary part of the load phasor at an order."""
        place = self.load.start + self.load_orders.index(order)
        return [place, place + len(self.load_orders)]

    def zero(self) -> FloatArray:
        """Return the vector of a healthy reducer with all that is given taken as right."""
        return np.zeros(self.size)

    def mask(self, *places: int | slice) -> BoolArray:
        """Mark some places, shape (unknowns,)."""
        mask = np.zeros(self.size, dtype=np.bool_)
        for place in places:
            mask[place] = True
        return mask

    def given_std(self, torque: float, load: float) -> FloatArray:
        """Standard deviations of the unknowns before any data, shape (unknowns,); 0 of what is known exactly.

        Parameters
        ----------
        torque : float
            Standard deviation of ln(torque): it depends on where the torque comes from.
        load : float
            Standard deviation of the load fluctuations that the torque does not contain, in units of the reference
            torque.
        """
        std = self._scale(0)
        std[self.load] = load
        std[self.torque] = math.hypot(torque, self.uncertainty.inertia)
        return std

    def bounds(self) -> FloatArray:
        """Magnitudes that the unknowns cannot exceed, shape (unknowns,): a value there is not a measurement."""
        return self._scale(1)

    def linear_range(self) -> FloatArray:
        """Steps over which the prediction's derivatives change by about their own size, shape (unknowns,).

        Near a resonance they are small.
        """
        return self._scale(2)

    def _scale(self, column: int) -> FloatArray:
        given = self.uncertainty
        fluctuation = np.tile(LARGEST_BETA / (1.0 + np.arange(self.harmonics)), 4)
        table: tuple[tuple[int | slice, float | FloatArray, float, float], ...] = (
            # place, standard deviation before any data, bound, linear range
            (self.stiffness, fluctuation, math.inf, 0.05),
            (self.load, ASSUMED_LOAD, math.inf, 1.0),
            (self.displacement, self.transmission_error / math.sqrt(2.0), math.inf, 5.0),
            (self.frequency, given.natural_frequency, math.log(FREQUENCY_MARGIN), 0.01),
            (self.damping, given.damping, 1.5, 0.3),
            (self.torque, RELATIVE, 4.0, 1.0),
            (self.delay, given.delay, 0.1, 5e-4),
            (self.drift, given.clock_drift, 1e-2, 5e-5),
            (self.inertia, 0.7, math.inf, 1.0),
            (self.hardening, given.hardening, 1.5, 0.1),
        )
        scale = np.empty(self.size)
        for place, *row in table:
            scale[place] = row[column]
        return scale

    def phasors(self, values: FloatArray, part: slice) -> ComplexArray:
        """Complex phasors of one of the parts, shape (harmonics,) or (load orders,)."""
        real, imaginary = np.split(values[part], 2)
        return np.asarray(real + 1j * imaginary)

    def dynamics(self, given: Dynamics, values: FloatArray) -> Dynamics:
        """Return the given dynamics with natural frequency and damping moved as `values` say."""
        if values[self.frequency] == 0.0 and values[self.damping] == 0.0:
            return given
        return replace(
            given,
            natural_frequency=given.natural_frequency * math.exp(values[self.frequency]),
            damping_ratio=given.damping_ratio * math.exp(values[self.damping]),
        )
