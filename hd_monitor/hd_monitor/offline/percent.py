"""Indexes and their standard deviations in words, to the hundredth of a per cent that still means something."""


def percent_with_std(value: float, std: float) -> str:
    """Write a fraction and its standard deviation in per cent, both with two decimals.

    Examples
    --------
    >>> percent_with_std(0.10312, 0.00123), percent_with_std(0.0149, 0.00002)
    ('10.31 ± 0.12 %', '1.49 ± <0.01 %')
    """
    shown = f"{100.0 * std:.2f}" if 100.0 * std >= 0.005 else "<0.01"
    return f"{100.0 * value:.2f} ± {shown} %"
