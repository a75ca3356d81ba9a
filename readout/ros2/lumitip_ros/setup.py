"""Build with colcon; Lumitip itself is installed with pip, see README.md."""

from pathlib import Path

from setuptools import setup

PACKAGE = "lumitip_ros"


def _files(folder: str) -> list[str]:
    return sorted(str(path) for path in Path(folder).glob("*.*"))


setup(
    name=PACKAGE,
    version="0.2.0",
    packages=[PACKAGE],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/launch", _files("launch")),
        (f"share/{PACKAGE}/config", _files("config")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Lumitip contributors",
    description="Lifecycle node that publishes an optical fingertip of Lumitip.",
    license="Apache-2.0",
    entry_points={"console_scripts": [f"fingertip = {PACKAGE}.node:main"]},
)
