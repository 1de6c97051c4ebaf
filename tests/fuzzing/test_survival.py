"""The check of hostile inputs finds the faults that are planted."""

import struct
from collections.abc import Callable

import numpy as np
import pytest
from tests.fuzzing import survival
from tests.fuzzing.survival import EndlessWork, damaged, survive, trusts_a_count


def _allocates_a_count(data: bytes) -> None:
    if len(data) >= 8:
        np.ones(min(struct.unpack_from("<I", data, 4)[0], 2**26))


def _repeats_a_count(data: bytes) -> None:
    if len(data) >= 8:
        for _ in range(struct.unpack_from("<I", data, 4)[0]):
            pass


@pytest.mark.parametrize(
    ("reader", "error"),
    [(trusts_a_count, struct.error), (_allocates_a_count, AssertionError), (_repeats_a_count, EndlessWork)],
)
def test_a_planted_fault_is_found(
    reader: Callable[[bytes], None], error: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(survival, "PROCESSOR_SECONDS", 0.2)
    monkeypatch.setattr(survival, "MEMORY", 2**25)
    with pytest.raises(error):
        survive(reader, damaged(struct.pack("<IIQ", 1, 8, 5)), weight=4)
