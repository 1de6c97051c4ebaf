"""One self-contained HTML page: the claims' table and the figures."""

import base64
from collections.abc import Mapping
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from .exhibit import Exhibit
from .table import summary

PAGE = "index.html"


def write_report(exhibits: Mapping[str, Exhibit], folder: Path, *, heading: str, command: str) -> Path:
    """Write the figures as PNG and the page into a folder, created if missing; return the page's path.

    `command` is the one that produced the exhibits.
    """
    from .drawing import png

    folder.mkdir(parents=True, exist_ok=True)
    pictures = {name: png(name, exhibit) for name, exhibit in exhibits.items() if exhibit.panels}
    for name, data in pictures.items():
        (folder / f"{name}.png").write_bytes(data)
    path = folder / PAGE
    environment = Environment(
        loader=PackageLoader("hd_monitor.paper", "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    content = environment.get_template("page.html.j2").render(
        heading=heading,
        command=command,
        exhibits=exhibits,
        claims=any(exhibit.claims for exhibit in exhibits.values()),
        summary=summary(exhibits.values()),
        pictures={name: base64.b64encode(data).decode("ascii") for name, data in pictures.items()},
    )
    path.write_text(content, encoding="utf-8")
    return path
