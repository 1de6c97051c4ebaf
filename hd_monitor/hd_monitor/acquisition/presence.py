"""Which inputs of a joint are lost: the one place that decides it, whatever the clock."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from ..sources import Quantity


class Loss(NamedTuple):
    """An input that is lost."""

    quantity: Quantity
    silent: bool
    """Whether nothing comes; otherwise messages come, but none can be used."""
    since: int
    """How long nothing, or nothing usable, has come [ns]."""


@dataclass(slots=True)
class _Heard:
    """When an input was last heard, and last usable [ns], None while the clock has not begun; whether it ever was."""

    came: int | None = None
    useful: int | None = None
    ever: bool = False


class Presence:
    """Decides which inputs are lost: those from which nothing, or nothing usable, came for a while.

    The monitor uses it with the clock of the stamps, the node with its own.

    Parameters
    ----------
    quantities : iterable of Quantity
        The inputs that the joint needs.
    timeout : int
        Silence after which an input is lost [ns].
    """

    def __init__(self, quantities: Iterable[Quantity], timeout: int) -> None:
        self._timeout = timeout
        self._heard = {quantity: _Heard() for quantity in quantities}

    @property
    def timeout(self) -> float:
        """Silence after which an input is lost [s]."""
        return self._timeout * 1e-9

    @property
    def absent(self) -> tuple[Quantity, ...]:
        """Inputs from which nothing has come so far."""
        return tuple(quantity for quantity, heard in self._heard.items() if not heard.ever)

    def start(self, now: int | None) -> None:
        """Count silence from `now` [ns]; None: from the first look, as the clock has not begun."""
        for heard in self._heard.values():
            heard.came = heard.useful = now

    def note(self, quantity: Quantity, came: int, useful: int | None = None) -> None:
        """Note when an input came, and when it was usable [ns]; None: it was not."""
        if (heard := self._heard.get(quantity)) is not None:
            heard.ever = True
            heard.came = came
            heard.useful = heard.useful if useful is None else useful

    def losses(self, now: int) -> list[Loss]:
        """Return the inputs that are lost at `now` [ns]."""
        found = []
        for quantity, heard in self._heard.items():
            if heard.came is None or heard.useful is None or heard.came > now:  # the clock has begun, or was set back
                heard.came = heard.useful = now
            if now - heard.useful >= self._timeout:
                silent = now - heard.came >= self._timeout
                found.append(Loss(quantity, silent, now - (heard.came if silent else heard.useful)))
        return found
