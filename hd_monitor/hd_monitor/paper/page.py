"""One self-contained HTML page: the claims' table and the figures."""

from collections.abc import Mapping
from pathlib import Path

from ..offline.output import write_folder
from ..offline.report.page import PAGE, render
from .drawing import png
from .exhibit import Exhibit
from .table import summary


def write_report(exhibits: Mapping[str, Exhibit], folder: Path, *, heading: str, command: str) -> Path:
    """Write the figures as PNG and the page into a folder, created if missing; return the page's path.

    `command` is the one that produced the exhibits.
    """
    pictures = {name: png(name, exhibit) for name, exhibit in exhibits.items() if exhibit.panels}
    content = render(
        "paper/page.html.j2",
        heading=heading,
        command=command,
        exhibits=exhibits,
        claims=any(exhibit.claims for exhibit in exhibits.values()),
        summary=summary(exhibits.values()),
        pictures=pictures,
    )
    write_folder(folder, {PAGE: content, **{f"{name}.png": data for name, data in pictures.items()}})
    return folder / PAGE
