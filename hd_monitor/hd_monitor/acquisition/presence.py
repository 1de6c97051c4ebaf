"""Which inputs of a joint are missing: the one place that decides it, whatever the clock."""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from ..contract import NANOSECONDS
from ..settings import JointSettings
from ..sources import Quantity


class Absence(IntEnum):
    """How an input is missing; the larger, the worse."""

    AWAITED = 0
    """Nothing has come so far, as is to be expected of a system that starts."""
    OVERDUE = 1
    """Nothing has come for longer than ``input.startup_warning``."""
    UNUSABLE = 2
    """It comes, but nothing of it can be used."""
    LOST = 3
    """It comes no longer, or has not come within ``input.startup_timeout``."""


class Missing(NamedTuple):
    """An input that is missing, and how."""

    quantity: Quantity
    absence: Absence


@dataclass(slots=True)
class _Heard:
    """When an input was last heard, and last usable [ns], None while the clock has not begun; whether it ever was."""

    came: int | None = None
    useful: int | None = None
    ever: bool = False


class Presence:
    """Decides which of the inputs that a joint needs are missing.

    The monitor uses it with the clock of the stamps, the node with its own.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._heard = {quantity: _Heard() for quantity in settings.sources}
        self.change(settings)

    def change(self, settings: JointSettings) -> None:
        """Put other timeouts in force."""
        given = settings.input
        self._timeout = round(given.timeout * NANOSECONDS)
        self._startup_warning = round(given.startup_warning * NANOSECONDS)
        self._startup_timeout = round(given.startup_timeout * NANOSECONDS)

    @property
    def absent(self) -> tuple[Quantity, ...]:
        """Inputs from which nothing has come so far."""
        return tuple(quantity for quantity, heard in self._heard.items() if not heard.ever)

    def start(self, now: int | None) -> None:
        """Count silence from `now` [ns]; None: from the first look, as the clock has not begun."""
        for heard in self._heard.values():
            heard.came = heard.useful = now

    def await_anew(self, quantity: Quantity, now: int | None) -> None:
        """Expect an input from `now` [ns] on as if nothing of it had come: it is on another topic."""
        if quantity in self._heard:
            self._heard[quantity] = _Heard(now, now)

    def note(self, quantity: Quantity, came: int, useful: int | None = None) -> None:
        """Note when an input came, and when it was usable [ns]; None: it was not."""
        if (heard := self._heard.get(quantity)) is not None:
            if not heard.ever:  # what cannot be used yet has as much time as what has fallen silent
                heard.useful = came
            heard.ever = True
            heard.came = came
            heard.useful = heard.useful if useful is None else useful

    def missing(self, now: int) -> list[Missing]:
        """Return the inputs that are missing at `now` [ns]."""
        found = []
        for quantity, heard in self._heard.items():
            if heard.came is None or heard.useful is None or heard.came > now:  # the clock has begun, or was set back
                heard.came = heard.useful = now
            absence = self._absence(heard.ever, now - heard.came, now - heard.useful)
            if absence is not None:
                found.append(Missing(quantity, absence))
        return found

    def _absence(self, ever: bool, silent: int, useless: int) -> Absence | None:
        """How an input is missing from which nothing, and nothing usable, has come for so long [ns]."""
        if not ever:
            if silent >= self._startup_timeout:
                return Absence.LOST
            return Absence.OVERDUE if silent >= self._startup_warning else Absence.AWAITED
        if silent >= self._timeout:
            return Absence.LOST
        return Absence.UNUSABLE if useless >= self._timeout else None
