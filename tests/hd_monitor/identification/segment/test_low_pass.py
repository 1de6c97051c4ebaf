"""The sensor's low-pass: what of a prediction is heard, to the ends of a segment."""

import math

import numpy as np
import pytest

from hd_monitor.identification.segment.low_pass import LowPass

STEP = 1e-3


def tone(frequency: float, size: int = 1500) -> np.ndarray:
    return np.sin(math.tau * frequency * STEP * np.arange(size) + 0.7)[:, None]


def amplitude_and_lag(series: np.ndarray, frequency: float) -> tuple[float, float]:
    """Amplitude, and phase [rad] by which a tone lags behind `tone`, away from the ends."""
    times = STEP * np.arange(len(series))[200:-200]
    columns = np.stack([np.cos(math.tau * frequency * times), np.sin(math.tau * frequency * times)], axis=1)
    cosine, sine = np.linalg.lstsq(columns, series[200:-200, 0], rcond=None)[0]
    return math.hypot(cosine, sine), 0.7 - math.atan2(cosine, sine)


@pytest.mark.parametrize(
    ("frequency", "gain", "lag"), [(20.0, 0.9992, 0.2862), (50.0, 0.9701, 0.7560), (90.0, 0.7772, 1.4219)]
)
def test_a_given_bandwidth_is_that_of_a_second_order_butterworth_filter(
    frequency: float, gain: float, lag: float
) -> None:
    found = amplitude_and_lag(LowPass.of(100.0, 1000.0).heard(tone(frequency), STEP), frequency)
    assert found == pytest.approx((gain, lag), abs=2e-3)


def test_nothing_beyond_the_bandwidth_is_heard() -> None:
    for low_pass in (LowPass.of(100.0, 1000.0), LowPass.of(0.0, 250.0)):
        assert low_pass.limit == 100.0
        assert np.abs(low_pass.heard(tone(130.0), STEP)[200:-200]).max() < 0.001


def test_of_an_unknown_sensor_all_below_its_limit_is_heard_in_full_to_the_ends() -> None:
    heard = LowPass.of(0.0, 500.0).heard(tone(55.0), STEP)
    assert np.abs(heard - tone(55.0)).max() < 0.02
    assert np.abs(heard - tone(55.0))[50:-50].max() < 0.001


def test_it_changes_nothing_where_all_is_heard_in_full() -> None:
    assert not LowPass.of(0.0, 1000.0).changes(399.0)
    assert LowPass.of(0.0, 1000.0).changes(401.0)
    assert LowPass.of(300.0, 1000.0).changes(20.0)


def test_a_bandwidth_above_half_the_rate_ends_there() -> None:
    assert LowPass.of(5000.0, 1000.0).limit == 500.0
