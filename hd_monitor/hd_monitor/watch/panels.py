"""What the screen holds, as lines for a width: a row for each joint, and all about the one that is selected."""

from collections.abc import Mapping
from itertools import chain, groupby, repeat

from ..cdr import ReceivedStatus
from ..diagnosis.verdict import Level
from . import answers, drawing
from .curves import NAMES
from .lines import Line, Span, cut, labelled, line
from .reading import number
from .state import Joint, View, seconds_between

_WIDTHS = {"LEVEL": 8, "JOINT": 0, "PART": 16, "HOW BAD": 13, "95 % SURE OF": 15, "INPUT": 6, "SINCE": 7}
_LONGEST_NAME = 24
_ROLES = {"OK": "ok", "WARN": "warn", "ERROR": "error", "GONE": "error"}
_LOWEST, _HIGHEST = 9, 20  # lines of a curve


def title(view: View, width: int) -> Line:
    """What is watched, from where, and how many joints are how."""
    words = [answers.state(joint, view) for joint in view.ranked]
    counts = ", ".join(f"{words.count(word)} {word}" for word in answers.STATES if word in words)
    progress = "" if view.progress in (None, 1.0) else f", {view.progress:.0%}"
    right = f"{len(words)} joint{'' if len(words) == 1 else 's'}{': ' if counts else ''}{counts} "
    return line(Span(cut(f" {view.source}{progress}", max(width - len(right), 0)) + right, "strong"))


def listing(view: View, selected: Joint, width: int, rows: int) -> list[Line]:
    """All joints, a row each below their heads; of more than `rows` those around the selected one."""
    ranked = view.ranked
    first = first_shown(view, selected, rows)
    columns = _columns(width - 1)
    heads = line(Span(" " + "".join(cut(name, size - 1) + " " for name, size in columns.items()), "quiet"))
    shown = [_row(joint, view, columns, selected=joint is selected) for joint in ranked[first : first + rows]]
    hidden = len(ranked) - len(shown)
    return [heads, *shown, *([line(Span(f" and {hidden} more", "quiet"))] if hidden else [])]


def first_shown(view: View, selected: Joint, rows: int) -> int:
    """Place, among the ranked joints, of the first that `listing` shows."""
    return max(0, min(view.ranked.index(selected) - rows // 2, len(view.joints) - rows))


def _row(joint: Joint, view: View, columns: Mapping[str, int], *, selected: bool) -> Line:
    """Every answer about a joint in short."""
    state = answers.state(joint, view)
    cells = {
        "LEVEL": state,
        "JOINT": _name(joint, view),
        "PART": answers.part(joint),
        "HOW BAD": answers.how_bad_in_short(joint),
        "95 % SURE OF": answers.how_sure_in_short(joint),
        "INPUT": answers.input_word(joint),
        "SINCE": answers.since_in_short(joint),
        "TO DO": answers.to_do(joint, view),
    }
    roles = {"LEVEL": _ROLES.get(state, ""), "JOINT": "strong"}
    if joint.input_level > Level.OK:
        roles["INPUT"] = _ROLES[joint.input_level.name]
    spans = [Span(cut(cells[name], size - 1) + " ", roles.get(name, "")) for name, size in columns.items()]
    marked = [span._replace(role=f"{span.role} selected".strip()) for span in spans] if selected else spans
    return line(">" if selected else " ", *marked)


def _name(joint: Joint, view: View) -> str:
    """The joint's name; behind its node's namespace where there are several nodes."""
    several = len({key.node for key in view.joints}) > 1
    return f"{joint.key.node.rpartition('/')[0]}/{joint.key.joint}".lstrip("/") if several else joint.key.joint


def _columns(width: int) -> dict[str, int]:
    """Widths of the columns; the joint's name has what the others leave, up to a bound, and what to do the rest."""
    rest = max(width - sum(_WIDTHS.values()), 6)
    widths = {name: size or min(rest, _LONGEST_NAME) for name, size in _WIDTHS.items()}
    return widths | ({"TO DO": rest - _LONGEST_NAME} if rest > _LONGEST_NAME + 20 else {})


def waiting(view: View, width: int) -> list[Line]:
    """What to show while no joint is known."""
    return [
        *labelled(" No data", "No joint has been heard of yet.", width),
        *labelled(" To do", view.awaiting, width, "strong"),
        *(row for note in view.notes for row in labelled(" Note", note, width)),
    ]


def detail(joint: Joint, view: View, width: int) -> list[Line]:
    """All answers about a joint, in the order in which they are asked, then what they rest on."""
    state = answers.state(joint, view)
    role = _ROLES.get(state, "")
    about = " · ".join(filter(None, [joint.reducer.hardware_id if joint.reducer else "", joint.key.node]))
    left = f" {joint.key.joint}: {state}, {answers.part(joint)} "
    rows = [line(Span(left, f"{role} strong heading".strip()), Span(f"{about} ".rjust(width - len(left)), "heading"))]
    rows += labelled(" How bad", answers.how_bad(joint), width)
    rows += labelled(" How sure", answers.how_sure(joint), width)
    rows += labelled(" To do", answers.to_do(joint, view), width, "strong")
    rows += labelled(" Since", answers.since(joint, view), width)
    for _, group in groupby(joint.readings, key=lambda reading: reading.quantity):
        rows += [line(" ", *row) for row in drawing.bars(tuple(group), width - 2)]
    for place, sentence in enumerate(answers.missing(joint, view) or ["nothing"]):
        rows += labelled(" Missing" if not place else "", sentence, width)
    rows += _history(joint, width)
    if joint.reducer:
        rows += labelled(" Why", joint.values.get("reason", joint.reducer.message), width)
        rows += labelled(" Now", _present(joint), width)
        if (other := joint.values.get("something else", "none")) != "none":
            rows += labelled(" Besides", other, width)
    if joint.input:
        rows += labelled(" Input", _input(joint.input), width)
    return rows


def _history(joint: Joint, width: int) -> list[Line]:
    """How the joint fared since the view opened."""
    if not joint.trail.steps:
        return []
    lasted = answers.duration(seconds_between(joint.trail.steps[0].stamp, joint.stamp))
    caption = f"{lasted}: largest reading over its error limit; {drawing.LEGEND}"
    labels = chain([" History  "], repeat(" " * 10))
    drawn = drawing.history(joint.trail, max(width - 12, 10))
    return [
        *(line(Span(label, "quiet"), *row) for label, row in zip(labels, drawn, strict=False)),
        *labelled("", caption, width, "quiet"),
    ]


def _present(joint: Joint) -> str:
    """What the joint does now."""
    values = joint.values
    pieces = [
        f"{label} {value:.{digits}f}{unit}"
        for label, key, digits, unit in (
            ("speed", "speed (rpm)", 0, " rpm"),
            ("rms", "rms (m/s^2)", 2, " m/s²"),
            ("rms growth", "rms growth (%)", 0, " %"),
            ("travel", "travel (deg)", 0, "°"),
            ("signal to noise", "signal to noise (dB)", 0, " dB"),
            ("misfit", "misfit", 2, ""),
        )
        if (value := number(values, key)) == value
    ]
    return ", ".join([*pieces, f"torque from {values.get('torque source', 'unknown')}"])


def _input(status: ReceivedStatus) -> str:
    """What came in, with the counters that are not zero."""
    words = {"joint", "fault_code", "reason", "last complaint"}
    counts = ", ".join(f"{key} {value}" for key, value in status.values.items() if key not in words and value != "0")
    complaint = status.values.get("last complaint", "none")
    return "; ".join(filter(None, [status.message, counts, "" if complaint == "none" else complaint]))


def curves(joint: Joint, width: int, height: int) -> list[Line]:
    """Spectrum and RMS curve of a joint, as high as fits."""
    each = min(max(height // 2 - 3, _LOWEST), _HIGHEST)
    spectrum, curve, baseline = (joint.curves.get(name) for name in NAMES)
    rows: list[Line] = [_heading("Zoom spectrum of the strongest pair: rad/s² over Hz", width)]
    if spectrum and spectrum.x:
        rows += drawing.chart(spectrum, width - 2, each, "Hz")
        peak = max(spectrum.y)
        at = spectrum.x[spectrum.y.index(peak)]
        caption = f"{peak:.3g} at {at:.4g} Hz; of the pair the left line is the circular spline's"
        rows += labelled("", caption, width, "quiet")
    else:
        rows.append(line(Span("          none yet: it comes while the joint turns steadily", "quiet")))
    rows += [line(), _heading("RMS by the wave generator's speed: m/s² over rpm", width)]
    if curve and curve.x:
        rows += drawing.chart(curve, width - 2, each, "rpm", baseline)
        rows += labelled("", "o: the baseline", width, "quiet") if baseline else []
    else:
        rows.append(line(Span("          none yet: it comes with the first motion", "quiet")))
    return rows


def _heading(text: str, width: int) -> Line:
    return line(Span(f" {text}".ljust(width), "strong heading"))
