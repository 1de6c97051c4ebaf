"""The phase trace: velocity over displacement of the torsional vibration (Fig. 17 of Gu et al. 2021)."""

from matplotlib.figure import Figure

from ..report.phase_trace import PhaseTrace
from .style import CIRCULAR_SPLINE, new_figure


def phase_plot(trace: PhaseTrace, *, title: str) -> Figure:
    """Draw a phase trace."""
    with new_figure((6.0, 5.4)) as figure:
        axes = figure.add_subplot()
        axes.plot(1e6 * trace.displacement, 1e3 * trace.velocity, color=CIRCULAR_SPLINE.colour, linewidth=0.7)
        axes.set_xlabel("displacement [µrad]")
        axes.set_ylabel("velocity [mrad/s]")
        axes.set_title(title)
        return figure
