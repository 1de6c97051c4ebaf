"""Readings: what a status says of a spline, with its interval among the limits."""

import math

import pytest

from hd_monitor.watch.answers import interval, standing
from hd_monitor.watch.reading import Reading, number, readings_of

from .statuses import reducer


def reading(value: float, std: float) -> Reading:
    return Reading(part="flexspline", quantity="index", unit="%", value=value, std=std, warn=5.0, error=8.0)


def test_a_status_gives_indexes_and_errors_each_with_its_own_limits() -> None:
    status = reducer(
        flexspline_index=(10.3, 0.4),
        circular_spline_index=(1.5, 0.3),
        flexspline_transmission_error=(0.4, 0.1),
        circular_spline_transmission_error=(0.3, 0.1),
    )
    found = readings_of(status.values)
    assert [(r.part, r.quantity, r.value, r.std, r.warn, r.error) for r in found] == [
        ("flexspline", "index", 10.3, 0.4, 5.0, 8.0),
        ("circular_spline", "index", 1.5, 0.3, 5.0, 8.0),
        ("flexspline", "transmission error", 0.4, 0.1, 1.5, 3.0),
        ("circular_spline", "transmission error", 0.3, 0.1, 1.5, 3.0),
    ]


def test_shares_have_no_limit() -> None:
    first, second = readings_of(reducer(flexspline_share=(83.1, 2.0), circular_spline_share=(55.6, 2.0)).values)
    assert (first.value, second.value) == (83.1, 55.6)
    assert math.isnan(first.error)
    assert math.isnan(first.severity)


@pytest.mark.parametrize(
    ("value", "std", "where"),
    [
        (1.0, 0.1, "below the warn limit"),
        (5.1, 0.5, "reaches across the warn limit"),
        (6.0, 0.1, "above the warn limit"),
        (7.9, 0.5, "reaches across the error limit"),
        (9.0, 0.1, "above the error limit"),
        (9.0, math.nan, "how it compares with the limits is unknown"),
    ],
)
def test_an_interval_lies_somewhere_among_the_limits(value: float, std: float, where: str) -> None:
    assert standing(reading(value, std)) == where


@pytest.mark.parametrize(
    ("value", "std", "text"),
    [
        (10.31, 0.4, "9.5 to 11.1 %"),
        (10.31, 0.02, "10.27 to 10.35 %"),
        (1.497, 0.008, "1.481 to 1.513 %"),
        (0.1, 0.1, "0.0 to 0.3 %"),  # no fluctuation is less than none
        (1.5, 0.0, "1.5 to 1.5 %"),
        (1.5, math.nan, "unknown"),
    ],
)
def test_an_interval_has_the_digits_that_its_deviation_leaves(value: float, std: float, text: str) -> None:
    assert interval(reading(value, std)) == text


def test_a_deviation_that_is_missing_is_not_taken_for_none() -> None:
    assert reading(1.5, 0.004).with_std == "1.5000 ± 0.0040"
    assert reading(1.5, 0.000012).with_std == "1.500 ± <0.001"
    assert reading(1.5, math.nan).with_std == "1.5 ± ?"


@pytest.mark.parametrize("text", ["", "unknown", "inf", "nan", "-1e300"])
def test_what_is_no_number_is_unknown(text: str) -> None:
    assert math.isnan(number({"speed (rpm)": text}, "speed (rpm)"))
    assert math.isnan(number({}, "speed (rpm)"))
