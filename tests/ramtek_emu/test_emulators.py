"""Programs that are not in Python: a client in C, and a simulated PDP-11."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from docs.generate.blocks import blocks_of
from docs.guides.pictures import GUIDES, path_of
from docs.guides.pictures_of_displays import emulators_lines, simulated
from tests.ramtek_emu.processes import ROOT, field_of
from tests.ramtek_emu.serving import serving_at, until

CLIENT = ROOT / "examples" / "ramtek_client.c"
DEVICE = ROOT / "examples" / "ramtek_device.c"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no Unix sockets of packets")
@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc compiles the client")
def test_a_client_in_c_draws_and_reads_back(tmp_path: Path) -> None:
    program = tmp_path / "client"
    subprocess.run(["gcc", "-Wall", "-Wextra", "-Werror", "-o", program, CLIENT], check=True, timeout=60)
    with serving_at(tmp_path / "display") as server:
        done = subprocess.run(
            [program, server.address], stdout=subprocess.PIPE, text=True, check=True, timeout=60
        )
        until(lambda: server.served == 1)
        assert server.display.words.any()
    assert done.stdout == "the pixel is 5\n"


OLD_PROGRAM = """
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int main(int count, char **names)
{
    /* A text instruction of 21 bytes, RSCP, FILL of the screen, and RI of 32767 words. */
    static const char text[] = "\\x03\\x0c\\x40\\0\\0\\0\\0\\0\\x40\\x01\\x09\\0\\6\\0VENE21";
    static const char ask[] = "\\0\\x17", erase[] = "\\x12\\x09\\2\\0\\x55\\1";
    static const char image[] = "\\1\\x0b\\xfe\\xff";
    static unsigned char reply[65535];
    char line[4];
    int device = count > 1 ? open(names[1], count) : creat("/dev/ramtek", 0), copy = dup(device), ends[2];

    printf("%zd ", write(device, text, 21));
    printf("%zd ", write(copy, ask, 2));
    printf("%zd ", read(device, reply, 2));
    printf("%zd ", read(copy, reply, count + 1));
    close(device);
    write(copy, erase, 6);
    write(copy, image, 4);
    printf("%zd ", read(copy, reply, 65535));
    printf("%x\\n", reply[65532] | reply[65533] << 8);
    /* All other files are as without the library. */
    if (open("/dev/no ramtek", O_RDONLY) >= 0 || pipe(ends) || write(ends[1], "abc", 3) != 3)
        return 1;
    return read(ends[0], line, 4) != 3;
}
"""
PYTHON = """
import os
device = os.open("/dev/ramtek", os.O_RDWR)
os.write(device, bytes.fromhex("0209 4400 0700 0900 0800 0900 0800 21"))
os.write(os.dup(device), bytes.fromhex("030b 4000 0900 0800 0900 0800 0200"))
print(os.read(device, 2).hex())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems load libraries otherwise")
@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc compiles the library")
def test_a_library_gives_programs_their_device_with_the_writes_and_reads_of_the_drivers(
    tmp_path: Path,
) -> None:
    library = tmp_path / "device.so"
    (tmp_path / "program.c").write_text(OLD_PROGRAM)
    strict = ["gcc", "-Wall", "-Wextra", "-Werror", "-Wno-unused-result"]
    subprocess.run([*strict, "-shared", "-fPIC", "-o", library, DEVICE, "-ldl"], check=True, timeout=60)
    # A fortified program calls other functions.
    fortified = ["-O2", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2"]
    for name, options in (("program", ()), ("fortified", fortified)):
        source = tmp_path / "program.c"
        subprocess.run([*strict, *options, "-o", tmp_path / name, source], check=True, timeout=60)
    with serving_at(tmp_path / "display") as server:
        variables = {
            **os.environ,
            "LD_PRELOAD": str(library),
            "RAMTEK_DEVICE": "/dev/ramtek",
            "RAMTEK_SOCKET": server.address,
        }
        printed = [
            subprocess.run(
                command, env=variables, stdout=subprocess.PIPE, text=True, check=True, timeout=60
            ).stdout
            for command in (
                [str(tmp_path / "program")],
                [str(tmp_path / "fortified"), "/dev/ramtek"],
                [sys.executable, "-c", PYTHON],
            )
        ]
        until(lambda: server.served == 3)
        assert server.display.processor.illegal_words == 0
    assert printed == [*["21 2 2 2 65534 155\n"] * 2, "0700\n"]


@pytest.mark.skipif(shutil.which("pdp11") is None, reason="SIMH simulates the PDP-11")
def test_a_simulated_pdp11_draws_and_reads_back(tmp_path: Path) -> None:
    printed = simulated(tmp_path)
    (shown,) = (
        block.text
        for block in blocks_of((GUIDES / "emulators.md").read_text("utf-8"))
        if block.text.startswith("HALT")
    )
    assert printed.replace("\r", "").endswith(shown)
    with Image.open(path_of(emulators_lines)) as picture:
        assert (field_of(tmp_path / "lines.png") == np.asarray(picture.convert("RGB"))).all()
