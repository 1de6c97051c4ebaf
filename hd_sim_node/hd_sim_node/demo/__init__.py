"""``hd-monitor demo``: the simulated rig and the monitor as two real nodes, and what the monitor says about the rig."""
