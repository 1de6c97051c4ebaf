"""One self-contained HTML page: the claims' table and the figures."""

from collections.abc import Mapping
from pathlib import Path

from ..offline.report.page import PAGE, render
from .drawing import png
from .exhibit import Exhibit
from .table import summary


def write_report(exhibits: Mapping[str, Exhibit], folder: Path, *, heading: str, command: str) -> Path:
    """Write the figures as PNG and the page into a folder, created if missing; return the page's path.

    `command` is the one that produced the exhibits.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {name: png(name, exhibit) for name, exhibit in exhibits.items() if exhibit.panels}
    for name, data in pictures.items():
        (folder / f"{name}.png").write_bytes(data)
    path = folder / PAGE
    content = render(
        "paper/page.html.j2",
        heading=heading,
        command=command,
        exhibits=exhibits,
        claims=any(exhibit.claims for exhibit in exhibits.values()),
        summary=summary(exhibits.values()),
        pictures=pictures,
    )
    path.write_text(content, encoding="utf-8")
    return path
