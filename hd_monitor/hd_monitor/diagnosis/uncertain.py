"""Values with their uncertainty: the standard deviation to two significant digits, the value as finely."""

import math


def significant(std: float) -> str:
    """Write a standard deviation to two significant digits, without an exponent.

    Examples
    --------
    >>> significant(0.0391), significant(0.0000123), significant(147.0), significant(0.0)
    ('0.039', '0.000012', '147', '0')
    """
    return f"{std:.{decimals(std)}f}"


def with_std(value: float, std: float, *, sign: str = "") -> str:
    """Write a value with its standard deviation, as finely as that means something.

    Parameters
    ----------
    value, std : float
        In the same unit.
    sign : str
        ``'+'`` to write the sign of a positive value too.

    Examples
    --------
    >>> with_std(10.3371, 0.0391), with_std(1.48, 0.2), with_std(30.1, 4.93, sign="+"), with_std(0.213, 0.0)
    ('10.337 ± 0.039', '1.48 ± 0.20', '+30.1 ± 4.9', '0.213 ± 0')
    """
    shown = f"{value:{sign}.{decimals(std)}f}" if std > 0.0 else f"{value:{sign}.4g}"
    return f"{shown} ± {significant(std)}"


def decimals(std: float) -> int:
    """Decimals with which a value and its standard deviation are written."""
    if not (math.isfinite(std) and std > 0.0):
        return 0
    return max(0, 1 - math.floor(math.log10(float(f"{std:.1e}"))))  # rounded first: 0.0999 is 0.10
