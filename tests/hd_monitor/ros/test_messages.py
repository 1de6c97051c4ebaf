import math
from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.diagnosis.status import Status
from hd_monitor.orders.rms_curve import SpeedBin
from hd_monitor.orders.zoom import zoom_spectrum
from hd_monitor.reducer import LinePair

pytestmark = pytest.mark.ros


@pytest.mark.parametrize("level", [0, 1, 2])
def test_a_status_survives_the_wire(level: int) -> None:
    from diagnostic_msgs.msg import DiagnosticStatus
    from rclpy.serialization import deserialize_message, serialize_message

    from hd_monitor.ros.messages import diagnostic_status

    status = Status(
        subject="joint reducer",
        level=level,
        message="±",
        hardware_id="A1",
        kind=(),
        values=(("speed (rpm)", "850.0"),),
    )
    message = diagnostic_status(status, "/node")
    assert message.name == "/node: joint reducer"
    back = deserialize_message(serialize_message(message), DiagnosticStatus)
    assert back == message
    assert back.level == bytes([level])
    assert [(pair.key, pair.value) for pair in back.values] == [("speed (rpm)", "850.0")]


@pytest.mark.parametrize("relative", [False, True])
def test_readings_that_are_known_are_numbers_by_topic(relative: bool) -> None:
    from hd_monitor.identification.result import Identification
    from hd_monitor.ros.messages import readings_of

    nothing = Identification.none((), relative=False)
    assert readings_of(nothing) == {}
    errors = LinePair(0.2, math.nan)
    found = replace(nothing, index=LinePair(0.015, 0.103), transmission_error=errors, relative=relative)
    indexes = {} if relative else {"circular_spline/index": 1.5, "flexspline/index": 10.3}
    assert readings_of(found) == pytest.approx({**indexes, "circular_spline/transmission_error": 0.2})


def test_a_spectrum_is_laid_out_as_frequencies_and_then_amplitudes() -> None:
    from hd_monitor.ros.messages import zoom_message

    samples = np.sin(2 * np.pi * 30.0 * np.arange(4000) / 1000)
    zoom = zoom_spectrum(samples, 0.001, around=LinePair(30.0, 30.5), k=1)
    message = zoom_message(zoom)
    table = np.asarray(message.data).reshape([d.size for d in message.layout.dim])
    np.testing.assert_array_equal(table, [zoom.frequencies, zoom.amplitude])
    assert message.layout.data_offset == 0
    assert [d.stride for d in message.layout.dim] == [table.size, 50]


def test_a_curve_is_laid_out_bin_by_bin() -> None:
    from hd_monitor.ros.messages import rms_message

    message = rms_message((SpeedBin(200.0, 0.5, 10), SpeedBin(300.0, 0.75, 20)))
    assert list(message.data) == [200.0, 0.5, 10.0, 300.0, 0.75, 20.0]
    assert [(d.label, d.size, d.stride) for d in message.layout.dim] == [("speed_bin", 2, 6), ("rpm_rms_samples", 3, 3)]


def test_an_empty_curve_is_an_empty_array() -> None:
    from hd_monitor.ros.messages import rms_message

    assert not rms_message(()).data
