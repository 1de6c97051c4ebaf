"""The block's layout: a packed block unpacks to the same, and deviations from the contract are named."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hd_monitor.contract import (
    BLOCK_LABEL,
    Block,
    Dimension,
    pack_block,
    rms_layout,
    unpack_blocks,
    zoom_layout,
)
from hd_monitor.errors import LayoutError

STAMP = 1_700_000_000_123_456_789


def unpack(dimensions, data_offset, data):
    """Read one message; raise what is wrong with it."""
    (block,) = unpack_blocks(dimensions, data_offset, np.asarray([data], dtype=np.float64))
    if isinstance(block, LayoutError):
        raise block
    return block


def packed(count=3):
    dimension, data = pack_block(Block(STAMP, 1e-3, 7, np.arange(float(count))))
    return [dimension], 4, data


@given(
    st.integers(0, 2**33 * 10**9 - 1),
    st.floats(1e-6, 9.9),
    st.integers(0, 2**53),
    arrays(np.float64, st.integers(0, 40), elements=st.floats(allow_nan=True)),
)
def test_a_round_trip_is_exact(stamp, period, sequence, samples):
    dimension, data = pack_block(Block(stamp, period, sequence, samples))
    block = unpack([dimension], 4, data)
    assert block[:3] == (stamp, period, sequence)
    np.testing.assert_array_equal(block.samples, samples)


def test_the_layout_is_the_contracts():
    dimensions, _, data = packed()
    assert dimensions == [Dimension("torsional_acceleration", 3, 3)]
    assert data.tolist() == [1_700_000_000.0, 123_456_789.0, 1e-3, 7.0, 0.0, 1.0, 2.0]


def test_a_plain_tuple_is_read_as_a_dimension():
    block = unpack([("torsional_acceleration", 1, 1)], 4, [5, 0, 0.5, 0, 9])
    assert block.stamp == 5_000_000_000
    assert block.samples.tolist() == [9.0]


@pytest.mark.parametrize(
    ("dimensions", "match"),
    [
        ([], "0 dimensions"),
        ([(BLOCK_LABEL, 3, 3), ("x", 1, 1)], "2 dimensions"),
        ([("acceleration", 3, 3)], "labelled 'acceleration'"),
        ([(BLOCK_LABEL, 4, 4)], "announces 4 samples"),
        ([(BLOCK_LABEL, 3, 1)], "stride 1"),
    ],
)
def test_wrong_dimensions_are_refused(dimensions, match):
    with pytest.raises(LayoutError, match=match):
        unpack(dimensions, 4, packed()[2])


def test_a_wrong_offset_is_refused():
    with pytest.raises(LayoutError, match="data_offset is 0"):
        unpack(packed()[0], 0, packed()[2])


@pytest.mark.parametrize("data", [[], [1.0, 2.0, 3.0], [1.0, 0.0, 1e-3]])
def test_a_block_cut_short_is_refused(data):
    with pytest.raises(LayoutError, match="announces 0 samples"):
        unpack([(BLOCK_LABEL, 0, 0)], 4, data)


@pytest.mark.parametrize(
    ("place", "value", "match"),
    [
        (0, 1.5, "whole"),
        (0, -1.0, "whole"),
        (0, math.nan, "whole"),
        (0, 2.0**33, "whole"),
        (1, 1e9, "whole"),
        (1, math.inf, "whole"),
        (3, -1.0, "whole"),
        (3, 0.5, "whole"),
        (2, 0.0, "period"),
        (2, -1e-3, "period"),
        (2, math.nan, "period"),
        (2, 10.0, "period"),
    ],
)
def test_a_meaningless_header_is_refused(place, value, match):
    dimensions, offset, data = packed()
    data[place] = value
    with pytest.raises(LayoutError, match=match):
        unpack(dimensions, offset, data)


def test_an_empty_block_is_a_block():
    dimension, data = pack_block(Block(STAMP, 1e-3, 0, np.empty(0)))
    assert unpack([dimension], 4, data).samples.size == 0


@pytest.mark.parametrize("field", ["stamp", "sequence"])
def test_negative_stamps_and_numbers_are_refused(field):
    block = Block(**(Block(STAMP, 1e-3, 7, np.zeros(3))._asdict() | {field: -1}))
    dimension, data = pack_block(block)
    with pytest.raises(LayoutError):
        unpack([dimension], 4, data)


def test_the_other_layouts_describe_their_tables():
    assert zoom_layout() == (Dimension("frequency_amplitude", 2, 100), Dimension("bin", 50, 50))
    assert rms_layout(7) == (Dimension("speed_bin", 7, 21), Dimension("rpm_rms_samples", 3, 3))
