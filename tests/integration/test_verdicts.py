"""The main job: from a simulated rig with a known defect to the part named on /diagnostics."""

from typing import Any

import pytest

from hd_sim_node.settings import RigSettings

from .conftest import ERROR, OK, QUICK, Bench, Shown

pytestmark = pytest.mark.ros

FAULTS = {
    "none": ("HD_OK", OK),
    "flexspline": ("HD_FLEXSPLINE", ERROR),
    "circular_spline": ("HD_CIRCULAR_SPLINE", ERROR),
    "both": ("HD_BOTH_SPLINES", ERROR),
}


def settled(status: Shown) -> bool:
    """Whether a part is named and both indexes are known to a twentieth of a per cent of the stiffness."""
    return status.component != "undetermined" and all(
        f"{spline} index std (%)" in status.values and status.number(f"{spline} index std (%)") < 0.05
        for spline in ("flexspline", "circular spline")
    )


def is_number(text: str) -> bool:
    return text.replace(".", "", 1).isdigit()


def indexes(defect: str) -> tuple[float, float]:
    """Indexes [%] of the flexspline and of the circular spline that the rig simulates."""
    model = RigSettings.from_mapping({"defect": defect}).model
    return 100 * model.flexspline.index, 100 * model.circular_spline.index


@pytest.mark.parametrize("defect", FAULTS)
def test_the_simulated_defect_is_named(bench: Bench, defect: str) -> None:
    bench.monitor("reducer.serial:=HD-0042")
    bench.rig(f"defect:={defect}", *QUICK)
    status = bench.until_status(settled, "a settled verdict")
    fault_code, level = FAULTS[defect]
    assert (status.component, status.fault_code, status.level) == (defect, fault_code, level)
    assert status.name == "/hd_monitor_node: joint reducer"
    assert status.hardware_id == "HD-0042"
    flexspline, circular_spline = indexes(defect)
    assert status.number("flexspline index (%)") == pytest.approx(flexspline, abs=0.3)
    assert status.number("circular spline index (%)") == pytest.approx(circular_spline, abs=0.3)


def test_every_status_of_a_run_is_complete(bench: Bench) -> None:
    bench.monitor("reducer.serial:=HD-0042")
    bench.rig("defect:=flexspline", *QUICK)
    bench.until_status(settled, "a settled verdict")
    for statuses, always in ((bench.statuses, ("samples", "gaps")), (bench.inputs, ("samples", "joint states"))):
        known = statuses[-1].values
        for status in statuses:
            assert status.hardware_id == "HD-0042"  # a first status without it would make a second row in viewers
            assert set(status.values) <= set(known)  # numbers are left out while unknown
            for key in (*always, *status.values):
                assert is_number(status.values[key]) == is_number(known[key]), key
            assert status.level in (0, 1, 2)
            assert 0 < len(status.message) <= 128  # more is not shown by ros2 topic echo


def test_spectrum_and_rms_curve_come_in_the_contracts_layout(bench: Bench, peer: Any) -> None:
    from std_msgs.msg import Float64MultiArray

    zooms = peer.collect(Float64MultiArray, "zoom_spectrum", match=False)
    curves = peer.collect(Float64MultiArray, "rms_curve", match=False)
    bench.monitor()
    bench.rig("defect:=both", *QUICK)
    bench.until(lambda: zooms and curves and len(curves[-1].data) >= 9, "a spectrum and three speed bins")
    layout = [(d.label, d.size, d.stride) for d in zooms[-1].layout.dim]
    assert layout == [("frequency_amplitude", 2, 100), ("bin", 50, 50)]
    assert {len(zoom.data) for zoom in zooms} == {100}
    assert list(zooms[-1].data[:50]) == sorted(zooms[-1].data[:50])
    layout = [(d.label, d.size, d.stride) for d in curves[-1].layout.dim]
    bins = layout[0][1]
    assert layout == [("speed_bin", bins, 3 * bins), ("rpm_rms_samples", 3, 3)]
    rpm, rms, samples = (list(curves[-1].data[start::3]) for start in range(3))
    assert rpm == sorted(rpm)
    assert min(rms) > 0
    assert min(samples) >= 1
