"""The history command: what it shows of a ledger, in every format."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.hd_monitor.history.entries import direction, entry

from hd_monitor.cli.main import main
from hd_monitor.diagnosis.verdict import Component, FaultCode, Level, Verdict
from hd_monitor.history.entry import Kind
from hd_monitor.history.ledger import Ledger
from hd_monitor.offline.history import COLUMNS
from hd_monitor.orders.rms_curve import SpeedBin

DAY = 86_400.0
START = 1_700_000_000.0


@pytest.fixture
def ledger(tmp_path: Path) -> Path:
    """A flexspline that gets worse day by day, a sound reducer, one from joint states alone, and one just put in."""
    path = tmp_path / "ledger.sqlite"
    rng = np.random.default_rng(1)
    limits = {"index_limits": (0.05, 0.08), "seconds": 1200.0}
    sound = Verdict(component=Component.NONE, level=Level.OK, fault_code=FaultCode.OK, reason="Sound")
    with Ledger(path) as file:
        for day in range(20):
            noise = 0.001 * rng.standard_normal(4)
            time = START + day * DAY
            worse, steady = (0.01 + noise[0], 0.03 + 0.002 * day + noise[1]), (0.01 + noise[2], 0.02 + noise[3])
            file.append(entry(time=time, serial="BAD", index=worse, std=0.001, **limits))
            good = {"serial": "GOOD", "joint": "wrist", "index": steady, "verdict": sound}
            file.append(entry(time=time, std=0.001, **good, **limits))
            pair = direction(amplitude=(3.0 + noise[0], 1.0)), direction("reverse", (3.0, 1.0))
            file.append(entry(time=time, serial="", joint="elbow", relative=True, evidence=pair, rms_curve=()))
        file.mark("NEW", "wrist", Kind.EXCHANGE, START)
    return path


def result_of(ledger: Path, *more: str) -> dict[str, Any]:
    out = ledger.parent / "out.json"
    assert main(["history", "--history", str(ledger), "--json", str(out), *more]) == 0
    return {
        reducer["serial"] or reducer["joint"]: reducer
        for reducer in json.loads(out.read_text(encoding="utf-8"))["reducers"]
    }


def test_the_table_says_what_changed_and_when_the_limit_is_reached(
    ledger: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["history", "--history", str(ledger)]) == 0
    text = capsys.readouterr().out
    assert "BAD, arm: WARN, flexspline (2023-12-03 22:13 UTC)" in text
    assert "20 entries over 40000 revolutions of the wave generator" in text
    said = re.findall(r"flexspline index: changes by 0\.\d+ ± \S+ points a day; the limit is (\S+) to (\S+) days", text)
    low, high = map(float, said[0])
    assert low < (0.08 - 0.03 - 19 * 0.002) / 0.002 < high
    good = text[text.index("GOOD, wrist: OK, none") :]
    assert "a day" not in good
    assert "NEW: no verdict (never)" in text


def test_json_has_every_reading_with_its_change(ledger: Path) -> None:
    found = result_of(ledger)
    assert set(found) == {"BAD", "GOOD", "elbow", "NEW"}
    bad = {reading["reading"]: reading for reading in found["BAD"]["readings"]}
    index = bad["flexspline index"]
    assert len(index["values"]) == 20
    assert [value["is_baseline"] for value in index["values"]].count(True) == 3
    assert index["change"]["change"] == pytest.approx(0.034, abs=0.003)
    assert index["change"]["p_value"] < 0.001
    assert index["slope"]["per_day"] == pytest.approx(0.002, abs=0.0002)
    assert (index["warn_limit"], index["error_limit"]) == (0.05, 0.08)
    assert bad["circular spline index"]["slope"] is None
    assert found["elbow"]["verdict"]["component"] == "flexspline"
    assert not any("index" in reading["reading"] for reading in found["elbow"]["readings"])
    assert set(result_of(ledger, "--serial", "GOOD")) == {"GOOD"}


def test_the_temperature_stands_beside_the_readings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "warm.sqlite"
    with Ledger(path) as file:
        file.append(entry(time=START))
        file.append(entry(time=START + DAY, temperature=31.25))
    (reading, *_) = result_of(path)["S1"]["readings"]
    assert [value["temperature"] for value in reading["values"]] == [None, 31.25]
    assert "(2023-11-15 22:13 UTC, 31.2 °C)" in capsys.readouterr().out


def test_the_property_curve_is_compared_with_the_baselines(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, speeds = tmp_path / "curves.sqlite", (600.0, 900.0, 1200.0)
    with Ledger(path) as file:
        for day, size in enumerate((1.0, 1.02, 0.5)):
            curve = tuple(SpeedBin(rpm, size * rpm * (1.0 + 0.01 * k), 1000) for k, rpm in enumerate(speeds))
            file.append(entry(time=START + day * DAY, seconds=1800.0, rms_curve=curve))
    curves = result_of(path, "--report", str(tmp_path / "report"))["S1"]["rms_curve"]
    assert [point["rpm"] for point in curves["baseline"]] == list(speeds)
    assert curves["newest"][0]["rms"] == pytest.approx(300.0)
    assert curves["change"]["ratio"] == pytest.approx(0.495, abs=0.003)
    assert "Over 3 common speeds the vibration is 49.5" in capsys.readouterr().out
    page = (tmp_path / "report" / "index.html").read_text(encoding="utf-8")
    assert "Before: the baseline; after: the newest motion." in page


def test_csv_has_a_row_for_each_value(ledger: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    assert main(["history", "--history", str(ledger), "--serial", "BAD", "--csv", str(out)]) == 0
    with out.open(encoding="utf-8", newline="") as file:
        header, *lines = csv.reader(file)
    assert tuple(header) == COLUMNS
    indexes = [float(line[6]) for line in lines if line[4] == "flexspline index"]
    assert len(indexes) == 20
    assert len(lines) == 20 * 5


def test_parquet_has_the_same_rows(ledger: Path, tmp_path: Path) -> None:
    from pyarrow import parquet

    out = tmp_path / "out.parquet"
    assert main(["history", "--history", str(ledger), "--serial", "BAD", "--parquet", str(out)]) == 0
    table = parquet.read_table(out)
    assert tuple(table.column_names) == COLUMNS
    assert table.num_rows == 20 * 5


def test_a_baseline_is_set_for_one_reducer(ledger: Path) -> None:
    before = result_of(ledger)
    after = result_of(ledger, "--serial", "BAD", "--set-baseline")["BAD"]
    index = next(reading for reading in after["readings"] if reading["reading"] == "flexspline index")
    assert [value["is_baseline"] for value in index["values"]] == [False] * 17 + [True] * 3
    assert index["change"] is None
    assert result_of(ledger)["GOOD"] == before["GOOD"]


def test_the_page_has_a_tile_for_each_reducer_the_worst_first(ledger: Path, tmp_path: Path) -> None:
    folder = tmp_path / "report"
    assert main(["history", "--history", str(ledger), "--report", str(folder)]) == 0
    page = (folder / "index.html").read_text(encoding="utf-8")
    tiles = re.findall(r'<details class="tile (\w+)">\s*<summary>\s*<h2>(.*?)</h2>', page)
    assert [level for level, _ in tiles] == ["WARN", "WARN", "OK", "none"]
    assert {title for _, title in tiles} == {"BAD", "GOOD", "NEW", "joint elbow (no serial number)"}
    assert page.count("<polyline") == 6
    assert "the limit is" in page
    bars = re.findall(r'<div class="bar"><span class="(\w+)"', page)
    assert bars == ["WARN", "OK", "OK", "OK"]  # BAD and GOOD, the flexspline's index first
    assert re.search(r"<strong>flexspline index</strong> 6\.\d+ ± 0\.10 %, changed by 3\.\d+ ± 0\.\d+ points", page)
    assert re.search(r"<strong>flexspline line 1</strong> [\d.]+ ± [\d.]+<", page)
    assert (folder / "BAD_index.png").exists()


def test_the_ledger_of_a_parameter_file_is_found(ledger: Path, tmp_path: Path) -> None:
    params = tmp_path / "monitor.yaml"
    params.write_text(f"/**:\n  ros__parameters:\n    history:\n      path: {ledger}\n", encoding="utf-8")
    assert main(["history", "--params", str(params)]) == 0


def test_what_cannot_be_used_is_named(ledger: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["history"]) == 2
    assert "no ledger given" in capsys.readouterr().err
    assert main(["history", "--history", str(ledger), "--serial", "X"]) == 2
    assert "has nothing on X; it knows joint elbow (no serial number), BAD, GOOD, NEW" in capsys.readouterr().err
    params = tmp_path / "monitor.yaml"
    params.write_text("/**:\n  ros__parameters:\n    joints: [a]\n", encoding="utf-8")
    assert main(["history", "--params", str(params)]) == 2
    assert "names no ledger(s) in history.path" in capsys.readouterr().err
