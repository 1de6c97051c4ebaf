"""``hd-monitor gallery``: simulate every effect of a real drive alone and write a page with a picture of them."""

import argparse
import sys
from pathlib import Path

from .effects import EFFECTS, zoom_of
from .page import PICTURE, page


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.description = (
        "Simulates the paper's drive with each effect of a real drive alone and with all at once, and writes rig.md "
        f"with {PICTURE}: what each does to the zoom spectrum, and where the numbers of the presets come from."
    )
    parser.add_argument("--out", required=True, type=Path, metavar="DIR", help="folder to write to")
    parser.add_argument("--text-only", action="store_true", help="write the page but not the picture")


def run(arguments: argparse.Namespace) -> int:
    """Simulate and write."""
    picture = arguments.out / PICTURE
    if not arguments.text_only:
        from hd_monitor.offline.plots.style import png

        from .picture import gallery_picture

        grounds = {str(effect.ground): zoom_of(effect.ground) for effect in EFFECTS}
        pairs = []
        for effect in EFFECTS:
            print(effect.name, file=sys.stderr, flush=True)
            pairs.append((grounds[str(effect.ground)], zoom_of({**effect.ground, **effect.settings})))
        picture.parent.mkdir(parents=True, exist_ok=True)
        picture.write_bytes(png(gallery_picture([effect.name for effect in EFFECTS], pairs)))
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "rig.md").write_text(page(), encoding="utf-8")
    print(arguments.out / "rig.md")
    return 0
