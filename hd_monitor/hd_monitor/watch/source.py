"""What feeds the screen."""

from typing import Protocol

from .state import View


class Source(Protocol):
    """Turns what has come in into the next view; a replay gives the same type as a robot does.

    Attributes
    ----------
    pause : float
        Seconds to wait between two looks.
    """

    pause: float

    def begin(self) -> View:
        """Return the view of nothing yet."""
        ...

    def update(self, view: View, now: float) -> View:
        """Return the view at the time `now` [s], of a clock that is never set back."""
        ...

    def close(self) -> None:
        """Leave."""
        ...
