"""The pages of msgs_doc say what the code does."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hd_monitor import contract
from hd_monitor.assessment import Assessment
from hd_monitor.change import Growth
from hd_monitor.diagnosis.inputs import InputCode
from hd_monitor.diagnosis.status import Status, input_status_of, status_of
from hd_monitor.diagnosis.verdict import Component, FaultCode
from hd_monitor.identification.result import Identification
from hd_monitor.model import ParametricModel, StiffnessSeries
from hd_monitor.monitor import Monitor
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings, set_aside_foreign, split_joints
from hd_monitor.sources import INPUT_SOURCES, JOINT_STATES, LOAD_SOURCES

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "msgs_doc"
DIAGNOSTICS = (PAGES / "diagnostics.md").read_text(encoding="utf-8")
TOPICS = (PAGES / "topics.md").read_text(encoding="utf-8")


def documented_keys(subject: str) -> list[str]:
    table = DIAGNOSTICS.partition(f"## Values of the {subject}'s status")[2].partition("\n## ")[0]
    cells = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    return [key for cell in cells for key in re.findall(r"`([^`]+)`", cell)]


def everything_known() -> Assessment:
    unstable = ParametricModel(flexspline=StiffnessSeries((0.3,), (0.0,)))
    found = Identification(
        circular_spline=np.zeros(1, dtype=complex),
        flexspline=np.zeros(1, dtype=complex),
        index=LinePair(0.01, 0.3),
        index_std=LinePair(0.001, 0.001),
        transmission_error=LinePair(0.1, 0.2),
        transmission_error_std=LinePair(0.01, 0.01),
        signal_to_noise=20.0,
        misfit=1.0,
        natural_frequency=55.0,
        damping_ratio=0.023,
        model=unstable,
    )
    nothing = Monitor(JointSettings.from_mapping()).silence(0)
    quality = replace(nothing.quality, rate=1000.0)
    return replace(
        nothing,
        evidence_end=0,
        identification=found,
        quality=quality,
        speed=850.0,
        rms=1.0,
        rms_growth=0.1,
        extra=(("internal errors", "1"),),
    )


def relative(assessment: Assessment) -> Assessment:
    assert assessment.identification is not None
    growth = {part: Growth(0.1, 0.01) for part in (Component.CIRCULAR_SPLINE, Component.FLEXSPLINE)}
    return replace(assessment, identification=replace(assessment.identification, relative=True), line_growth=growth)


def keys_of(status: Status) -> list[str]:
    return [key for key, _ in status.values]


def test_every_key_of_a_status_is_documented_in_its_order() -> None:
    assert keys_of(input_status_of(everything_known(), "joint")) == documented_keys("input")
    documented, known = documented_keys("reducer"), everything_known()
    for assessment, others in ((known, ("share", "line growth")), (relative(known), ("index",))):
        keys = keys_of(status_of(assessment, "joint"))
        left_out = tuple(f" {other}{std} (%)" for other in others for std in ("", " std"))
        expected = [key for key in documented if not key.endswith(left_out)]
        assert sorted(keys) == sorted(expected)
        assert [key for key in keys if "std" not in key] == [key for key in expected if "std" not in key]


def test_shares_are_not_called_indexes() -> None:
    shares = dict(status_of(relative(everything_known()), "joint").values)
    assert float(shares["flexspline share (%)"]) == pytest.approx(99.944, abs=1e-3)
    assert float(shares["circular spline share (%)"]) == pytest.approx(3.331, abs=1e-3)
    assert float(shares["flexspline share std (%)"]) == pytest.approx(0.33, abs=1e-3)


@pytest.mark.parametrize("write", [status_of, input_status_of])
def test_a_key_that_holds_a_number_is_left_out_while_it_is_unknown(write: Callable[[Assessment, str], Status]) -> None:
    known = dict(write(everything_known(), "joint").values)
    unknown = dict(write(Monitor(JointSettings.from_mapping()).silence(0), "joint").values)
    numbers = {key for key, value in known.items() if value.replace(".", "", 1).isdigit()}
    left_out = {"speed (rpm)", "unstable from (rpm)", "flexspline index (%)", "evidence age (s)", "sampling rate (Hz)"}
    assert left_out & set(known) <= numbers - set(unknown)
    assert all(float(value) >= 0.0 for key, value in unknown.items() if key in numbers)
    assert set(known) - numbers <= set(unknown)


@pytest.mark.parametrize("code", [*FaultCode, *InputCode])
def test_every_fault_code_is_documented(code: FaultCode | InputCode) -> None:
    assert f"`{code.value}`" in DIAGNOSTICS.partition("## Fault codes")[2]


@pytest.mark.parametrize("component", list(Component))
def test_every_component_is_documented(component: Component) -> None:
    assert f"`{component.value}`" in DIAGNOSTICS


SOURCES = {f"input.source: {name}": source for name, source in INPUT_SOURCES.items()} | {
    f"load.source: {name}": source for name, source in LOAD_SOURCES.items() if source is not None
}


@pytest.mark.parametrize(
    "topic", sorted({*(s.topic for s in SOURCES.values()), contract.ZOOM_SPECTRUM, contract.RMS_CURVE})
)
def test_every_topic_has_a_section_with_an_example(topic: str) -> None:
    section = re.search(rf"^## {re.escape(topic)}\n(.*?)(?=^## |\Z)", TOPICS, re.MULTILINE | re.DOTALL)
    assert section is not None
    assert "```yaml" in section[1]


@pytest.mark.parametrize("setting", SOURCES)
def test_every_source_of_input_is_in_the_table(setting: str) -> None:
    source = SOURCES[setting]
    (row,) = (line for line in TOPICS.splitlines() if line.startswith(f"| [`{source.topic}`]"))
    assert f"`{source.type}`" in row
    assert f"`{setting}`" in row or (source is JOINT_STATES and f"`{setting.split()[1]}`" in row)


def test_the_documented_layouts_are_the_contracts() -> None:
    for dimension in (*contract.zoom_layout(), *contract.rms_layout(1)):
        line = f"{{label: {dimension.label}, size: {dimension.size}, stride: {dimension.stride}}}"
        assert line in TOPICS
    assert f"`label: {contract.BLOCK_LABEL}`" in TOPICS
    assert f"| `layout.data_offset` | {contract.BLOCK_OFFSET} |" in TOPICS


@pytest.mark.parametrize("page", [*sorted(PAGES.glob("*.md")), ROOT / "README.md"], ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_the_readmes_parameter_file_is_accepted() -> None:
    yaml = pytest.importorskip("yaml")
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = [block for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL) if block.startswith("/**:")]
    assert len(blocks) == 1
    given, foreign = set_aside_foreign(yaml.safe_load(blocks[0])["/**"]["ros__parameters"])
    assert not foreign
    assert list(split_joints(given)) == ["shoulder", "elbow"]


def test_the_readme_shows_the_shipped_aggregator_file() -> None:
    shipped = (ROOT / "config" / "aggregator.yaml").read_text(encoding="utf-8")
    body = shipped[shipped.index("analyzers:") :]
    assert body in (ROOT / "README.md").read_text(encoding="utf-8")
