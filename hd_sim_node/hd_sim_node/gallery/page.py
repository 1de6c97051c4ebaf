"""The page ``msgs_doc/rig.md``: what each effect does, and the drives with the source of every number."""

from collections.abc import Mapping, Sequence

from hd_monitor.parameter import Value

from ..drive.catalogue import DRIVES, SOURCES, Sourced
from ..parameters import PARAMETERS
from .effects import EFFECTS, LENGTH, SPEED, Effect
from .equation import EQUATION
from .sensors import SENSORS

PICTURES = {"images/rig.png": EFFECTS, "images/sensors.png": SENSORS}
"""The pictures beside the page and what they show."""

_DRIVE, _SENSOR = PICTURES


def page() -> str:
    """Write the page; everything in it comes from the tables, nothing is simulated."""
    return f"""\
# The simulated rig as a real drive

<!-- Made by `hd-monitor gallery --out msgs_doc`; a test holds this page to the code. -->

By default `hd_sim_node` and `hd-sim-bag` simulate the drive of Gu et al. (2021): a linear oscillator whose stiffness
both splines make fluctuate. The parameters `*.transmission_error`, `elasticity.*`, `hysteresis.*`, `friction.*`,
`torque.*`, `inertia.*`, `drift.*` and `growth.*` ([parameters](parameters.md)) add what a real drive does besides, each
neutral by default; `sensor.*` and `joint_states.*` say how it is measured.

{EQUATION}
## What each effect does to the zoom spectrum

![Zoom spectra of a simulated drive with one effect each, the drive without it in grey behind]({_DRIVE})

The paper's drive (55 Hz) with a bad flexspline at {SPEED:g} rpm, {LENGTH:g} s, Hann window, around the pair k = 1; grey
without the effect, black with it, all on one logarithmic scale. Drawn by `hd-monitor gallery --out msgs_doc`.

| | effect | set | look for |
|---|---|---|---|
{_rows_of(EFFECTS)}

## What each fault of the sensor does to it

![Zoom spectra of the same drive with one fault of the sensor each, the sound sensor in grey behind]({_SENSOR})

The same drive, measured by parameters `sensor.*`.

| | fault | set | look for |
|---|---|---|---|
{_rows_of(SENSORS)}

## Drives to choose by name

    hd-sim-bag --drive catalogue --programme strokes --duration 120 --out strokes
    ros2 launch hd_sim_node rig.launch.py drive:=worn

`drive` fills in the parameters that you do not give; whatever you give wins, also a `defect`. (A file with every
default, as `hd-monitor parameters --format yaml` prints it, gives all, so that `drive` changes nothing there.) `paper`
is the default; `catalogue` is a new unit of size 20 and ratio 80; `worn` is the same at the end of its life. Give the
monitor the drive's `dynamics.*`.

How the catalogue's numbers become parameters:

- **Stiffness.** The rig's stiffness is J (2π fn)². An inertia as on a robot's elbow is assumed, and fn follows from K2,
  so that K2 has the ratio 1 and `elasticity.ratios` are K1/K2, 1, K3/K2. Half the rated torque lies between T1 and T2.
- **Hysteresis loss** is the width of the loop in twist at zero torque: 2 `hysteresis.torque` / K1.
- **Positional accuracy** is peak to peak over a whole revolution, of all causes. It is shared among the lines so that
  their sizes add up to it: where all peaks meet, the error is the catalogue's.
- **Friction.** Catalogues state it at the input; times the ratio it is the output's. A third of it is assumed to act on
  the output, as the rig's friction does; the rest stays at the wave generator and does not wind up the flexspline.

| parameter | {" | ".join(f"`{drive}`" for drive in _presets())} | unit | source |
|---|{"---|" * len(_presets())}---|---|
{chr(10).join(_rows(_presets()))}

The documents:

{chr(10).join(f"- **{name}**: {document}." for name, document in SOURCES.items())}

"Typical" and "assumed" mean what they say: a plausible number for which no document was at hand.
"""


def _presets() -> Mapping[str, Mapping[str, Sourced]]:
    return {drive: entries for drive, entries in DRIVES.items() if entries}


def _rows_of(effects: Sequence[Effect]) -> str:
    return "\n".join(_effect(number, effect) for number, effect in enumerate(effects, start=1))


def _effect(number: int, effect: Effect) -> str:
    lines = [f"`{name}: {_text(value)}`" for name, value in effect.settings.items()]
    lines += [f"both: `{name}: {_text(value)}`" for name, value in effect.ground.items()]
    return f"| {number} | {effect.name} | {effect.shown or '<br>'.join(lines)} | {effect.look_for} |"


def _rows(presets: Mapping[str, Mapping[str, Sourced]]) -> list[str]:
    units = {parameter.name: parameter.unit for parameter in PARAMETERS}
    new, worn = presets.values()
    lines = []
    for name in new:
        values = " | ".join(_text(entries[name].value) for entries in presets.values())
        source = new[name].source if new[name] == worn[name] else f"{new[name].source}<br>worn: {worn[name].source}"
        lines.append(f"| `{name}` | {values} | {units[name] or '–'} | {source} |")
    return lines


def _text(value: Value) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(f'{number:g}' for number in value)}]"
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
