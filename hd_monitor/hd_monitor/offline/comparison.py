"""What changed between two replays' results: section 6 of Gu et al. 2021 as a tool. Works on the JSON alone."""

import math
from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from ..change import Change
from .errors import BagError
from .line_changes import (
    NOTHING,
    SPLINES,
    CurveChange,
    LineChanges,
    change_between,
    curve_change,
    describe_curve,
    describe_lines,
    line_changes,
    ratio_change,
)
from .result import plain
from .summary import percent_with_std

SMALL = 0.002
"""Change of an index (fraction of the stiffness) that matters to nobody, however significant."""

_TOO_LARGE = 1e100
"""Numbers from here on, infinity and NaN are damage: their ratios and differences mean nothing."""

_BIN_WIDTH = 100.0  # rpm, where a result does not say

_GEOMETRY = ("reducer.flexspline_teeth", "reducer.circular_spline_teeth", "reducer.mount")
_BASIS = ("dynamics.natural_frequency", "dynamics.damping_ratio", "input.source", "load.torque", "load.source")


class Peak(NamedTuple):
    """The highest point of a property curve."""

    rpm: float
    rms: float


class JointChange(NamedTuple):
    """What changed at one joint."""

    joint: str
    before: Mapping[str, Any]
    after: Mapping[str, Any]
    indexes: Mapping[str, Change]
    """Fractions of the stiffness by spline, or shares whose squares add up to one where the result is relative.

    Empty where they cannot be compared, as relative ones with absolute ones.
    """
    relative: bool
    """Whether the indexes are shares."""
    lines: LineChanges
    """Empty where the two were taken from different signals."""
    ratio: Change | None
    """Of the first pair's lines, flexspline over circular spline."""
    curve: CurveChange | None
    peaks: tuple[Peak, Peak] | None
    """Highest points at the speeds that both curves have, before and after; None if they have none in common."""
    sentences: tuple[str, ...]


def compare(before: Mapping[str, Any], after: Mapping[str, Any]) -> list[JointChange]:
    """Compare two replays' results, as ``hd-monitor replay --json`` writes them.

    Raises
    ------
    BagError
        If one of them is not such a result, they have no joint in common, or are of different reducers.
    """
    old, new = _by_joint(before, "first"), _by_joint(after, "second")
    if len(old) == len(new) == 1:
        pairs = [(next(iter(old.values())), next(iter(new.values())))]
    else:
        pairs = [(entry, new[joint]) for joint, entry in old.items() if joint in new]
    if not pairs:
        raise BagError(
            f"the two have no joint in common: {', '.join(old) or 'none'} before, {', '.join(new) or 'none'} after"
        )
    return [_joint_change(*pair) for pair in pairs]


def as_dict(changes: Sequence[JointChange], before: str, after: str) -> dict[str, Any]:
    """Write changes as plain data, fit for JSON."""
    joints = [
        {
            "joint": change.joint,
            "before": change.before["verdict"],
            "after": change.after["verdict"],
            "indexes": [{"spline": spline} | index.as_dict() for spline, index in change.indexes.items()],
            "relative": change.relative,
            "lines": [{"k": k, "spline": spline} | line.as_dict() for (k, spline), line in change.lines.items()],
            "ratio": change.ratio and change.ratio.as_dict(),
            "rms_change": change.curve and change.curve._asdict(),
            "peaks": change.peaks and [peak._asdict() for peak in change.peaks],
            "rms_curve_before": change.before["rms_curve"],
            "rms_curve_after": change.after["rms_curve"],
            "changes": list(change.sentences),
        }
        for change in changes
    ]
    return dict(plain({"before": before, "after": after, "joints": joints}))


def _by_joint(result: Mapping[str, Any], which: str) -> dict[str, Mapping[str, Any]]:
    """Return the entries of the joints that have a verdict, by name; refuse those that cannot be compared."""
    try:
        entries = {entry["joint"]: entry for entry in result["joints"] if entry["verdict"]}
        whole = all(map(_is_whole, entries.values()))
    except (KeyError, TypeError, AttributeError):
        whole = False
    if not whole:
        raise BagError(
            f"the {which} result is not what hd-monitor replay --json writes: values are missing or of the wrong type; "
            "replay the recording again"
        )
    return entries


def _is_whole(entry: Mapping[str, Any]) -> bool:
    """Whether what is read of an entry is of its type; what is missing raises a `KeyError`."""
    verdict, curve = entry["verdict"], entry["rms_curve"]
    indexes = [verdict[f"{spline}_index{suffix}"] for spline in SPLINES for suffix in ("", "_std")]
    lines, given = entry.get("lines", []), entry.get("parameters", {})
    words = [entry["joint"], verdict["component"], verdict["level_name"], verdict["reason"]]
    numbers = [verdict["level"], *(index for index in indexes if index is not None)]
    if not (isinstance(curve, list) and isinstance(lines, list) and isinstance(given, Mapping)):
        return False
    values = [line.get(f"{spline}{suffix}") for line in lines for spline in SPLINES for suffix in ("", "_std")]
    numbers += [point[key] for point in curve for key in ("rpm", "rms")]
    numbers += [line["k"] for line in lines] + [value for value in values if value is not None]
    width = given.get("analysis.rms_bin_width", _BIN_WIDTH)
    return (
        isinstance(width, (int, float))
        and width > NOTHING
        and all(isinstance(word, str) for word in words)
        and all(isinstance(number, (int, float)) and abs(number) < _TOO_LARGE for number in numbers)
    )


def _joint_change(before: Mapping[str, Any], after: Mapping[str, Any]) -> JointChange:
    given, given_now = (entry.get("parameters", {}) for entry in (before, after))
    if differing := [name for name in _GEOMETRY if given.get(name) != given_now.get(name)]:
        raise BagError(
            f"joint {before['joint']!r}: {', '.join(differing)} differ between the two; results of different reducers "
            "cannot be compared: replay both with the right --params"
        )
    sentences = [_verdict_sentence(before["verdict"], after["verdict"])]
    kinds = {bool(entry.get("relative")) for entry in (before, after)}
    relative = True in kinds
    indexes = _index_changes(before["verdict"], after["verdict"]) if len(kinds) == 1 else {}
    if relative:
        sentences.append(
            "The indexes are relative, since torque or transfer function are unknown: compare the lines and their "
            "ratio."
        )
    else:
        sentences += [_index_sentence(_name(spline), change) for spline, change in indexes.items()]
    same_signal = given.get("input.source") == given_now.get("input.source")
    lines = line_changes(before.get("lines", ()), after.get("lines", ())) if same_signal else {}
    ratio = ratio_change(lines)
    sentences += describe_lines(lines, ratio)
    if curve := curve_change(
        before["rms_curve"], after["rms_curve"], float(given.get("analysis.rms_bin_width", _BIN_WIDTH))
    ):
        sentences.append(describe_curve(curve))
    peaks = _peaks(before["rms_curve"], after["rms_curve"])
    if peaks is not None:
        sentences.append(_peak_sentence(*peaks))
    elif before["rms_curve"] and after["rms_curve"]:
        sentences.append("The two recordings have no speed in common, so that their vibration cannot be compared.")
    if changed := [name for name in _BASIS if given.get(name) != given_now.get(name)]:
        sentences.append(f"Mind that the two were analysed with different values of {', '.join(changed)}.")
    return JointChange(
        joint=before["joint"],
        before=before,
        after=after,
        indexes=indexes,
        relative=relative,
        lines=lines,
        ratio=ratio,
        curve=curve,
        peaks=peaks,
        sentences=tuple(sentences),
    )


def _index_changes(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Change]:
    found = {spline: change_between(before, after, f"{spline}_index") for spline in SPLINES}
    return {spline: change for spline, change in found.items() if change is not None}


def _peaks(before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]]) -> tuple[Peak, Peak] | None:
    """Highest points within the range of speeds that both curves cover."""
    if not before or not after:
        return None
    low = max(before[0]["rpm"], after[0]["rpm"])
    high = min(before[-1]["rpm"], after[-1]["rpm"])
    margin = 0.05 * max(low, high)
    old, new = (
        [Peak(b["rpm"], b["rms"]) for b in curve if low - margin <= b["rpm"] <= high + margin]
        for curve in (before, after)
    )
    highest = itemgetter(1)
    return (max(old, key=highest), max(new, key=highest)) if old and new else None


def _name(word: str) -> str:
    return word.replace("_", " ")


def _verdict_sentence(before: Mapping[str, Any], after: Mapping[str, Any]) -> str:
    words = {"none": "no defect", "both": "both splines"}
    old, new = (words.get(verdict["component"], _name(verdict["component"])) for verdict in (before, after))
    if (before["component"], before["level"]) == (after["component"], after["level"]):
        return f"The verdict is the same: {old}, {before['level_name']}."
    if after["component"] == "undetermined":
        return (
            f"The first named {old}, {before['level_name']}; the second bears no name, which is less evidence and no "
            f"deterioration by itself: {after['reason']}"
        )
    if before["component"] == "undetermined":
        return f"The first bore no name; the second has evidence for one: {new}, {after['level_name']}."
    return f"The verdict went from {old}, {before['level_name']}, to {new}, {after['level_name']}."


def _index_sentence(name: str, change: Change) -> str:
    old = percent_with_std(change.before, change.before_std)
    new = percent_with_std(change.after, change.after_std)
    if not change.significant:
        return f"The {name}'s index did not change significantly: {old} before, {new} after (p = {change.p_value:.2g})."
    if abs(change.change) < SMALL:
        return f"The {name}'s index hardly changed: {old} before, {new} after."
    verb = "rose" if change.change > 0 else "fell"
    share = f", by {100 * abs(change.change) / change.before:.0f} %" if change.before > SMALL else ""
    p_value = "< 0.001" if change.p_value < 0.001 else f"= {change.p_value:.2g}"
    return f"The {name}'s index {verb} from {old} to {new}{share}; significant (p {p_value})."


def _peak_sentence(before: Peak, after: Peak) -> str:
    ratio = after.rms / before.rms if before.rms > 0.0 else math.inf
    if abs(ratio - 1.0) < 0.05:
        change = "is about the same"
    else:
        change = ("rose" if ratio > 1.0 else "fell") + (f" to {100 * ratio:.0f} %" if math.isfinite(ratio) else "")
    return (
        f"The largest vibration at the speeds that both recordings have {change}: {before.rms:.3g} m/s² at "
        f"{before.rpm:.0f} rpm before, {after.rms:.3g} m/s² at {after.rpm:.0f} rpm after."
    )
