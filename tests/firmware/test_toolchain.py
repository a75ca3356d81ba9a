"""A compiler without its library skips the tests that need it."""

from pathlib import Path

import pytest

from programs import program


@pytest.mark.parametrize("compiler", ["g++", "arm-none-eabi-g++", "xtensa-lx106-elf-g++"])
def test_a_compiler_without_its_library_skips(
    compiler: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = tmp_path / compiler
    alone.write_text("#!/bin/sh\necho 'fatal error: no such header' >&2\nexit 1\n")
    alone.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(pytest.skip.Exception, match=r"is missing: install Debian's \S"):
        program(compiler)


def test_an_absent_program_skips(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(pytest.skip.Exception, match="kicad-cli is missing: install Debian's kicad"):
        program("kicad-cli")
