"""Every combination of MCAP's optional parts reads the same, however it is read."""

import itertools
import json
import random
import tarfile
from collections.abc import Iterator
from pathlib import Path, PurePath
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest
from tests.hd_monitor.offline import mcap_files
from tests.hd_monitor.offline.mcap_files import Sent, zstd

from hd_monitor.offline.bag import Bag
from hd_monitor.offline.errors import BagError

ARCHIVE = Path(__file__).resolve().parents[4] / "shared/data/mcap-conformance/variants.tar.gz"


class Variant(NamedTuple):
    """A file, and what it holds by the JSON beside it: (topic, type, time, data) of each message."""

    name: str
    content: bytes
    messages: list[tuple[str, str, int, bytes]]


def expected(records: list[dict[str, Any]]) -> Iterator[tuple[str, str, int, bytes]]:
    types, topics = {"0": "untyped"}, {}
    for record in records:
        fields = dict(record["fields"])
        match record["type"]:
            case "Schema":
                types[fields["id"]] = fields["name"]
            case "Channel":
                kind = f"{types[fields['schema_id']]} in {fields['message_encoding']}"
                topics[fields["id"]] = fields["topic"], kind
            case "Message":
                data = bytes(map(int, fields["data"]))
                yield *topics[fields["channel_id"]], int(fields["log_time"]), data


@pytest.fixture(scope="module")
def variants() -> list[Variant]:
    if not ARCHIVE.is_file():
        pytest.skip("the MCAP conformance variants are not beside this checkout: shared/data/mcap-conformance")
    with tarfile.open(ARCHIVE) as archive:
        files = {PurePath(member.name): archive.extractfile(member) for member in archive if member.isfile()}
        contents = {path: file.read() for path, file in files.items() if file is not None}
    return [
        Variant(path.name, content, list(expected(json.loads(contents[path.with_suffix(".json")])["records"])))
        for path, content in contents.items()
        if path.suffix == ".mcap"
    ]


def read(path: Path) -> tuple[list[tuple[str, str, int, bytes]], list[str]]:
    with Bag(path) as bag:
        types = {topic.name: topic.type for topic in bag.topics}
        found = [(name, types[name], time, data) for name, time, data in bag.messages(list(types))]
        assert sum(topic.messages for topic in bag.topics) == len(found)
        return found, bag.notes


FORMS = ("as it is", "compressed", "in a folder", "not closed")


@pytest.mark.shared_data
@pytest.mark.parametrize("form", FORMS)
def test_every_variant_gives_its_messages(tmp_path: Path, variants: list[Variant], form: str) -> None:
    assert len(variants) == 416
    for variant in variants:
        folder = tmp_path / variant.name
        folder.mkdir()
        path = folder / variant.name
        path.write_bytes(variant.content[:-8] if form == "not closed" else variant.content)
        if form == "compressed":
            path = path.with_name(f"{path.name}.zstd")
            path.write_bytes(zstd.compress(variant.content))
        elif form == "in a folder":
            path = folder
        if not variant.messages:
            with pytest.raises(BagError, match="holds no messages"):
                Bag(path)
            continue
        found, notes = read(path)
        assert sorted(found) == sorted(variant.messages), variant.name
        assert bool(notes) is (form in {"in a folder", "not closed"}), notes
        if "-ch-" in variant.name:  # messages of a chunk come by time, those outside chunks as they were written
            assert [row[2] for row in found] == sorted(row[2] for row in found), variant.name


TOPICS = ("/a", "/b")


def chunks_of(dice: random.Random, first: int, *, overlapping: bool) -> list[list[Sent]]:
    """Chunks of messages of all lengths, some without any; overlapping in time or one after the other."""
    chunks = []
    for number in range(4):
        begin = first + (0 if overlapping else 1000 * number)
        count = dice.choice([0, 1, 30])
        chunks.append([Sent(dice.randint(1, 2), begin + dice.randrange(999), dice.randbytes(n)) for n in range(count)])
    return [*chunks, [Sent(1, first + 5000, b"last")]]


@pytest.mark.parametrize("compression", ["", "lz4", "zstd"])
@pytest.mark.parametrize("overlapping", [False, True])
@pytest.mark.parametrize("checksum", ["none", "right", "wrong"])
@pytest.mark.parametrize("files", [1, 3])
@pytest.mark.parametrize("closed", [True, False])
def test_our_own_variants_give_their_messages(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    compression: str,
    overlapping: bool,
    checksum: str,
    files: int,
    closed: bool,
) -> None:
    dice = random.Random(1)
    if checksum == "wrong":
        monkeypatch.setattr(mcap_files, "zlib", SimpleNamespace(crc32=lambda _: 1))
    sent = []
    for number in range(files):
        chunks = chunks_of(dice, 10_000 * number + 1, overlapping=overlapping)
        path = tmp_path / f"bag_{number}.mcap"
        options = {"compression": compression, "checksum": checksum != "none"}
        mcap_files.write(path, chunks, TOPICS, **options)  # type: ignore[arg-type]
        if not closed:
            path.write_bytes(path.read_bytes()[:-8])
        sent += [(TOPICS[m.channel - 1], m.time, m.data) for m in itertools.chain(*chunks)]
    with Bag(tmp_path if files > 1 else path) as bag:
        found = list(map(tuple, bag.messages(TOPICS)))
    notes = "; ".join(note for note in bag.notes if "metadata.yaml" not in note)
    assert sorted(found) == sorted(sent)
    if closed and checksum != "wrong":
        assert found == sorted(sent, key=lambda row: row[1])
        assert not notes
    elif closed:
        assert notes.count("the checksum of a chunk is wrong") == files
    else:
        assert notes.count("is not whole") == files
