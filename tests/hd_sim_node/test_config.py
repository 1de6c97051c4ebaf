"""The parameter files that come with the project make the rigs that they promise."""

from pathlib import Path

import pytest

from hd_sim_node.drive.stability import unstable_speeds
from hd_sim_node.motion.programmes import PROGRAMMES
from hd_sim_node.parameters import NODE_PARAMETERS
from hd_sim_node.settings import RigSettings, pick

CONFIG = Path(__file__).resolve().parents[2] / "config"
FILES = sorted(CONFIG.glob("rig*.yaml"))


def load(file):
    yaml = pytest.importorskip("yaml", reason="reading parameter files needs the extra 'offline'")
    (node,) = yaml.safe_load(file.read_text(encoding="utf-8")).items()
    assert node[0] == "/**/hd_sim_node"
    return RigSettings.from_mapping(pick(node[1]["ros__parameters"], NODE_PARAMETERS))


def test_rig_files_are_found():
    assert len(FILES) >= 2


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.name)
def test_each_is_a_rig_that_runs(file):
    settings = load(file)
    assert settings.general.programme in PROGRAMMES
    assert settings.remarks == []
    assert unstable_speeds(settings.model, settings.programme) == []


def test_the_plain_one_states_the_defaults():
    """It is the place where users look the defaults up."""
    assert load(CONFIG / "rig.yaml") == RigSettings.from_mapping()
