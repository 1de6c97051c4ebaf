"""Runs of the sensorless identification and the verdicts that follow."""

from hd_monitor.acquisition.record import JointSamples
from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.identification.sensorless.identifier import SensorlessIdentifier
from hd_monitor.settings import JointSettings


def settings_of(**changes):
    return JointSettings.from_mapping(
        {"input.source": "joint_effort"} | {k.replace("__", "."): v for k, v in changes.items()}
    )


def part(whole, chosen):
    return JointSamples(
        times=whole.times[chosen], angle=whole.angle[chosen], speed=whole.speed[chosen], effort=whole.effort[chosen]
    )


def identify(samples, parameters):
    identifier = SensorlessIdentifier(parameters)
    identifier.add(samples)
    return identifier


def named(identifier, parameters):
    judge = Judge(parameters)
    for _ in range(3):
        verdict = judge.judge(identifier.estimate(), WAITING)
    return verdict.component
