"""The report's own analyses against signals whose answer is known in closed form."""

import math

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.offline.report.lines_by_speed import LinesBySpeed
from hd_monitor.offline.report.phase_trace import phase_trace
from hd_monitor.offline.report.spectra import OrderMapAccumulator, amplitude_spectrum, order_spectrum, whole_runs
from hd_monitor.offline.report.speed_bins import SpeedBins
from hd_monitor.offline.report.waterfall import WaterfallAccumulator
from hd_monitor.reducer import Reducer

RIG = Reducer(flexspline_teeth=160, circular_spline_teeth=162)
SPEEDS = SpeedBins(RIG, width=100.0, minimum_speed=30.0)
PERIOD = 1e-3
LINES = {160: 3.0, 162: 5.0, 320: 0.5, 324: 0.8}
"""Amplitudes [rad/s²] by cycles per output revolution."""


def record(angle, *, start=0.0, noise=0.0, seed=0):
    values = sum(amplitude * np.cos(order * angle + order) for order, amplitude in LINES.items())
    values = values + noise * np.random.default_rng(seed).standard_normal(angle.size)
    speed = np.gradient(angle, PERIOD)
    torque = np.full(angle.size, 10.0)
    return Record(start=start, period=PERIOD, acceleration=values, angle=angle, speed=speed, torque=torque)


def steady(rpm, seconds, *, start=0.0, angle=0.0, **options):
    times = PERIOD * np.arange(round(seconds / PERIOD))
    return record(angle + times * rpm * math.tau / 60 / RIG.reduction, start=start, **options)


def test_a_line_shows_its_amplitude_in_the_spectrum() -> None:
    rpm = 1200.0
    spectrum = amplitude_spectrum(steady(rpm, 40.0))
    for k, amplitudes in ((1, (3.0, 5.0)), (2, (0.5, 0.8))):
        for frequency, amplitude in zip(RIG.line_frequencies(rpm, k), amplitudes, strict=True):
            near = np.abs(spectrum.axis - frequency) < 0.1
            assert spectrum.amplitude[near].max() == pytest.approx(amplitude, rel=0.02)


@pytest.mark.parametrize(
    "angle",
    [
        np.linspace(0.0, 8 * math.tau, 60_000),  # even
        np.linspace(0.0, 1.0, 60_000) ** 2 * 8 * math.tau,  # ramp
        4 * math.tau * (1 - np.cos(np.linspace(0.0, 6 * math.pi, 60_000))) / 2,  # strokes back and forth
    ],
)
def test_the_order_spectrum_shows_amplitudes_at_any_motion(angle) -> None:
    orders = np.array([150.0, 160.0, 162.0, 320.0])
    spectrum = order_spectrum(angle, record(angle).acceleration, orders)
    np.testing.assert_allclose(spectrum.amplitude, [0.0, 3.0, 5.0, 0.5], atol=0.05)


def test_the_order_spectrum_leaves_out_what_is_missing() -> None:
    angle = np.linspace(0.0, 8 * math.tau, 60_000)
    values = record(angle).acceleration
    values[20_000:20_200] = np.nan
    spectrum = order_spectrum(angle, values, np.array([160.0, 162.0]))
    np.testing.assert_allclose(spectrum.amplitude, [3.0, 5.0], rtol=0.03)
    assert order_spectrum(np.empty(0), np.empty(0), np.array([1.0])).amplitude.tolist() == [0.0]


def test_line_amplitudes_come_out_at_each_speed_with_calibrated_errors() -> None:
    trials = []
    for seed in range(60):
        lines = LinesBySpeed(SPEEDS, 2)
        for rpm in (400.0, 1200.0):
            for second in range(6):
                angle = second * rpm * math.tau / 60 / RIG.reduction
                lines.add(steady(rpm, 1.0, angle=angle, noise=0.5, seed=1000 * seed + 10 * second + int(rpm / 400)))
        result = lines.result()
        assert [(round(line.rpm), line.k) for line in result] == [(400, 1), (400, 2), (1200, 1), (1200, 2)]
        for line in result:
            true = (3.0, 5.0) if line.k == 1 else (0.5, 0.8)
            trials += [(line.amplitude[i] - true[i]) / line.std[i] for i in range(2)]
    # 480 standardised errors: their standard deviation is known to 1/√(2·480) ≈ 3.2 %.
    assert np.std(trials) == pytest.approx(1.0, abs=0.13)
    assert abs(np.mean(trials)) < 0.25


def test_speeds_whose_travel_does_not_separate_the_lines_are_left_out() -> None:
    lines = LinesBySpeed(SPEEDS, 2)
    lines.add(steady(400.0, 0.5))  # 15 degrees
    assert lines.result() == []


def test_records_in_which_the_speed_rushes_are_left_out() -> None:
    lines = LinesBySpeed(SPEEDS, 2)
    times = PERIOD * np.arange(1000)
    lines.add(record(10.0 * times**2))
    assert lines.result() == []


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_order_map_puts_lines_at_their_orders_at_every_speed(direction: float) -> None:
    accumulator = OrderMapAccumulator(SPEEDS, 5.0)
    for rpm in (300.0, 600.0, 1500.0):
        accumulator.add(steady(direction * rpm, 4.0))
    result = accumulator.result()
    assert result is not None
    assert result.speeds.tolist() == [300.0, 600.0, 1500.0]
    for row in result.amplitude:
        near_two = (result.orders > 1.9) & (result.orders < 2.15)
        between = (result.orders > 2.5) & (result.orders < 3.5)
        assert 1.9 < np.nanmax(row[near_two]) < 8.1  # the two lines beat
        assert np.nanmax(row[between]) < 0.3


def test_records_with_holes_do_not_spoil_the_map() -> None:
    broken = steady(600.0, 1.0)
    broken.acceleration[300:340] = np.nan
    accumulator = OrderMapAccumulator(SPEEDS, 5.0)
    accumulator.add(broken)
    assert accumulator.result() is None
    assert whole_runs(broken.acceleration) == [(0, 300), (340, 1000)]


def test_the_phase_trace_of_a_sine_is_its_ellipse() -> None:
    rpm, amplitude = 900.0, 4.0
    angle = PERIOD * np.arange(20_000) * rpm * math.tau / 60 / RIG.reduction
    pure = steady(rpm, 20.0)
    values = amplitude * np.cos(160 * angle) + 7.0 + 0.3 * np.sin(angle)  # with an offset and gravity
    trace = phase_trace(
        Record(start=0.0, period=PERIOD, acceleration=values, angle=angle, speed=pure.speed, torque=pure.torque),
        RIG,
    )
    assert trace is not None
    omega = math.tau * RIG.line_frequencies(rpm).circular_spline
    radius = np.hypot(trace.displacement * omega**2, trace.velocity * omega)
    np.testing.assert_allclose(radius, amplitude, rtol=0.02)


def test_a_phase_trace_needs_enough_of_an_unbroken_record() -> None:
    assert phase_trace(steady(900.0, 0.2), RIG) is None
    fast = Reducer(flexspline_teeth=160, circular_spline_teeth=162)
    assert phase_trace(steady(20_000.0, 5.0), fast) is None  # the first line lies above the Nyquist frequency


def test_the_waterfall_keeps_its_size_and_its_peaks() -> None:
    waterfall = WaterfallAccumulator()
    for second in range(1000):
        waterfall.add(steady(600.0, 1.0, start=float(second)))
    result = waterfall.result()
    assert result is not None
    assert 200 <= result.times.size <= 400
    assert (np.diff(result.times) > 0).all()
    line = np.abs(result.frequencies - 20.3).argmin()  # the pair lies at 20.0 and 20.25 Hz
    assert (result.amplitude[:, line] > 1.9).all()  # a second does not part 3 and 5 rad/s²: between 2 and 8
    assert result.amplitude.max() < 8.1


def test_the_waterfall_of_a_short_record_has_no_empty_bins() -> None:
    waterfall = WaterfallAccumulator()
    for second in range(2):
        waterfall.add(steady(600.0, 0.2, start=float(second), noise=0.1))
    result = waterfall.result()
    assert result is not None
    assert (result.amplitude > 0.0).all()
