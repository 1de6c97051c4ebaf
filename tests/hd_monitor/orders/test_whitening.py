import numpy as np
import pytest
from scipy.signal import lfilter

from hd_monitor.orders.whitening import TAPS, learn_whitening, settled, whiten


def red(rng, size):
    return lfilter([1.0], [1.0, -1.4, 0.6], rng.standard_normal(size))


def correlation(values, lag):
    return float(values[lag:] @ values[:-lag] / (values @ values))


def test_learns_the_filter_that_made_the_noise():
    rng = np.random.default_rng(1)
    coefficients = learn_whitening([red(rng, 4000) for _ in range(5)], taps=2)
    np.testing.assert_allclose(coefficients, [1.0, -1.4, 0.6], atol=0.03)


def test_whitened_noise_is_white():
    rng = np.random.default_rng(2)
    segments = [scale * red(rng, 1500) for scale in (0.1, 1.0, 30.0)]
    coefficients = learn_whitening(segments)
    for segment in segments:
        white = whiten(coefficients, segment[:, None])[TAPS:, 0]
        for lag in (1, 2, 3):
            assert abs(correlation(white, lag)) < 4.0 / np.sqrt(white.size)
        assert abs(correlation(segment, 1)) > 0.8


def test_a_spike_does_not_spoil_the_filter():
    rng = np.random.default_rng(3)
    clean = [red(rng, 2000)]
    spiky = [clean[0].copy()]
    spiky[0][500] += 1000.0
    np.testing.assert_allclose(learn_whitening(spiky), learn_whitening(clean), atol=0.1)


@pytest.mark.parametrize("segments", [[], [np.zeros(500)], [np.ones(3)]])
def test_nothing_to_learn_from_leaves_the_signal_as_it_is(segments):
    np.testing.assert_array_equal(learn_whitening(segments), [1.0] + TAPS * [0.0])


def test_filtering_is_a_convolution_of_every_column():
    rng = np.random.default_rng(4)
    columns, coefficients = rng.standard_normal((50, 3)), rng.standard_normal(5)
    expected = [np.convolve(coefficients, column)[:50] for column in columns.T]
    np.testing.assert_allclose(whiten(coefficients, columns).T, expected, atol=1e-12)


def test_rows_that_look_back_over_a_start_are_not_settled():
    starts = np.zeros(12, dtype=bool)
    starts[[0, 5]] = True
    expected = [False, False, True, True, True, False, False, True, True, True, True, True]
    assert settled(starts, np.ones(3)).tolist() == expected
    assert settled(starts, np.ones(1)).all()
