"""A harmonic-drive test rig on ROS 2 topics: speed programmes, defects and a virtual sensor."""
