"""Every process of ours keeps linear algebra on one thread, unless told otherwise, and freed memory mapped."""

import os
import platform
import signal
import subprocess
import sys
from collections.abc import Callable

import pytest

from hd_monitor.process import guard

VARIABLE = "OPENBLAS_NUM_THREADS"


def output_of(script: str, **environment: str) -> str:
    """What a fresh interpreter prints, which inherits nothing about threads."""
    outer = {name: value for name, value in os.environ.items() if name != VARIABLE}
    done = subprocess.run(
        [sys.executable, "-c", script], env=outer | environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


@pytest.mark.parametrize(("environment", "threads"), [({}, "1"), ({VARIABLE: "3"}, "3")])
def test_one_thread_unless_the_environment_says_otherwise(environment: dict[str, str], threads: str) -> None:
    script = f"import os, hd_monitor.process as p; p.set_up_process(); print(os.environ['{VARIABLE}'])"
    assert output_of(script, **environment) == threads


@pytest.mark.parametrize(
    "module", ["hd_monitor.cli.main", "hd_monitor.ros.__main__", "hd_sim_node.__main__", "hd_sim_node.bag_command"]
)
def test_an_executable_says_so_before_numpy_comes(module: str) -> None:
    """Numpy reads the number at import: later is too late."""
    script = f"""
import os, sys
import {module} as executable
assert "{VARIABLE}" not in os.environ, "importing a module must not change the environment"
assert "numpy" not in sys.modules
class Found(BaseException): ...
class Watch:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            raise Found
sys.meta_path.insert(0, Watch())
try:
    executable.main(["parameters"])
except Found:
    print(os.environ.get("{VARIABLE}"))
"""
    assert output_of(script) == "1"


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library has another allocator")
def test_freed_memory_is_not_mapped_again_and_again() -> None:
    script = """
import resource
from hd_monitor.process import set_up_process
set_up_process()
import numpy as np
def work():
    arrays = [np.ones(40_000) for _ in range(8)]
    return sum(float(array[0]) for array in arrays)
work()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(20): work()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""
    pages_of_a_round = 8 * 40_000 * 8 // 4096
    assert int(output_of(script)) < pages_of_a_round


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library has another allocator")
def test_memory_that_nothing_needs_goes_back_although_what_came_later_stays() -> None:
    script = """
from hd_monitor.process import set_up_process, trim_memory
set_up_process()
import numpy as np
def resident():  # MB
    lines = dict(line.split(":", 1) for line in open("/proc/self/status"))
    return int(lines["VmRSS"].split()[0]) / 1024
large = [np.ones(5_000) for _ in range(1_000)]
later = np.ones(5_000)
del large
before = resident()
trim_memory()
print(before - resident())
"""
    assert float(output_of(script)) > 30.0  # of 40 MB


INTERRUPTED_IMPORT = """
import os, signal, time
from hd_monitor.process import guard
def load():
    try:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(10)
    except BaseException:  # as libraries in C do
        raise ImportError("initialization failed")
guard("name", load)
"""


def test_an_interrupt_of_the_imports_ends_at_once_and_says_nothing() -> None:
    done = subprocess.run([sys.executable, "-c", INTERRUPTED_IMPORT], capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, b"", b"")


def test_an_interrupt_of_the_work_undoes_it_and_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    undone = []

    def work() -> int:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            return 0
        finally:
            undone.append(True)

    assert guard("name", lambda: work) == 130
    assert undone == [True]
    assert capsys.readouterr() == ("", "")


def test_packages_that_do_not_fit_each_other_are_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    def load() -> Callable[[], int]:
        raise ImportError("pyarrow requires NumPy 2.0 or newer,\nfound 1.26.4")

    assert guard("name", load) == 2
    said = "name: pyarrow requires NumPy 2.0 or newer, found 1.26.4; install versions of the Python packages that fit"
    assert capsys.readouterr() == ("", f"{said} each other\n")


def test_a_name_that_our_own_modules_lack_is_our_error(capsys: pytest.CaptureFixture[str]) -> None:
    def load() -> Callable[[], int]:
        from hd_monitor.errors import NoSuchError  # type: ignore[attr-defined]

        raise NoSuchError

    assert guard("name", load) == 3
    assert "name: internal error (ImportError: cannot import name 'NoSuchError'" in capsys.readouterr().err
