"""Watches whether the vibration belongs to other tooth numbers than those given: suspicion by lines, proof by fits."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from ...model.parameters import Dynamics
from ...orders.spectrum import OrderSpectrum, with_segment
from ...reducer import Reducer
from ..fit.gauss_newton import Fit
from .candidates import APART, ToothSuspect, tooth_suspects, unexplained
from .trial import Lead

FIRST_LOOK = 3.4
"""Motion [s] from which tooth numbers are questioned, and before which nothing is named."""

OFTEN, RARE = 1.5, 3.0
"""Factors by which motion must grow between looks while there are less than `YOUNG` seconds of it, and later."""

YOUNG = 10.0
"""Motion [s]."""

PROOF = 50.0
"""Logarithm of the likelihood ratio by which other teeth must beat those given."""

GAIN, GAIN_NEAR, GAIN_APART = 1.5, 1.15, 1.05
"""Variance left with the given teeth over that left with others, from which these are believed even where their lines
are not found one by one: a tone, smeared over the orders by a changing speed, can be mimicked in part, but not so far.
The second one is for teeth `NEAR` those given, which mimic a tone no better than these do, the third one for the same
where travel parts the two lines."""

NEAR = 4.5
"""Difference of the tooth numbers."""

_MOST_LATE = 2  # suspects tried once there are more than `YOUNG` seconds


@dataclass(frozen=True, kw_only=True)
class ToothWatch:
    """What is known of the tooth numbers.

    Attributes
    ----------
    signal, residual : OrderSpectrum
        Of the vibration, and of what the fit with the given teeth leaves of it.
    looked : float
        Motion [s] at the last look.
    rival : ToothSuspect or None
        Other tooth numbers that explain the vibration better.
    """

    signal: OrderSpectrum = field(default_factory=OrderSpectrum)
    residual: OrderSpectrum = field(default_factory=OrderSpectrum)
    looked: float = 0.0
    rival: ToothSuspect | None = None

    def after(self, fit: Fit, dynamics: Dynamics, *, anew: bool) -> "ToothWatch":
        """Add the segments of a fit; forget those before if it was made anew of all at hand."""
        signal, residual = (OrderSpectrum(), OrderSpectrum()) if anew else (self.signal, self.residual)
        for item in fit.segments:
            signals = item.segment.acceleration, item.linearisation.residual
            signal, residual = with_segment((signal, residual), item.segment, signals, dynamics)
        return replace(self, signal=signal, residual=residual)

    def faded(self, keep: float) -> "ToothWatch":
        """Return the watch with the weight of its sums multiplied by `keep`."""
        return replace(self, signal=self.signal.faded(keep), residual=self.residual.faded(keep))

    def look(
        self,
        leads: Callable[[Reducer, Sequence[Reducer]], tuple[Lead, ...]],
        given: Reducer,
        harmonics: int,
        *,
        seconds: float,
        one_speed: bool,
    ) -> "ToothWatch":
        """Question the tooth numbers if the lines give reason to, as often as effort allows.

        Parameters
        ----------
        leads : callable
            Compares the given reducer (first argument) with others, see :meth:`ToothTrial.leads`.
        given : Reducer
        harmonics : int
        seconds : float
            Motion seen.
        one_speed : bool
            Whether all of it was at one speed.
        """
        if seconds < FIRST_LOOK or seconds < (OFTEN if seconds < YOUNG else RARE) * self.looked:
            return self
        if not unexplained(self.signal, self.residual):
            return replace(self, rival=None)
        suspects: tuple[ToothSuspect, ...]
        if self.rival is not None and seconds >= YOUNG:
            suspects = (self.rival,)  # once found, it need only be confirmed now and then
        else:
            suspects = tooth_suspects(self.signal, given, harmonics, one_speed=one_speed)
        if not suspects:
            return replace(self, rival=None)
        if seconds >= YOUNG:
            suspects = suspects[:_MOST_LATE]
        lead = leads(given, [suspect.reducer for suspect in suspects])
        best = max(range(len(suspects)), key=lambda number: lead[number].log_odds)
        suspect, found = suspects[best], lead[best]
        apart = abs(suspect.reducer.output_orders.circular_spline - given.output_orders.circular_spline)
        near = GAIN_APART if self.signal.turns > APART else GAIN_NEAR
        gain = 1.0 if suspect.evident else near if apart < NEAR else GAIN
        proven = found.log_odds > PROOF and found.gain > gain
        return replace(self, looked=seconds, rival=suspect if proven else None)

    def blocker(self, given: Reducer) -> str:
        """Say why no part may be named; empty if the teeth given are not in doubt."""
        if self.rival is None:
            return ""
        own, other = (f"{r.flexspline_teeth}/{r.circular_spline_teeth}" for r in (given, self.rival.reducer))
        if self.rival.lines:
            shown = ", ".join(f"{line:g}" for line in self.rival.lines)
            found = f"lines stand at {shown} cycles per output revolution, and {other} teeth explain them"
        else:
            found = f"{other} teeth, or numbers near by, explain the vibration"
        return (
            f"Check the tooth numbers: {found} far better than the {own} given; correct reducer.flexspline_teeth and "
            "reducer.circular_spline_teeth, for with wrong ones no part can be named"
        )
