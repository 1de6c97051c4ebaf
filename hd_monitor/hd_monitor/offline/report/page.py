"""The report: one HTML page that holds everything, and its pictures as files beside it."""

import base64
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from ...diagnosis.verdict import Level
from ...errors import ParameterError
from ..result import JointResult
from .collector import Collector
from .pictures import PICTURE_NAMES, pictures, unit_of
from .quality_table import quality_rows

PAGE = "index.html"

_FIGURES = (
    "speed (rpm)",
    "rms (m/s^2)",
    "travel (deg)",
    "travel needed (deg)",
    "signal to noise (dB)",
    "misfit",
    "natural frequency (Hz)",
    "damping ratio",
    "load fluctuation (N*m)",
    "unstable from (rpm)",
)


def render(template: str, **values: Any) -> str:
    """Fill in one of the package's page templates."""
    environment = Environment(
        loader=PackageLoader("hd_monitor.offline.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["data_uri"] = lambda png: "data:image/png;base64," + base64.b64encode(png).decode("ascii")
    return environment.get_template(template).render(**values)


def write_report(
    folder: Path, content: Mapping[str, Any], joints: Sequence[JointResult], collectors: Mapping[str, Collector]
) -> Path:
    """Write the page of a replay and its pictures into a folder, which is made if it is not there.

    Parameters
    ----------
    folder : Path
    content : mapping
        The replay's JSON.
    joints : sequence of JointResult
    collectors : mapping of str to Collector
        By joint.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    ParameterError
        If the folder cannot be written.
    """
    sections = []
    for result, entry in zip(joints, content["joints"], strict=True):
        collector = collectors[result.plan.joint]
        sections.append(
            {
                "joint": result.plan.joint,
                "entry": entry,
                "level": Level(entry["verdict"]["level"]).name if entry["verdict"] else "none",
                "unusable": result.unusable,
                "figures": [(name, entry["status"][name]) for name in _FIGURES if name in entry.get("status", {})],
                "unit": unit_of(result.plan.settings.input.source),
                "rows": quality_rows(result, collector),
                "pictures": list(pictures(result, collector)),
                "seconds": collector.seconds,
            }
        )
    page = render("report.html.j2", content=content, sections=sections)
    several = len(sections) > 1
    files = {}
    possible: set[str] = set()
    for section in sections:
        prefix = re.sub(r"[^\w.-]+", "_", section["joint"]) + "_" if several else ""
        files.update({prefix + picture.name: picture.png for picture in section["pictures"]})
        possible.update(prefix + name for name in PICTURE_NAMES)
    return write_files(folder, page, files, outdated=possible - set(files))


def write_files(folder: Path, page: str, files: Mapping[str, bytes], *, outdated: Iterable[str] = ()) -> Path:
    """Write a page and pictures into a folder; return the page's path.

    Pictures of an earlier report that this one does not have (`outdated`) are taken away: they would seem to belong.

    Raises
    ------
    ParameterError
        If the folder cannot be written.
    """
    path = folder / PAGE
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(page, encoding="utf-8")
        for name, png in files.items():
            (folder / f"{name}.png").write_bytes(png)
        for name in outdated:
            (folder / f"{name}.png").unlink(missing_ok=True)
    except OSError as error:
        raise ParameterError(f"{folder} cannot be written: {error.strerror}; choose another folder") from None
    return path
