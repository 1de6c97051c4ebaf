"""RMS of the vibration against speed: the paper's property curve (Figs. 16 and 18)."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from ...orders.rms_curve import SpeedBin
from .style import AFTER, BEFORE, INK, SOFT, Look, legend_above, name_at_top, one_panel, room_above

_ALONE = Look(label="RMS", colour=INK, marker="o", line="-")


def rms_plot(*curves: Sequence[SpeedBin], critical: Sequence[tuple[float, str]], title: str) -> Figure:
    """Draw a property curve, or those before and after a change; `critical` are speeds [rpm] with their names."""
    with one_panel(title=title, xlabel="wave-generator speed [rpm]", ylabel="RMS of the vibration [m/s²]") as drawn:
        figure, axes = drawn
        for bins, look in zip(curves, (BEFORE, AFTER) if len(curves) > 1 else (_ALONE,), strict=True):
            speeds, values = [b.rpm for b in bins], [b.rms for b in bins]
            axes.plot(
                speeds, values, look.line, marker=look.marker, markersize=4.5, color=look.colour, label=look.label
            )
        axes.set_ylim(bottom=0.0)
        low, high = axes.get_xlim()
        inside = [(speed, name) for speed, name in critical if low <= speed <= high]
        if inside:
            room_above(axes, 0.12)
        for speed, name in inside:
            axes.axvline(speed, color=SOFT, linestyle=":", linewidth=1.2)
            name_at_top(axes, speed, name, color=SOFT)
        if len(curves) > 1:
            legend_above(axes)
        return figure
