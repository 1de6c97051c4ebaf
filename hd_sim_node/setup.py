"""colcon's build of this package; pip builds from pyproject.toml at the root of the repository."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

NAME = "hd_sim_node"
manifest = ElementTree.parse("package.xml").getroot()

setup(
    name=NAME,
    version=manifest.findtext("version"),
    description=manifest.findtext("description"),
    license=manifest.findtext("license"),
    maintainer=manifest.findtext("maintainer"),
    maintainer_email=manifest.find("maintainer").get("email"),
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={"": ["py.typed", "**/*.j2", "**/*.html", "**/*.css"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", sorted(str(path) for path in Path("launch").glob("*.launch.py"))),
    ],
    install_requires=["hd_monitor", "numpy>=1.26", "scipy>=1.11"],
    extras_require={"offline": ["rosbags>=0.10.11", "pyyaml>=6.0"], "test": ["pytest"]},
    entry_points={
        "console_scripts": [
            "hd_sim_node = hd_sim_node.__main__:main",
            "hd-sim-bag = hd_sim_node.bag_command:main",
        ],
        "hd_monitor.commands": [
            "demo = hd_sim_node.demo.command",
            "gallery = hd_sim_node.gallery.command",
        ],
        "hd_monitor.parameters": ["hd_sim_node = hd_sim_node.parameters:ALL_PARAMETERS"],
    },
)
