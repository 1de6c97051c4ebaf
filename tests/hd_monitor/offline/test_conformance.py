"""Every combination of MCAP's optional parts reads the same, however it is read."""

import json
import tarfile
from collections.abc import Iterator
from pathlib import Path, PurePath
from typing import Any, NamedTuple

import pytest
from tests.hd_monitor.offline.mcap_files import zstd

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
