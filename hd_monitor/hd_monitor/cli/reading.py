"""The arguments that say how a recording is to be read; imports nothing, so that commands may do without."""

import argparse
from pathlib import Path


def add_reading_arguments(parser: argparse.ArgumentParser) -> None:
    """Add them to a command's own."""
    parser.add_argument("--params", type=Path, metavar="FILE", help="ROS parameter file, the same as the node's")
    parser.add_argument("--node", metavar="NAME", help="full name of the node in FILE whose parameters are meant")
    parser.add_argument(
        "-p", "--param", action="append", default=[], metavar="NAME:=VALUE", help="set one parameter (repeatable)"
    )
    parser.add_argument(
        "--joint", action="append", default=[], metavar="NAME", help="joint to look at (repeatable); default: all"
    )
    parser.add_argument(
        "--remap", action="append", default=[], metavar="FROM:=TO", help="topic of the contract := recorded topic"
    )
    parser.add_argument("--namespace", metavar="NS", help="namespace of the node, where several were recorded")
