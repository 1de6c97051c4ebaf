"""The report: one HTML page that holds everything, and its pictures as files beside it."""

import base64
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from ...diagnosis.uncertain import with_std
from ..output import write_folder
from ..result import JointResult
from .collector import Collector
from .pictures import PICTURE_NAMES, pictures, unit_of

PAGE = "index.html"


def write_report(
    folder: Path, content: Mapping[str, Any], joints: Sequence[JointResult], collectors: Mapping[str, Collector]
) -> Path:
    """Write the page of a replay, whose JSON is `content`, as `write_page` does; `collectors` are by joint."""
    sections = []
    for result, entry in zip(joints, content["joints"], strict=True):
        collector = collectors[result.plan.joint]
        sections.append(
            {
                "joint": result.plan.joint,
                "entry": entry,
                "unusable": result.unusable,
                "unit": unit_of(result.plan.settings.input.source),
                "pictures": pictures(result.last, result.timeline, collector),
                "seconds": collector.seconds,
                "motion_seconds": collector.motion_seconds,
            }
        )
    return write_page(folder, "offline/report/report.html.j2", content, sections, PICTURE_NAMES)


def render(template: str, **values: Any) -> str:
    """Fill in one of the package's page templates, given by its path."""
    environment = Environment(
        loader=PackageLoader("hd_monitor", ""),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["data_uri"] = lambda png: "data:image/png;base64," + base64.b64encode(png).decode("ascii")
    environment.filters["with_std"] = with_std
    return environment.get_template(template).render(values)


def write_page(
    folder: Path, template: str, content: Mapping[str, Any], sections: Sequence[Mapping[str, Any]], names: Sequence[str]
) -> Path:
    """Write the page that a template makes, and its sections' pictures, into a folder.

    The folder is made if it is not there. Pictures of these `names` that an earlier report left and this one does not
    have are taken away: they would seem to belong.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OutputError
        If the folder cannot be written; an earlier report is still there.
    """
    files: dict[str, str | bytes] = {PAGE: render(template, content=content, sections=sections)}
    stale = []
    for section in sections:
        prefix = re.sub(r"[^\w.-]+", "_", section["joint"]) + "_" if len(sections) > 1 else ""
        for name in names:
            picture = f"{prefix}{name}.png"
            if name in section["pictures"]:
                files[picture] = section["pictures"][name]
            else:
                stale.append(picture)
    write_folder(folder, files, stale)
    return folder / PAGE
