"""The page of the simulated rig: its tables come from the code, and its pictures from a command."""

from argparse import ArgumentParser
from pathlib import Path

import numpy as np
import pytest

from hd_sim_node.drive.catalogue import DRIVES, SOURCES
from hd_sim_node.gallery import command
from hd_sim_node.gallery.effects import EFFECTS, LENGTH, SETTLING, zoom_of
from hd_sim_node.gallery.page import PICTURES, page
from hd_sim_node.gallery.sensors import SENSORS
from hd_sim_node.settings import RigSettings

PAGES = Path(__file__).resolve().parents[2] / "msgs_doc"


def test_the_page_is_up_to_date() -> None:
    assert page() == (PAGES / "rig.md").read_text(encoding="utf-8"), "run: hd-monitor gallery --out msgs_doc"


def test_the_page_has_every_number_of_every_preset_and_every_document() -> None:
    text = page()
    for entries in DRIVES.values():
        for name, entry in entries.items():
            assert f"| `{name}` |" in text
            assert entry.source in text
    for name, document in SOURCES.items():
        assert f"- **{name}**: {document}." in text


@pytest.mark.parametrize("effect", [*EFFECTS, *SENSORS], ids=lambda effect: effect.name)
def test_every_effect_sets_something_that_the_ground_does_not(effect) -> None:
    ground, both = (RigSettings.from_mapping(given) for given in (effect.ground, {**effect.ground, **effect.settings}))
    assert ground != both


def test_an_effect_shows_in_its_spectrum(monkeypatch: pytest.MonkeyPatch) -> None:
    gravity = next(effect for effect in EFFECTS if effect.name == "Gravity")
    without, with_it = zoom_of(gravity.ground), zoom_of({**gravity.ground, **gravity.settings})
    left, right = with_it.lines
    between = np.argmin(np.abs(with_it.frequencies - (right + 0.5 * (right - left))))
    assert with_it.amplitude[between] > 100.0 * without.amplitude[between]
    assert with_it.resolution == pytest.approx(2.0 / LENGTH)
    assert SETTLING > 1.0


def test_what_is_above_half_the_rate_folds_down_unless_it_is_filtered() -> None:
    folded = next(effect for effect in SENSORS if "filter" in effect.name and effect.ground)
    without, with_it = zoom_of(folded.ground), zoom_of({**folded.ground, **folded.settings})
    rate, line = folded.ground["sensor.rate"], 2.0 * with_it.lines.flexspline
    at = np.argmin(np.abs(with_it.frequencies - (rate - line)))
    order, bandwidth = folded.settings["sensor.filter_order"], folded.settings["sensor.bandwidth"]
    attenuation = np.sqrt(1.0 + (line / bandwidth) ** (2 * order))
    assert without.amplitude[at] / with_it.amplitude[at] == pytest.approx(attenuation, rel=0.1)


def test_the_imu_is_the_accelerometer_at_its_radius() -> None:
    short = {"duration": SETTLING + 5.0, "sensor.noise": 0.0}
    shown = zoom_of({**short, "publish_imu": True, "sensor.radius": 0.3})
    np.testing.assert_allclose(shown.amplitude, zoom_of(short).amplitude, rtol=1e-9)


def test_the_command_writes_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    parser = ArgumentParser()
    command.configure(parser)
    assert command.run(parser.parse_args(["--out", str(tmp_path), "--text-only"])) == 0
    assert (tmp_path / "rig.md").read_text(encoding="utf-8") == page()
    assert capsys.readouterr().out == f"{tmp_path / 'rig.md'}\n"


@pytest.mark.parametrize("effects", PICTURES.values(), ids=PICTURES)
def test_the_picture_has_a_panel_for_each_effect(effects) -> None:
    pytest.importorskip("matplotlib")
    from hd_sim_node.gallery.picture import gallery_picture

    zoom = zoom_of({"duration": SETTLING + 5.0})
    figure = gallery_picture([effect.name for effect in effects], [(zoom, zoom)] * len(effects))
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == [f"{number}  {effect.name}" for number, effect in enumerate(effects, start=1)]
