"""The node as a process: how it is started, and what its messages say."""

import itertools

import numpy as np

from hd_monitor.contract import NANOSECONDS, unpack_blocks

MODULE = "hd_sim_node"
NODE = "hd_sim_node"
BRIEF = {
    "programme": "fixed",
    "fixed.speed": 1600.0,
    "duration": 1.0,
    "time_scale": 10.0,
    "wait_for_subscribers": 1,
    "exit_at_end": True,
    "seed": 5,
}


def arguments(**changes):
    values = BRIEF | {name.replace("__", "."): value for name, value in changes.items()}
    texts = {True: "true", False: "false"}
    pairs = [("-p", f"{n}:={texts.get(v, v) if isinstance(v, bool) else v}") for n, v in values.items()]
    return ["--ros-args", *itertools.chain.from_iterable(pairs)]


def stamp_of(message):
    return message.header.stamp.sec * NANOSECONDS + message.header.stamp.nanosec


def blocks_of(received):
    return [
        block
        for m in received
        for block in unpack_blocks(
            [(d.label, d.size, d.stride) for d in m.layout.dim], m.layout.data_offset, np.asarray([m.data])
        )
    ]
