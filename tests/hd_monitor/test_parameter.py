"""One parameter, checked in one way everywhere."""

import math
from array import array

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.parameter import Parameter, check_all, flatten

SPEED = Parameter(name="a.speed", default=1.0, unit="rpm", low=0.0, high=10.0, description="how fast")
COUNT = Parameter(name="a.count", default=3, low=1, high=5, description="how many")
SWITCH = Parameter(name="b.switch", default=False, description="on or off")
WORD = Parameter(name="b.word", default="yes", choices=("yes", "no"), description="one of two")
TEXT = Parameter(name="text", default="", description="any text")
NUMBERS = Parameter(name="numbers", default=(0.0,), unit="rad", low=-1.0, high=1.0, description="several numbers")
FREE = Parameter(name="free", default=0.0, description="any number")


@pytest.mark.parametrize(
    ("parameter", "value", "expected"),
    [
        (SPEED, 2.5, 2.5),
        (SPEED, 2, 2.0),
        (SPEED, 0.0, 0.0),
        (SPEED, 10.0, 10.0),
        (COUNT, 5, 5),
        (SWITCH, True, True),
        (WORD, "no", "no"),
        (TEXT, "anything", "anything"),
        (NUMBERS, [0.5, -1], (0.5, -1.0)),
        (NUMBERS, (0.5,), (0.5,)),
        (NUMBERS, array("d", [0.25]), (0.25,)),
        (NUMBERS, 0.5, (0.5,)),
        (NUMBERS, [], ()),
        (FREE, -1e300, -1e300),
    ],
)
def test_fitting_values_come_back_in_the_parameters_type(parameter, value, expected):
    checked = parameter.check(value)
    assert checked == expected
    assert type(checked) is type(expected)


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        (SPEED, "fast"),
        (SPEED, True),
        (SPEED, None),
        (SPEED, [1.0]),
        (COUNT, 2.0),
        (COUNT, True),
        (COUNT, "2"),
        (SWITCH, 1),
        (SWITCH, "true"),
        (WORD, 1),
        (TEXT, 7),
        (NUMBERS, "0.5"),
        (NUMBERS, ["a"]),
        (NUMBERS, [True]),
        (NUMBERS, [[0.5]]),
        (NUMBERS, None),
        (NUMBERS, {"a": 1.0}),
    ],
)
def test_a_wrong_type_is_refused_by_name(parameter, value):
    with pytest.raises(ParameterError, match=f"{parameter.name} = .*wrong type"):
        parameter.check(value)


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        (SPEED, 10.000001),
        (SPEED, -1e-9),
        (SPEED, math.nan),
        (SPEED, math.inf),
        (COUNT, 0),
        (COUNT, 6),
        (NUMBERS, [0.0, 1.5]),
        (NUMBERS, [math.nan]),
        (FREE, math.inf),
        (FREE, math.nan),
    ],
)
def test_a_value_outside_is_refused_with_range_unit_and_meaning(parameter, value):
    with pytest.raises(ParameterError, match="is outside") as caught:
        parameter.check(value)
    assert parameter.unit in str(caught.value)
    assert parameter.description in str(caught.value)


def test_an_unknown_word_is_refused_with_the_choice():
    with pytest.raises(ParameterError, match="choose one of: yes, no"):
        WORD.check("maybe")


def test_flatten_joins_names_by_dots():
    nested = {"a": {"b": {"c": 1}, "d": 2}, "e.f": 3}
    assert flatten(nested) == {"a.b.c": 1, "a.d": 2, "e.f": 3}
    assert flatten({}) == {}
    assert flatten({"a": {}}) == {}


def test_check_all_fills_in_defaults():
    assert check_all((SPEED, COUNT), {"a": {"count": 4}}, owner="a thing") == {"a.speed": 1.0, "a.count": 4}


def test_check_all_refuses_unknown_names():
    with pytest.raises(ParameterError, match=r"a\.sped is not a parameter of a thing"):
        check_all((SPEED,), {"a.sped": 1.0}, owner="a thing")
