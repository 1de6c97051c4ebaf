"""Watches whether the vibration belongs to other tooth numbers than those given."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...limitation import Limitation
from ...model.parameters import Dynamics
from ...orders.order_spectrum import OrderSpectrum
from ...reducer import Reducer
from ..fit.gauss_newton import Fit
from .candidates import ToothPair, strongest
from .ranking import contradiction, rank, shows_two_lines
from .spectrum import with_segment

FIRST_LOOK = 3.4
"""Motion [s] from which tooth numbers are questioned, and before which nothing is named."""

LEAD = 35.0
"""Log evidence by which other teeth must lead: far above chance, for lines that change with the speed are none that the
regression knows, and with those the right teeth were seen to trail others by up to 29."""

GROWTH = 1.5
"""Factor by which motion must grow before the same candidates are compared once more."""

APART = 1.0
"""Output revolutions from which two lines are seen as two, and not mistaken for a tone between them."""

NEAR = 4.5
"""Difference of tooth numbers up to which pairs share a line, or less travel than that blurs one into the other."""

LEAST_TURNS = 0.2
"""Output revolutions below which the order spectrum is too blurred for any conclusion."""

SHARE = 0.02
"""Part of the largest line that an unexplained one must have to matter."""

_STANDS_OUT = 5.0  # medians of the spectrum: 3e-8 by chance
_STRONG, _AROUND = 0.25, 6  # of the largest amplitude within so many orders
_LOWEST_ORDER = 20  # gravity, friction and the load's own orders lie below


@dataclass(frozen=True, kw_only=True)
class ToothWatch:
    """What is known of the tooth numbers.

    Attributes
    ----------
    signal, residual : OrderSpectrum
        Of the vibration, and of what the fit with the given teeth leaves of it.
    asked : tuple of ToothPair
        Candidates that were compared last.
    seconds, tried : float
        Motion seen [s] by then, and when neighbours were last put to trial, which costs as much as a fit.
    doubt : Limitation or None
        Why no part may be named, if other tooth numbers explain the vibration better.
    """

    signal: OrderSpectrum = field(default_factory=OrderSpectrum)
    residual: OrderSpectrum = field(default_factory=OrderSpectrum)
    asked: tuple[ToothPair, ...] = ()
    seconds: float = 0.0
    tried: float = 0.0
    doubt: Limitation | None = None

    def after(self, fit: Fit, dynamics: Dynamics, *, anew: bool) -> "ToothWatch":
        """Add the segments of a fit; forget earlier ones if it was a refit of all segments kept."""
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
        given: Reducer,
        harmonics: int,
        trial: Callable[[Reducer, Sequence[Reducer]], Reducer | None],
        *,
        seconds: float,
        one_speed: bool,
        poor: bool = False,
    ) -> "ToothWatch":
        """Compare other tooth numbers with those given, once for each change of the evidence for them.

        Parameters
        ----------
        given : Reducer
        harmonics : int
        trial : callable
            Decides between the given reducer and others near it where lines alone do not, see :meth:`ToothTrial.best`.
        seconds : float
            Motion seen.
        one_speed : bool
            Whether all of it was at one speed: then a tone of fixed frequency looks like one line, and only both
            lines of a pair are evidence. Else any two lines are.
        poor : bool
            Whether the fit with the teeth given leaves more at their lines than noise could: then lines where they
            should be are no proof of them, as a load's side lines fall on those of neighbours.
        """
        if seconds < FIRST_LOOK:
            return self
        if not (self._is_unexplained or poor):
            return replace(self, asked=(), doubt=None)
        candidates = strongest(self.signal.amplitudes, given, harmonics)
        asked = tuple(candidate.teeth for candidate in candidates)
        if asked == self.asked and seconds < GROWTH * self.seconds:
            return self
        ranking = rank(candidates, [self.signal.solve])
        best, own = ranking.ranked[0], ToothPair.of(given)
        far = self.signal.turns > APART
        shown = {candidate.teeth for candidate in candidates if far and shows_two_lines(candidate, [self.signal.solve])}
        looked = replace(self, asked=asked, seconds=seconds)
        stands = own in shown and self._are_strong(own)  # a tone beside them makes another pair with one of the two
        if stands and not poor:
            return replace(looked, doubt=None)
        # one line that those given do not have may be a tone beside one that they do
        foreign = set(best.lines).difference(*map(own.lines, range(1, harmonics + 1)))
        found = len(foreign) > 1 and (best.teeth in shown or (best.pairs_found > 1 and not one_speed))
        if found and not stands and ranking.lead(own) > LEAD:
            return replace(looked, doubt=ranking.contradiction(given))
        open_to = set(asked) if (poor or self.signal.turns < APART) and not one_speed else shown
        near = [
            teeth
            for teeth in ranking.contenders(own, LEAD)
            if teeth in open_to and abs(teeth[0] - own[0]) < NEAR and (teeth.is_in_catalogue or not own.is_in_catalogue)
        ]
        if not near:
            return looked if poor else replace(looked, doubt=None)
        if seconds < GROWTH * self.tried:
            return looked
        better = trial(given, [teeth.reducer(given.mount) for teeth in near])
        doubt = contradiction(given, ToothPair.of(better)) if better is not None else None
        return replace(looked, tried=seconds, doubt=doubt)

    def _are_strong(self, teeth: ToothPair) -> bool:
        """Whether both first lines are of the size of what is around them: side lines of a load are weaker."""
        amplitudes = self.signal.amplitudes
        low, high = (int(order) for order in teeth)
        around = amplitudes[max(0, low - _AROUND) : high + _AROUND + 1]
        return float(min(amplitudes[low], amplitudes[high])) > _STRONG * float(around.max())

    @property
    def _is_unexplained(self) -> bool:
        """Whether the residual has a line that noise does not make, of a size that matters."""
        if self.signal.turns < LEAST_TURNS:
            return False
        left, whole = (spectrum.amplitudes[_LOWEST_ORDER:] for spectrum in (self.residual, self.signal))
        return float(left.max()) > max(_STANDS_OUT * float(np.median(left)), SHARE * float(whole.max()))
