"""How a process of ours begins, treating its machine well, and ends, with an exit status and a line that says why."""

import ctypes
import io
import os
import signal
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress

from .errors import FAILED, UNUSABLE_INPUT, HdMonitorError, OutputError

READER_GONE = 128 + signal.SIGPIPE
"""Exit status where the reader of the output has left, as a shell reports it of other commands."""

INTERRUPTED = 128 + signal.SIGINT

STATUSES = (
    "exit status: 0 done; 1 done, and the answer is bad (--fail-on met, a claim failed, the demo's part not named); "
    "2 unusable input, parameters or arguments, or a package is missing; 3 the output cannot be written, or an error "
    "of our own; 130 interrupted; 141 the reader of the output has left"
)

_SYMBOLS = "ζ±²"  # in what the commands print
_EXTRAS = {"pyarrow": "parquet", "textual": "watch", "rich": "watch"}
_ROS = {"rclpy", "rcl_interfaces", "builtin_interfaces", "lifecycle_msgs", "std_srvs"}


def set_up_process() -> None:
    """Keep linear algebra on one thread, and freed memory mapped; call it before numpy is imported.

    Matrices of a few dozen columns gain nothing by a second thread, and on a processor that has other work, as a
    robot's does, the threads wait for each other: a replay then takes three times as long. One thread also makes the
    last digits, and with them a verdict, independent of the number of cores. ``OPENBLAS_NUM_THREADS`` in the
    environment has the last word. To see what more threads cost, set it to 2 and run
    ``tests/benchmarks/replay_speed.py``.

    The C library of Linux gives back to the system what an array of more than 128 kB occupied, and the next array has
    its pages mapped and cleared again. It stops doing so for sizes of which one has been freed before.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    bytes(8_000_000)  # freed at once, and never touched; the arrays of a stretch have up to a few million bytes


def trim_memory() -> None:
    """Give back to the system what is free on the heap; for a process that runs for months.

    A fit that is sought anew, once in hours, takes tens of megabytes for less than a second. Without this they stay
    with the process, since a few bytes above them are still in use. Only glibc needs it.
    """
    if (trim := getattr(ctypes.CDLL(None), "malloc_trim", None)) is not None:
        trim(ctypes.c_size_t(0))


def guard(name: str, load: Callable[[], Callable[[], int]]) -> int:
    """Do an executable's work and return its exit status; what goes wrong becomes one line that begins with `name`.

    Only an error of our own has a traceback before that line.

    Parameters
    ----------
    name : str
    load : callable
        Imports what is needed and returns the work, which returns the exit status. An interrupt ends the process at
        once while it loads: there is nothing to undo, and libraries make other errors of an interrupted import.
    """
    try:
        _check_streams()
        try:
            interrupt = signal.signal(signal.SIGINT, signal.SIG_DFL)
            try:
                work = load()
            finally:
                signal.signal(signal.SIGINT, interrupt)
            return work()
        finally:
            sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # the reader has seen enough, as `| head` has
        return READER_GONE
    except ModuleNotFoundError as error:
        return _end(f"{name}: {_missing(error)}", UNUSABLE_INPUT)
    except ImportError as error:  # as of a pyarrow that needs a newer numpy
        if (error.name or "").startswith("hd_"):
            return _internal_error(name, error)
        what = " ".join(str(error).split())
        return _end(f"{name}: {what}; install versions of the Python packages that fit each other", UNUSABLE_INPUT)
    except HdMonitorError as error:
        return _end(f"{name}: {error}", error.status)
    except OSError as error:
        place = error.filename or "standard output"
        return _end(f"{name}: {place} cannot be written: {error.strerror or error}", FAILED)
    except Exception as error:
        return _internal_error(name, error)
    finally:
        _silence_broken_streams()


def _check_streams() -> None:
    """Refuse to begin where the result could not be shown.

    The next file to be opened would get the number of a closed stream, and what C libraries print would go there.
    """
    for stream, name in ((sys.stdout, "output"), (sys.stderr, "error")):
        if stream is None:
            raise OutputError(f"standard {name} is closed; redirect it, to /dev/null if nobody is to read it")
    encoding = sys.stdout.encoding or "utf-8"
    try:
        _SYMBOLS.encode(encoding)
    except UnicodeEncodeError:
        raise OutputError(
            f"standard output is encoded in {encoding}, which lacks {_SYMBOLS[0]!a}; set PYTHONIOENCODING=utf-8"
        ) from None
    if isinstance(sys.stdout, io.TextIOWrapper):  # file names need not be UTF-8; in JSON the escape is the right one
        sys.stdout.reconfigure(errors="backslashreplace")


def _end(line: str, status: int) -> int:
    with suppress(OSError):
        print(line, file=sys.stderr)  # on standard output, if standard error is closed
    return status


def _internal_error(name: str, error: Exception) -> int:
    with suppress(OSError):
        traceback.print_exc()
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return _end(f"{name}: internal error ({what}); please report it with the lines above", FAILED)


def _silence_broken_streams() -> None:
    """Keep the interpreter, which flushes once more at exit, from complaining."""
    for stream in (sys.stdout, sys.stderr):
        if stream is None:
            continue
        try:
            stream.flush()
        except OSError:
            with suppress(OSError):
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _missing(error: ModuleNotFoundError) -> str:
    """Say what is not installed and how to get it."""
    name = (error.name or "").partition(".")[0]
    if name == "hd_sim_node":
        from .cli.extensions import SIMULATOR_MISSING

        return SIMULATOR_MISSING
    if name in _ROS or name.endswith("_msgs"):
        return (
            f"needs ROS 2 ({name} is missing): source your ROS installation, or run pip install '.[ros]' "
            "in the checkout"
        )
    extra = _EXTRAS.get(name, "offline")
    return (
        f"needs the Python package {name!r}, which is not installed: run pip install '.[{extra}]' in the checkout; "
        "with colcon, or where pip calls the environment externally managed, see the README, On a robot"
    )
