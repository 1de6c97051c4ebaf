"""colcon's build of this package; pip builds from pyproject.toml at the root of the repository."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

NAME = "hd_monitor"
manifest = ElementTree.parse("package.xml").getroot()

setup(
    name=NAME,
    version=manifest.findtext("version"),
    description=manifest.findtext("description"),
    license=manifest.findtext("license"),
    maintainer=manifest.findtext("maintainer"),
    maintainer_email=manifest.find("maintainer").get("email"),
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={"": ["py.typed", "**/*.j2", "**/*.html", "**/*.css", "**/*.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", sorted(str(path) for path in Path("launch").glob("*.launch.py"))),
        # config is a link to the root's: setuptools and colcon reach only what lies below this folder.
        (
            f"share/{NAME}/config",
            sorted(str(path) for path in Path("config").glob("*.*")),
        ),
    ],
    install_requires=["numpy>=1.26", "scipy>=1.11"],
    extras_require={
        "offline": ["mcap>=1.0", "lz4>=3.1", "zstandard>=0.19", "matplotlib>=3.6", "jinja2>=3.1", "pyyaml>=6.0"],
        "watch": ["textual>=1.0", "rich>=13"],
        "complete": ["argcomplete>=3.1"],
        "test": ["pytest"],
    },
    entry_points={
        "console_scripts": [
            "hd-monitor = hd_monitor.cli.main:main",
            "hd_monitor_node = hd_monitor.ros.__main__:main",
        ],
    },
)
