import os
from typing import Any

import pytest

pytestmark = pytest.mark.ros


def test_free_domains_are_free(peer: Any) -> None:
    from hd_sim_node.demo.plan import free_domain

    mine = int(os.environ["ROS_DOMAIN_ID"])
    domains = {free_domain() for _ in range(50)}
    assert mine not in domains
    assert domains <= set(range(1, 102))
