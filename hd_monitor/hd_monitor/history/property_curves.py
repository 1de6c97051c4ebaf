"""RMS of the vibration by speed, in the baseline and since: the paper's property curve before and after (Fig. 18)."""

from collections.abc import Sequence

from ..orders.rms_curve import SpeedBin, pooled_curve
from .entry import Entry
from .series import baseline_entries, comparable_entries


def property_curves(entries: Sequence[Entry]) -> tuple[tuple[SpeedBin, ...], tuple[SpeedBin, ...]]:
    """Return the curve of the baseline, and that of the newest entries since, as many as the baseline has at most."""
    kept, base = comparable_entries(entries), baseline_entries(entries)
    if not base:
        return (), ()
    later = kept[[id(entry) for entry in kept].index(id(base[-1])) + 1 :]
    width = kept[-1].rms_bin_width
    before, after = (
        pooled_curve((entry.rms_curve for entry in side if entry.rms_bin_width == width), width)
        for side in (base, later[-len(base) :])
    )
    return before, after
