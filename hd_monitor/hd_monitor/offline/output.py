"""Files that a command writes: tried before the work, written whole or not at all, so that nothing old is lost."""

import shutil
import tempfile
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ..errors import OutputError

_TRIAL = bytes(4096)  # an empty file may still be made on a full disk


def check_file(path: Path) -> None:
    """Raise an :class:`OutputError` if no file can be written there; leave nothing behind."""
    with _explained(path):
        if _is_plain(path):
            _check(path.resolve().parent)


def check_folder(folder: Path) -> None:
    """Raise an :class:`OutputError` if the folder cannot be made or written to; leave nothing behind."""
    with _explained(folder):
        _check(next(place for place in (folder, *folder.absolute().parents) if place.exists()))


def write_file(path: Path, text: str) -> None:
    """Write a text file; raise an :class:`OutputError` if that fails, and what was there is still there."""
    with _explained(path):
        if _is_plain(path):
            real = path.resolve()
            _write(real.parent, {real.name: text})
        else:
            path.write_bytes(_bytes(text))


def write_folder(folder: Path, files: Mapping[str, str | bytes], stale: Collection[str] = ()) -> None:
    """Write files by their names into a folder, made if missing, and remove `stale` ones of an earlier result.

    Raises
    ------
    OutputError
        If the folder cannot be written; what was there is still there.
    """
    with _explained(folder):
        folder.mkdir(parents=True, exist_ok=True)
        _write(folder, files)
        for name in stale:
            (folder / name).unlink(missing_ok=True)


def _write(folder: Path, files: Mapping[str, str | bytes]) -> None:
    with tempfile.TemporaryDirectory(prefix=".hd-monitor-", dir=folder) as new:
        for name, content in files.items():
            (Path(new) / name).write_bytes(_bytes(content))
            if _is_plain(folder / name) and (folder / name).exists():
                shutil.copymode(folder / name, Path(new) / name)
        for name in files:
            (Path(new) / name).replace(folder / name)


def _check(folder: Path) -> None:
    with tempfile.TemporaryDirectory(prefix=".hd-monitor-", dir=folder) as new:
        (Path(new) / "trial").write_bytes(_TRIAL)


def _is_plain(path: Path) -> bool:
    """Whether a file may be put there by renaming: not onto a device or a pipe, which are written to as they are."""
    if path.is_file() or path.is_dir():
        path.open("ab").close()  # raises the error that writing would; renaming replaces even a write-protected file
    return path.is_file() or not path.exists()


def _bytes(content: str | bytes) -> bytes:
    # A file name that is not UTF-8 is escaped, in JSON in the very way that JSON escapes.
    return content if isinstance(content, bytes) else content.encode("utf-8", "backslashreplace")


@contextmanager
def _explained(place: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(f"{place} cannot be written: {error.strerror or error}; choose another place") from None
