"""The attacks `uses`: screens, servers and a window are used at random.

All screens are used by the unit and by keys, in this process. Then the page must be the same page drawn
whole, the picture must be that of a fresh studio, and the session must be recovered from its journal. Hosts
come to `ramtek serve`, over TCP and at a Unix socket; they draw, break off and stay silent. The window of
`autocolor view` on a virtual screen gets keys, clicks and drags, and its file is edited from outside. The
servers and the window must go on, write no error, end in order after SIGTERM, and not grow.
"""

from __future__ import annotations

import contextlib
import os
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from autocolor import Studio, read_journal, write_scene
from autocolor.journal.autosave import Autosave
from autocolor.journal.places import checksum_of
from autocolor.screens.session import PICTURE
from autocolor.widgets.sheet import Sheet
from ramtek_emu import Ramtek9300, TcpPort, UnixPort, instructions
from ramtek_emu.errors import RamtekError
from ramtek_emu.host.port import break_off
from tests.attack_targets import stream_samples
from tests.attacks import ROOT, Trial
from tests.autocolor.random_hand import RandomHandWithKeys
from tests.autocolor.test_random_sessions import SCENES, begun
from tests.mutations import damaged
from tests.small import car, held
from tests.virtual_screen import virtual_screen

GESTURES: Final = 300
KEYS: Final = (
    *(f"F{number}" for number in range(1, 13) if number != 11), *"abcdefghijklmnopqrstuvwxyz0123456789",
    "Left", "Right", "Up", "Down", "plus", "minus", "Tab", "Return", "space", "Delete", "BackSpace", "Home",
    "End", "Page_Up", "Page_Down", "comma", "period", "shift+Left", "ctrl+s", "ctrl+r", "ctrl+z", "ctrl+y",
)  # fmt: skip
"""Keys that do not close the window."""


class Screens(Trial):
    """All screens, with a scene."""

    def __init__(self, name: str) -> None:
        self.name = name

    def attempt(self, chance: random.Random) -> str:
        display, autosave = Ramtek9300(), Autosave()
        viewer = begun(self.name, Path.cwd(), display)
        hand = RandomHandWithKeys(viewer, display, chance.randrange(1 << 30))
        for number in range(GESTURES):
            hand.do()
            if number % 20 == 0:
                autosave.update(viewer.studio.history, at_once=True)
        # A picture that comes in line by line is shown whole.
        viewer.on_key("escape")
        whole, fresh = Ramtek9300(), Ramtek9300()
        Sheet(whole).show(viewer.board.page())
        if held(display) != held(whole):
            return f"a page differs from the same page drawn whole: {viewer.page}"
        hand.let_go()
        viewer.clear()
        if viewer.page != PICTURE:
            return f"clearing leads to a screen: {viewer.page}"
        history = viewer.studio.history
        Studio(history.scene, fresh)
        if held(display) != held(fresh):
            return "the picture differs from that of a fresh studio"
        autosave.update(history, at_once=True)
        for journal in Path(os.environ["XDG_STATE_HOME"]).rglob("session.jsonl"):
            if checksum_of(read_journal(journal).history.scene) != checksum_of(history.scene):
                return "another scene is recovered"
        autosave.end()
        return ""


class Program(Trial):
    """A command in a process of its own, which goes on from attempt to attempt."""

    arguments: tuple[str, ...]
    may_end = False
    """Whether users can end it."""

    @property
    def watched(self) -> int:
        return self.process.pid

    @contextlib.contextmanager
    def begun(self, folder: Path) -> Iterator[None]:
        self.folder, self.errors = folder, folder / "errors"
        self.variables = {
            "XDG_STATE_HOME": str(folder / "state"), "PYTHONPATH": str(ROOT), **self.prepared(folder)
        }  # fmt: skip
        self.start()
        yield
        with self.process:
            self.process.terminate()
            if (code := self.process.wait(30)) not in (0, -signal.SIGTERM, 128 + signal.SIGTERM):
                raise RuntimeError(f"it ended with {code} after SIGTERM: {self.errors.read_text()}")

    def start(self) -> None:
        """Start the command, and wait until it can be used."""
        with open(self.errors, "wb") as errors:
            self.process = subprocess.Popen(
                [sys.executable, "-m", *self.arguments],
                cwd=self.folder,
                env={**os.environ, **self.variables},
                stdout=subprocess.PIPE,
                stderr=errors,
            )
        self.ready(self.folder)

    def prepared(self, folder: Path) -> dict[str, str]:
        """Make what the command needs; returns variables of its environment."""
        return {}

    def ready(self, folder: Path) -> None:
        """Wait until the command can be used."""

    def act(self, chance: random.Random) -> str:
        """Use the command; returns the story of a fault, if any."""
        raise NotImplementedError

    def attempt(self, chance: random.Random) -> str:
        if self.may_end and self.process.poll() == 0:
            self.process.communicate()
            self.start()
        story = self.act(chance)
        text = self.errors.read_text(errors="replace")
        if self.process.poll() not in ((None, 0) if self.may_end else (None,)):
            # The process that makes attempts ends, too. Both are started again.
            raise SystemExit(f"it ended with {self.process.poll()}: {text[-2000:]}")
        return f"errors on stderr: {text[-3000:]}" if re.search(r"Traceback|Error\b|Fatal", text) else story


class Server(Program):
    """A display, to which hosts come one after the other, and now and then several at once."""

    def __init__(self, is_unix: bool) -> None:
        self.arguments = (
            "ramtek_emu",
            "serve",
            "--idle",
            "2",
            *(("--unix", "d") if is_unix else ("--port", "0")),
        )

    def ready(self, folder: Path) -> None:
        assert self.process.stdout is not None
        address = self.process.stdout.readline().decode().strip()
        self.open: Callable[[], TcpPort | UnixPort] = (
            partial(TcpPort, f"tcp://127.0.0.1:{address.rpartition(':')[2]}", timeout=60)
            if address.startswith("tcp:")
            else partial(UnixPort, folder / address, timeout=60)
        )

    def act(self, chance: random.Random) -> str:
        seeds = [random.Random(chance.random()) for _ in range(8 if chance.random() < 0.05 else 1)]
        hosts = [threading.Thread(target=self.visit, args=(seed,)) for seed in seeds]
        for host in hosts:
            host.start()
        for host in hosts:
            host.join()
        try:
            with self.open() as port:
                port.send(instructions.write_image(np.full((4, 4), 200)))
                port.send(instructions.read_entries(0, 2))
                port.receive(2)
        except RamtekError as error:
            return f"a host is not served: {error}"
        return ""

    def visit(self, chance: random.Random) -> None:
        """A host that draws or misbehaves, and leaves."""
        act, samples = chance.random(), stream_samples()
        with contextlib.suppress(RamtekError, OSError), self.open().socket as wire:
            wire.setblocking(True)
            wire.settimeout(5)
            for _ in range(chance.randint(0, 4)):
                wire.send(damaged(chance.choice(samples)[1:], chance, samples))
                if chance.random() < 0.3:
                    wire.recv(chance.randint(1, 100000))
            if act < 0.2:
                break_off(wire)
            elif act < 0.3:
                time.sleep(chance.random() * 3)
            elif act < 0.6:
                wire.shutdown(socket.SHUT_WR)
                while wire.recv(1 << 16):
                    pass


class Window(Program):
    """The window on a virtual screen."""

    arguments = ("autocolor", "view", "car")
    may_end = True

    @contextlib.contextmanager
    def begun(self, folder: Path) -> Iterator[None]:
        with virtual_screen(folder, "1400x1100") as self.screen, super().begun(folder):
            yield

    def prepared(self, folder: Path) -> dict[str, str]:
        write_scene(folder / "car", car())
        self.scene = folder / "car" / "scene.toml"
        return {"DISPLAY": self.screen.name}

    def ready(self, folder: Path) -> None:
        while not self.tool("search", "--class", "."):
            time.sleep(0.1)

    def tool(self, *arguments: object) -> bytes:
        variables = {**os.environ, **self.variables}
        command = ["xdotool", *map(str, arguments)]
        return subprocess.run(command, env=variables, capture_output=True, check=False, timeout=60).stdout

    def act(self, chance: random.Random) -> str:
        places = [(chance.randrange(1390), chance.randrange(1090)) for _ in range(chance.randint(1, 4))]
        moves = [word for place in places for word in ("mousemove", *place)]
        act = chance.random()
        if act < 0.5:
            self.tool("key", *chance.choices(KEYS, k=chance.randint(1, 4)))
        elif act < 0.75:
            self.tool(*moves, "click", chance.choice((1, 1, 1, 1, 3, 4, 5)))
        elif act < 0.95:
            self.tool(*moves[:3], "mousedown", 1, *moves, "mouseup", 1)
        else:
            # Another program edits the file, which is wrong for a moment.
            text = self.scene.read_text()
            self.scene.write_text(text[: len(text) // 2] + "[[")
            time.sleep(chance.random())
            number = f"intensity = {chance.uniform(0, 2):.3f}"
            self.scene.write_text(re.sub(r"(?m)^intensity = .*$", number, text, count=1))
        time.sleep(chance.random() / 5)
        return ""


def trials() -> dict[str, Callable[[], Trial]]:
    """The attacks by their names."""
    screens = {f"screens, {name}": partial(Screens, name) for name in SCENES}
    return {**screens, "tcp": partial(Server, False), "unix": partial(Server, True), "window": Window}
