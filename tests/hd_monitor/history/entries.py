"""Entries of a made-up reducer."""

import math

from hd_monitor.diagnosis.verdict import Component, FaultCode, Level, Verdict
from hd_monitor.history.entry import Entry, Kind
from hd_monitor.identification.result import LineEstimate
from hd_monitor.identification.sensorless.agreement import DirectionEvidence
from hd_monitor.orders.rms_curve import SpeedBin
from hd_monitor.reducer import LinePair

VERDICT = Verdict(
    component=Component.FLEXSPLINE, level=Level.WARN, fault_code=FaultCode.FLEXSPLINE, reason="The flexspline …"
)


def entry(time=1.0, serial="S1", joint="arm", index=(0.02, 0.06), std=0.002, lines=(1.0, 2.0), line_std=0.05, **more):
    given = {
        "serial": serial,
        "joint": joint,
        "time": time,
        "kind": Kind.EVIDENCE,
        "verdict": VERDICT,
        "index": LinePair(*index),
        "index_std": LinePair(std, std),
        "lines": (LineEstimate(k=1, amplitude=LinePair(*lines), std=LinePair(line_std, line_std)),),
        "rms_curve": (SpeedBin(1200.0, 0.3, 1000),),
        "revolutions": 2000.0,
        "seconds": 100.0,
        "speed": 1200.0,
        "source": "block",
    }
    return Entry(**given | more)


def direction(name="forward", amplitude=(3.0, 1.0)):
    return DirectionEvidence(
        name=name,
        amplitude=LinePair(*amplitude),
        std=LinePair(0.1, 0.1),
        chance=LinePair(1e-6, 0.5),
        dominance=LinePair(0.999, 0.001),
        rival=None,
        segments=4,
        samples=800,
        noise=0.2,
        floor=1.0,
        speed=0.5,
        seconds=8.0,
        travel=math.pi,
    )
