import base64
from html.parser import HTMLParser

import numpy as np
import pytest

from hd_monitor.paper.exhibit import Claim, Curve, Exhibit, Mark, Panel, Surface

pytest.importorskip("matplotlib")
pytest.importorskip("jinja2")

from hd_monitor.paper.drawing import figure_of, png
from hd_monitor.paper.page import write_report

PNG = b"\x89PNG\r\n\x1a\n"
X = np.linspace(0.0, 1.0, 20)


class Reader(HTMLParser):
    """Collects what a browser would load, the anchors and the text."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.ids: set[str] = set()
        self.links: set[str] = set()
        self.text = ""

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.sources += [values[name] or "" for name in ("src", "srcset") if name in values]
        if tag == "link":
            self.sources.append(values.get("href") or "")
        if tag == "a":
            self.links.add((values.get("href") or "").removeprefix("#"))
        if "id" in values:
            self.ids.add(values["id"] or "")

    def handle_data(self, data):
        self.text += data


def example(passed: bool = True) -> Exhibit:
    return Exhibit(
        title="Example <of> a figure",
        caption="Drawn & done",
        panels=(
            Panel(
                title="curves",
                x_label="time (s)",
                y_label="height (m)",
                curves=(
                    Curve(x=X, y=X**2 + 0.1, label="a"),
                    Curve(x=X, y=X + 0.1, label="b", style="dashed"),
                    Curve(x=X, y=X + 0.2, style="points"),
                    Curve(x=X, y=X + 0.3, style="dotted points"),
                    Curve(x=X, y=X + 0.4, style="fine"),
                    Curve(x=X, y=X + 0.5, style="stems"),
                ),
                marks=(Mark(at=0.5, label="half"), Mark(at=0.3, label="level", axis="y", place="right", below=True)),
                log_y=True,
            ),
            Panel(
                title="surface",
                x_label="x",
                y_label="y",
                surface=Surface(x=X, y=X, values=np.subtract.outer(X, X), label="z"),
                marks=(Mark(at=0.5, label="half"),),
            ),
            Panel(title="square", x_label="x", y_label="y", curves=(Curve(x=X, y=X),), equal=True),
        ),
        claims=(Claim(statement="a < b", paper="yes", ours="b > a", passed=passed, note="of course"),),
        facts=(("speed", "3 rpm"),),
    )


@pytest.fixture
def report(tmp_path):
    folder = tmp_path / "new" / "report"
    path = write_report(
        {"X1": example(), "X2": example(passed=False)}, folder, heading="A heading", command="hd-monitor paper"
    )
    reader = Reader()
    reader.feed(path.read_text(encoding="utf-8"))
    return folder, path, reader


def test_labels_and_scales_are_drawn():
    axes = figure_of("X1", example()).axes
    assert [a.get_xlabel() for a in axes if a.get_xlabel()] == ["time (s)", "x", "x"]
    assert axes[0].get_yscale() == "log"
    legend = axes[0].get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["a", "b"]


def test_report_is_a_page_and_a_png_for_each_figure(report):
    folder, path, _ = report
    assert path == folder / "index.html"
    assert (folder / "X1.png").read_bytes().startswith(PNG)


def test_page_loads_no_other_files(report):
    _, _, reader = report
    assert reader.sources
    for source in reader.sources:
        assert source.startswith("data:image/png;base64,")
        assert base64.b64decode(source.partition(",")[2]).startswith(PNG)


def test_page_shows_claims_with_outcome_and_escapes_text(report):
    _, path, reader = report
    for part in ("A heading", "a < b", "b > a", "of course", "FAIL", "pass", "Example <of> a figure", "Drawn & done"):
        assert part in reader.text
    assert "<of>" not in path.read_text(encoding="utf-8")
    assert reader.links <= reader.ids


def test_every_exhibit_can_be_drawn(exhibit):
    for name in ("F4", "F7", "T1", "F8", "E5", "F9", "F11b", "F13a", "F14", "F16", "F17", "F18a", "F19", "F20", "ST"):
        assert png(name, exhibit(name)).startswith(PNG)
