"""Tones of fixed frequency in what fits leave of the vibration, remembered over the motion."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...orders.tones import LONG_ENOUGH, foreign_tones
from ..fit.normal_equations import LinearisedSegment

_OFTEN = 0.5  # part of the time for which a tone must be seen
_LEAST_TIME = 2.0  # s
_SAME = (0.15, 0.25)  # Hz, and bins of a segment's spectrum, by which sightings of one tone differ
_ONE_SPEED = 0.02  # relative range of the speed within which an order and a frequency are the same
_MOST_TONES = 16  # remembered


@dataclass(frozen=True, slots=True, kw_only=True)
class Tone:
    """Sightings of a tone of one frequency.

    Attributes
    ----------
    frequency : float
        [Hz]
    power : float
        Mean square of its amplitude [(rad/s²)²].
    time : float
        [s] of motion in which it was seen.
    slowest, fastest : float
        Output speeds [rad/s] at which it was seen.
    """

    frequency: float
    power: float
    time: float
    slowest: float
    fastest: float

    def joined(self, other: "Tone") -> "Tone":
        """Return both sightings as one."""
        time = self.time + other.time
        own, more = self.time / time, other.time / time
        return Tone(
            frequency=own * self.frequency + more * other.frequency,
            power=own * self.power + more * other.power,
            time=time,
            slowest=min(self.slowest, other.slowest),
            fastest=max(self.fastest, other.fastest),
        )

    @property
    def amplitude(self) -> float:
        """Root mean square of its amplitude [rad/s²]."""
        return math.sqrt(self.power)

    @property
    def orders(self) -> tuple[float, float]:
        """Lowest and highest order [cycles per output revolution] that it passed for."""
        turning = math.tau * self.frequency
        return turning / max(self.fastest, 1e-9), turning / max(self.slowest, 1e-9)

    @property
    def at_one_speed(self) -> bool:
        """Whether it may as well be a line that follows the angle."""
        return self.fastest - self.slowest < _ONE_SPEED * self.fastest


@dataclass(frozen=True, slots=True, kw_only=True)
class ToneWatch:
    """Tones in what fits leave, over all data seen.

    Attributes
    ----------
    tones : tuple of Tone
    time : float
        [s] of motion looked at.
    """

    tones: tuple[Tone, ...] = ()
    time: float = 0.0

    def after(self, segments: Iterable[LinearisedSegment], *, anew: bool) -> "ToneWatch":
        """Add the segments of a fit; forget earlier ones if it was a refit of all segments kept."""
        watch = ToneWatch() if anew else self
        for item in segments:
            if len(item.segment) >= LONG_ENOUGH:
                watch = watch._plus(item)
        return watch

    def faded(self, keep: float) -> "ToneWatch":
        """Return the watch of data that count `keep` times."""
        return ToneWatch(tones=tuple(replace(t, time=keep * t.time) for t in self.tones), time=keep * self.time)

    @property
    def lasting(self) -> list[Tone]:
        """Tones that are there for most of the time, the strongest first."""
        if self.time < _LEAST_TIME:
            return []
        often = [tone for tone in self.tones if tone.time >= _OFTEN * self.time]
        return sorted(often, key=lambda tone: -tone.power)

    def _plus(self, item: LinearisedSegment) -> "ToneWatch":
        tones, (constant, bins) = list(self.tones), _SAME
        for seen in _tones_of(item):
            apart = [abs(tone.frequency - seen.frequency) for tone in tones]
            nearest = int(np.argmin(apart)) if apart else -1
            if nearest >= 0 and apart[nearest] < constant + bins / item.segment.duration:
                tones[nearest] = tones[nearest].joined(seen)
            else:
                tones.append(seen)
        tones.sort(key=lambda tone: -tone.time)
        return ToneWatch(tones=tuple(tones[:_MOST_TONES]), time=self.time + item.segment.duration)


def _tones_of(item: LinearisedSegment) -> Iterator[Tone]:
    """Tones in what a fit leaves of a segment: the lines are explained, so they may stand anywhere."""
    segment = item.segment
    left = np.where(segment.used, item.linearisation.residual, 0.0)
    slowest, fastest = np.percentile(np.abs(segment.speed), (5.0, 95.0))
    for frequency in foreign_tones(left, segment.period, np.empty((0, 2)), 0.0):
        turn = np.exp(-1j * math.tau * frequency * segment.period * np.arange(left.size))
        amplitude = 2.0 * abs(complex(left @ turn)) / max(int(np.count_nonzero(segment.used)), 1)
        yield Tone(
            frequency=float(frequency),
            power=amplitude**2,
            time=segment.duration,
            slowest=float(slowest),
            fastest=float(fastest),
        )
