"""Output files: whole or not at all, on a disk that fills up too."""

import os
import resource
import signal
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from hd_monitor.errors import OutputError
from hd_monitor.offline.output import check_file, check_folder, write_file, write_folder


@contextmanager
def room_for(size: int) -> Iterator[None]:
    """Let no file grow beyond `size` bytes, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


@pytest.mark.parametrize(
    "write",
    [
        lambda folder: write_file(folder / "old.txt", "n" * 20_000),
        lambda folder: write_folder(folder, {"old.txt": "new", "more.png": bytes(20_000)}, stale=["stale.png"]),
    ],
)
def test_what_was_there_survives_a_full_disk(tmp_path: Path, write: Callable[[Path], None]) -> None:
    for name in ("old.txt", "stale.png"):
        (tmp_path / name).write_text("old")
    with room_for(10_000), pytest.raises(OutputError, match="cannot be written: File too large; choose another place"):
        write(tmp_path)
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"old.txt": "old", "stale.png": "old"}


@pytest.mark.parametrize("check", [lambda folder: check_file(folder / "new.txt"), check_folder])
def test_a_full_disk_is_found_before_the_work(tmp_path: Path, check: Callable[[Path], None]) -> None:
    with room_for(100), pytest.raises(OutputError, match="File too large"):
        check(tmp_path)
    check(tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_folder_is_made_as_deep_as_needed_but_not_by_the_check(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    check_folder(folder)
    assert not list(tmp_path.iterdir())
    (tmp_path / "a").mkdir()
    write_folder(folder, {"page.html": "<p>", "picture.png": b"png"}, stale=["none.png"])
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == {"page.html": b"<p>", "picture.png": b"png"}


def test_a_new_result_replaces_the_old_one_and_keeps_its_permissions(tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    write_file(file, "first")
    assert stat.S_IMODE(file.stat().st_mode) == 0o666 & ~_umask()
    file.chmod(0o640)
    (tmp_path / "link.json").symlink_to(file)
    write_file(tmp_path / "link.json", "second")
    assert (file.read_text(), stat.S_IMODE(file.stat().st_mode)) == ("second", 0o640)
    assert (tmp_path / "link.json").is_symlink()


def test_a_device_is_written_to_as_it_is() -> None:
    check_file(Path("/dev/null"))
    write_file(Path("/dev/null"), "text")
    with pytest.raises(OutputError, match="No space left on device"):
        write_file(Path("/dev/full"), "text")


def test_a_name_that_is_not_utf_8_is_escaped_as_json_escapes_it(tmp_path: Path) -> None:
    write_file(tmp_path / "out.json", os.fsdecode(b"bag\xff"))
    assert (tmp_path / "out.json").read_text() == "bag\\udcff"


def _umask() -> int:
    umask = os.umask(0)
    os.umask(umask)
    return umask
