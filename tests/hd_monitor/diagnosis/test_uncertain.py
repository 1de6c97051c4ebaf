"""What is written of a value and its standard deviation is neither more nor less than is known."""

from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.diagnosis.uncertain import significant, with_std

STDS = st.floats(1e-6, 9.9)


@given(STDS)
def test_two_digits_of_a_standard_deviation_are_written_and_no_exponent(std: float) -> None:
    text = significant(std)
    assert "e" not in text
    assert len(text.replace(".", "").lstrip("0")) == 2
    assert abs(float(text) - std) <= 0.051 * std


@given(st.floats(-100.0, 100.0), STDS)
def test_a_value_is_written_as_finely_as_its_standard_deviation(value: float, std: float) -> None:
    shown, uncertainty = with_std(value, std).split(" ± ")
    assert len(shown.partition(".")[2]) == len(uncertainty.partition(".")[2])
    assert abs(float(shown) - value) <= 0.051 * std
