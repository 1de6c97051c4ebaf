"""``hd-monitor gallery``: simulate every effect of a real drive alone and write a page with a picture of them."""

import argparse
import sys
from functools import cache
from pathlib import Path

from hd_monitor.offline.output import check_folder, write_folder

from .effects import zoom_of
from .page import PICTURES, page


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.description = (
        "Simulates the paper's drive with each effect of a real drive alone, with all at once and with each fault of "
        f"the sensor, and writes rig.md with {' and '.join(PICTURES)}: what each does to the zoom spectrum, the "
        "equation of motion, and where the numbers of the presets come from."
    )
    parser.add_argument("--out", required=True, type=Path, metavar="DIR", help="folder to write to")
    parser.add_argument("--text-only", action="store_true", help="write the page but not the pictures")


def run(arguments: argparse.Namespace) -> int:
    """Simulate and write."""
    check_folder(arguments.out)
    if not arguments.text_only:
        from hd_monitor.offline.plots.style import png

        from .picture import gallery_picture

        zoom = cache(lambda settings: zoom_of(dict(settings)))  # the grounds are few
        for place, effects in PICTURES.items():
            pairs = []
            for effect in effects:
                print(effect.name, file=sys.stderr, flush=True)
                both = {**effect.ground, **effect.settings}
                pairs.append((zoom(tuple(effect.ground.items())), zoom(tuple(both.items()))))
            picture = arguments.out / place
            drawn = png(gallery_picture([effect.name for effect in effects], pairs))
            write_folder(picture.parent, {picture.name: drawn})
    write_folder(arguments.out, {"rig.md": page()})
    print(arguments.out / "rig.md")
    return 0
