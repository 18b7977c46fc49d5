"""The programs where the modules and calls of POSIX are missing, as on Windows: nothing may need them.

A process of its own hides them, after the standard library and other packages were loaded with them, and then
imports ours. It renders, edits, saves and reads each kind of file, and serves a display over TCP.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

HIDE = """
import importlib, os, select, signal, socket, sys, types
for name in ("asyncio", "ctypes", "multiprocessing", "numpy", "PIL.Image", "click", "selectors", "shutil",
             "sqlite3", "subprocess", "tempfile", "threading", "click.shell_completion", "webbrowser",
             "platformdirs"):
    importlib.import_module(name)
for name in ("fcntl", "grp", "pty", "pwd", "resource", "termios", "tty"):
    sys.modules[name] = None
calls = types.ModuleType("msvcrt")
calls.LK_NBLCK, calls.locking = 2, lambda descriptor, mode, count: None
sys.modules["msvcrt"] = calls
for module, names in {
    os: ("fork", "posix_fallocate", "fchmod", "mkfifo", "openpty", "pidfd_open", "set_blocking", "getuid",
         "geteuid", "O_NONBLOCK", "O_NOFOLLOW", "O_DIRECTORY", "killpg", "setsid", "register_at_fork"),
    select: ("epoll", "poll"),
    signal: ("SIGHUP", "SIGPIPE", "SIGKILL", "SIGQUIT", "SIGXCPU", "pthread_sigmask", "set_wakeup_fd",
             "pidfd_send_signal", "setitimer", "SIGALRM", "SIGUSR1", "SIGTSTP"),
    socket: ("AF_UNIX", "SOCK_SEQPACKET", "recv_fds", "send_fds"),
}.items():
    for name in names:
        vars(module).pop(name, None)
sys.platform = "win32"
"""

USE = """
from pathlib import Path
from threading import Event, Thread
import numpy as np
import autocolor
from autocolor.commands.autocolor import autocolor as command
from ramtek_emu.host.port import TcpPort
from ramtek_emu.host.server import TcpServer
from ramtek_emu import Ramtek9300

folder = Path(sys.argv[2])
scene = autocolor.read_scene(sys.argv[1])
display = Ramtek9300()
studio = autocolor.Studio(scene, display)
studio.recolor("body", object_color="#1f3f8f")
studio.save_scene(folder / "scene")
studio.save_scene(folder / "scene.sqlite")
studio.save_session(folder)
autocolor.write_picture(folder / "picture.npz", studio.scene, studio.picture)
autocolor.save_image(folder / "image.png", studio.scene, studio.picture)
for path in (folder / "scene", folder / "scene.sqlite", folder / "picture.npz"):
    other = Ramtek9300()
    autocolor.Studio(scene, other).open(path)
    assert np.array_equal(other.field(), display.field()), path

served, ended = Ramtek9300(), Event()
with TcpServer(served) as server:
    def serve():
        while not ended.is_set():
            server.step(0.05)
    thread = Thread(target=serve)
    thread.start()
    try:
        with TcpPort(server.address) as port:
            autocolor.Studio(studio.scene, port)
    finally:
        ended.set()
        thread.join()
assert np.array_equal(served.field(), display.field())

def ends_with_0(*words):
    try:
        run_command(command, "autocolor")
    except SystemExit as leaving:
        assert not leaving.code, (words, leaving.code)

from ramtek_emu.command_line import run_command
for words in (
    ["render", sys.argv[1], "-o", str(folder / "a.png"), "--save", str(folder / "a.npz")],
    ["recolor", str(folder / "a.npz"), "--set", "surfaces.body.blend=0.5", "-o", str(folder / "b.png")],
    ["info", str(folder / "scene")],
    ["convert", str(folder / "scene.sqlite"), str(folder / "tables")],
    ["view", "--sessions"],
):
    sys.argv = ["autocolor", *words]
    ends_with_0(*words)
print("done")
"""


@pytest.mark.thorough
def test_nothing_that_linux_alone_has_is_needed(tmp_path: Path) -> None:
    state = tmp_path / "state"
    ran = subprocess.run(
        [sys.executable, "-c", HIDE + USE, str(ROOT / "benchmarks" / "coupe"), str(tmp_path)],
        check=False,
        cwd=ROOT,
        env={"XDG_STATE_HOME": str(state), "PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert ran.stdout.rstrip().endswith("done"), ran.stderr
    assert not ran.returncode
