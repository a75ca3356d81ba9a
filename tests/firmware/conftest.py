"""Sketch folders of designs, and programs compiled from them."""

import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.firmware.files import firmware_files
from programs import program

HERE = Path(__file__).parent
STRICT = ("-std=c++14", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror")
SANITIZED = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
CORTEX_M4 = ("-mcpu=cortex-m4", "-mthumb", "-O2", "-fno-exceptions", "-specs=rdimon.specs")
QEMU = (
    "-M",
    "mps2-an386",
    "-nographic",
    "-monitor",
    "none",
    "-serial",
    "none",
    "-semihosting-config",
    "enable=on,target=native",
    "-kernel",
)

Runner = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def run() -> Runner:
    """`run("g++", …, input=…)`: a command that ends within a minute; skipped without the tool."""

    def command(
        name: str, *arguments: str | Path, input: str | None = None
    ) -> subprocess.CompletedProcess[str]:
        told = [program(name), *map(str, arguments)]
        return subprocess.run(
            told, capture_output=True, text=True, timeout=60, check=False, input=input
        )

    return command


@pytest.fixture(scope="session")
def sketch(tmp_path_factory: pytest.TempPathFactory, design_dir: Path) -> Callable[[str], Path]:
    """`sketch("dense")`: the sketch folder of a preset, beside its `layout.json`. Do not change
    it."""
    folders: dict[str, Path] = {}

    def get(preset: str) -> Path:
        if preset not in folders:
            design = derive(load(design_dir / "presets" / f"{preset}.toml"))
            out = tmp_path_factory.mktemp(preset)
            (out / "firmware").mkdir()
            made = firmware_files(design)
            for artefact in made:
                (out / artefact.path).write_bytes(artefact.data)
            (out / "layout.json").write_text(design.layout.to_json(), encoding="utf-8")
            folders[preset] = out / "firmware"
        return folders[preset]

    return get


@pytest.fixture(scope="session")
def host_program(
    tmp_path_factory: pytest.TempPathFactory, sketch: Callable[[str], Path], run: Runner
) -> Callable[..., Path]:
    """`host_program("scenario", "dense", "-DLUMITIP_BITS=10")`: a program for this computer, every
    warning an error, with address and undefined-behaviour sanitizers."""

    @cache
    def build(name: str, preset: str, *defines: str) -> Path:
        program = tmp_path_factory.mktemp("host") / name
        done = run(
            "g++",
            *STRICT,
            *SANITIZED,
            *defines,
            "-I",
            sketch(preset),
            HERE / "host" / f"{name}.cpp",
            "-o",
            program,
        )
        assert done.returncode == 0, done.stderr
        return program

    return build


@pytest.fixture(scope="session")
def arm_output(
    tmp_path_factory: pytest.TempPathFactory, sketch: Callable[[str], Path], run: Runner
) -> Callable[..., str]:
    """`arm_output("scenario", "dense")`: what the program prints on an emulated Cortex-M4."""

    def build(name: str, preset: str, *defines: str) -> str:
        program = tmp_path_factory.mktemp("arm") / f"{name}.elf"
        sources = (HERE / "arm" / "vectors.cpp", HERE / "host" / f"{name}.cpp")
        done = run(
            "arm-none-eabi-g++",
            *STRICT[:3],
            "-Werror",
            *CORTEX_M4,
            *defines,
            "-I",
            sketch(preset),
            "-T",
            HERE / "arm" / "mps2.ld",
            *sources,
            "-o",
            program,
        )
        assert done.returncode == 0, done.stderr
        done = run("qemu-system-arm", *QEMU, program)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return build
