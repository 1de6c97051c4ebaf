from tests.hd_monitor.history.entries import entry

from hd_monitor.history.entry import Kind
from hd_monitor.history.property_curves import property_curves
from hd_monitor.orders.rms_curve import SpeedBin


def driven(time, rms, rpm=1200.0, **more):
    return entry(time=time, seconds=1800.0, rms_curve=(SpeedBin(rpm, rms, 100),), **more)


def test_the_baselines_motion_is_pooled_and_so_is_as_much_of_the_newest():
    entries = [driven(1.0, 3.0), driven(2.0, 4.0), driven(3.0, 9.0), driven(4.0, 6.0), driven(5.0, 8.0)]
    before, after = property_curves(entries)
    assert before == (SpeedBin(1200.0, 12.5**0.5, 200),)
    assert after == (SpeedBin(1200.0, 50.0**0.5, 200),)


def test_before_a_mark_there_is_nothing_since():
    entries = [driven(1.0, 3.0), entry(time=2.0, kind=Kind.BASELINE, verdict=None)]
    before, after = property_curves(entries)
    assert before == entries[0].rms_curve
    assert after == ()
    assert property_curves([]) == ((), ())


def test_curves_of_another_width_are_left_out():
    before, after = property_curves([driven(1.0, 3.0, rms_bin_width=50.0), driven(2.0, 4.0), driven(3.0, 5.0)])
    assert before == (SpeedBin(1200.0, 4.0, 100),)
    assert after == (SpeedBin(1200.0, 5.0, 100),)
