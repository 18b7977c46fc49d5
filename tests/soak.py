"""Use the window, the servers and the studio at random for hours, and tell what they hold on to.

    nice python -m tests.soak --hours 1 --seed 7

Four processes are used. The window of `autocolor view` on a virtual screen gets keys, clicks, drags and the
wheel, and its files are edited from outside. Hosts come to `ramtek serve`, over TCP and at a Unix socket;
they draw, break off and stay silent. A studio edits, renders, saves and opens again. Every minute a line for
each process tells its memory, descriptors, threads, children and temporary files, and the numbers of events
and faults. A process that ends, an error on stderr and a display that does not answer are faults. At the end,
the slope of the memory after the first tenth of the time is told. The exit code is 1 for a fault or a leak.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from autocolor import AutocolorError, Studio, read_scene, write_scene
from autocolor.journal.autosave import Autosave
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from ramtek_emu import Ramtek9300, TcpPort, UnixPort, instructions
from ramtek_emu.errors import RamtekError

ROOT = Path(__file__).parents[1]

FREE_GROWTH = 16.0
GROWTH_OF_AN_EVENT = 0.006
"""Megabytes by which the memory of a process may grow in the last half of the time, and for each event beside
that: a session keeps all its steps, which can be undone. In the first half, the process fills the memory that
it freed and keeps for the next picture (see `autocolor.rendering`)."""

MORE = 4
"""How many more descriptors, threads, children and temporary files there may be at the end."""

ERRORS = re.compile(rb"Traceback|Error\b|Fatal|Segmentation")


class Sample(NamedTuple):
    """What a process holds on to."""

    seconds: float
    process: int
    megabytes: float
    descriptors: int
    threads: int
    children: int
    temporary_files: int
    events: int


class Subject:
    """A process that is used, with its own state folder and folder for temporary files."""

    def __init__(self, name: str, command: list[str], folder: Path, **environment: str) -> None:
        self.name = name
        self.folder = folder / name
        self.events = 0
        self.ends = 0
        self.faults: list[str] = []
        self.samples: list[Sample] = []
        self._command = command
        for made in ("temporary", "state", "work"):
            (self.folder / made).mkdir(parents=True)
        self._environment = {
            **os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(self.folder / "temporary"),
            "XDG_STATE_HOME": str(self.folder / "state"), "XDG_RUNTIME_DIR": str(self.folder / "state"),
            "OPENBLAS_NUM_THREADS": "1", **environment,
        }  # fmt: skip
        self.start()

    def start(self) -> None:
        """Start the process."""
        self._errors = open(self.folder / "errors", "ab")  # noqa: SIM115
        self._seen = (self.folder / "errors").stat().st_size
        self.process = subprocess.Popen(
            self._command,
            cwd=self.folder / "work",
            env=self._environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._errors,
        )

    def fault(self, story: str) -> None:
        """Note a fault."""
        self.faults.append(story)
        print(f"{self.name}: FAULT: {story}", flush=True)

    def look(self, seconds: float) -> bool:
        """Take a sample, and look for faults. If the process has ended, it is started again: returns True."""
        errors = (self.folder / "errors").read_bytes()[self._seen :]
        if ERRORS.search(errors):
            self._seen += len(errors)
            self.fault(f"errors on stderr: {errors.decode(errors='replace')[-3000:]}")
        code = self.process.poll()
        if code is not None:
            self.ends += 1
            # A click on `leave` in the menu ends the window in order.
            if code or self.name != "window":
                self.fault(f"it ended with {code}: {errors.decode(errors='replace')[-2000:]}")
            self.close_files()
            self.start()
            return True
        own = Path(f"/proc/{self.process.pid}")
        status = dict(line.split(":", 1) for line in (own / "status").read_text().splitlines() if ":" in line)
        tasks = own / "task"
        children = sum(len((task / "children").read_text().split()) for task in tasks.iterdir())
        self.samples.append(
            Sample(
                seconds,
                self.process.pid,
                int(status["VmRSS"].split()[0]) / 1024,
                len(list((own / "fd").iterdir())),
                int(status["Threads"]),
                children,
                sum(1 for _ in (self.folder / "temporary").rglob("*")),
                self.events,
            )
        )
        return False

    def end(self) -> None:
        """End the process with SIGTERM, which it must obey."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                code = self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                code = self.process.wait()
                self.fault("it did not end after SIGTERM")
            if code not in (0, -signal.SIGTERM, 128 + signal.SIGTERM, -signal.SIGKILL):
                self.fault(f"it ended with {code} after SIGTERM")
        self.close_files()
        if names := list((self.folder / "temporary").iterdir()):
            self.fault(f"temporary files were left: {names[:5]}")

    def close_files(self) -> None:
        """Close the pipes of the process."""
        self._errors.close()
        if self.process.stdout is not None:
            self.process.stdout.close()

    def line(self) -> str:
        """The last sample as text."""
        if not self.samples:
            return f"{self.name:<8} no sample"
        last = self.samples[-1]
        return (
            f"{self.name:<8} {last.megabytes:7.1f} MB {last.descriptors:4d} descriptors"
            f" {last.threads:3d} threads {last.children:3d} children"
            f" {last.temporary_files:4d} temporary files {self.events:9,d} events"
            f" {len(self.faults):3d} faults"
        )

    def verdict(self, seconds: float) -> tuple[str, bool]:
        """The slope of the memory after the first tenth of the time, and whether it is a leak."""
        late = [each for each in self.samples if each.seconds >= seconds / 10]
        late = [each for each in late if each.process == late[-1].process] if late else []
        if len(late) < 3:
            return f"{self.name:<8} too few samples for a verdict", False
        first, last = late[0], late[-1]
        half = late[len(late) // 2 :]
        growth = slope_of(half) * (last.seconds - half[0].seconds) / 3600
        leaks = growth > FREE_GROWTH + GROWTH_OF_AN_EVENT * (last.events - half[0].events)
        more = [
            f"{getattr(last, noun) - getattr(first, noun):+d} {noun.replace('_', ' ')}"
            for noun in ("descriptors", "threads", "children", "temporary_files")
            if getattr(last, noun) > getattr(first, noun) + MORE
        ]
        text = (
            f"{self.name:<8} {first.megabytes:7.1f} to {last.megabytes:7.1f} MB in"
            f" {(last.seconds - first.seconds) / 60:.0f} minutes and {last.events - first.events:,} events:"
            f" {slope_of(late):+.1f} MB/h, in the last half {slope_of(half):+.1f} MB/h;"
            f" {len(self.faults)} faults, started again {self.ends} times"
        )
        return "; ".join((text, *["LEAK"] * leaks, *more)), leaks or bool(more)


def slope_of(samples: list[Sample]) -> float:
    """The growth of the memory, in megabytes an hour."""
    if len(samples) < 2:
        return 0.0
    hours = [each.seconds / 3600 for each in samples]
    return float(np.polyfit(hours, [each.megabytes for each in samples], 1)[0])


# The window.

KEYS = (
    *(f"F{number}" for number in range(1, 13) if number != 11),
    *"abcdefghijklmnopqrstuvwxyz0123456789",
    *(
        "Left",
        "Right",
        "Up",
        "Down",
        "plus",
        "minus",
        "bracketleft",
        "bracketright",
        "Tab",
        "Return",
        "space",
    ),
    *(
        "Delete",
        "BackSpace",
        "Home",
        "End",
        "Page_Up",
        "Page_Down",
        "comma",
        "period",
        "shift+Left",
        "ctrl+s",
    ),
    *("ctrl+r", "ctrl+shift+z"),
    *("ctrl+z",) * 4,
    *("ctrl+y",) * 3,
)
"""Keys that do not close the window."""


def written_scenes(folder: Path) -> None:
    """The scenes that the window and the studio open."""
    from tests.autocolor.files.store.stores import small_scene
    from tests.small import car

    write_scene(folder / "car", car())
    write_scene(folder / "small.sqlite", small_scene())
    (folder / "box.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 0 1 1\ng front\nf 1 2 3 4\ng side\nf 1 4 6 5\n"
    )


class WindowHand:
    """Keys and a mouse on the virtual screen of a window."""

    def __init__(self, subject: Subject, display: str, chance: random.Random) -> None:
        self._subject, self._chance = subject, chance
        self._environment = {**os.environ, "DISPLAY": display}

    def tool(self, *arguments: object) -> str:
        command = ["xdotool", *map(str, arguments)]
        ran = subprocess.run(
            command, env=self._environment, capture_output=True, text=True, check=False, timeout=60
        )
        return ran.stdout

    def act(self) -> None:
        """Do something."""
        chance, act = self._chance, self._chance.random()
        self._subject.events += 1
        if act < 0.4:
            self.tool("key", *chance.choices(KEYS, k=chance.randint(1, 4)))
        elif act < 0.65:
            self.tool("mousemove", *self._place(), "click", chance.choice((1, 1, 1, 1, 3)))
        elif act < 0.8:
            places = [self._place() for _ in range(chance.randint(1, 4))]
            moves = [word for place in places for word in ("mousemove", *place)]
            self.tool("mousemove", *self._place(), "mousedown", 1, *moves, "mouseup", 1)
        elif act < 0.88:
            turns = chance.randint(1, 5)
            self.tool("mousemove", *self._place(), "click", "--repeat", turns, chance.choice((4, 5)))
        elif act < 0.92:
            self.tool("key", *["ctrl+z"] * chance.randint(5, 40), *["ctrl+y"] * chance.randint(0, 40))
        elif act < 0.97:
            self._edit_file()
        else:
            size = chance.randint(400, 1380), chance.randint(300, 1080)
            self.tool("search", "--class", ".", "windowsize", *size)
        time.sleep(chance.random() / 5)

    def _place(self) -> tuple[int, int]:
        return self._chance.randrange(1390), self._chance.randrange(1090)

    def _edit_file(self) -> None:
        """Change the scene's file as an editor does; now and then it is wrong, or gone, for a moment."""
        path = self._subject.folder / "work" / "car" / "scene.toml"
        with contextlib.suppress(OSError):
            text = path.read_text()
            number = f"{self._chance.uniform(0, 2):.3f}"
            act = self._chance.random()
            if act < 0.2:
                path.write_text(text[: len(text) // 2] + "[[")
                time.sleep(1)
                path.write_text(text)
            elif act < 0.3:
                path.rename(path.with_suffix(".away"))
                time.sleep(1)
                path.with_suffix(".away").rename(path)
            else:
                path.write_text(re.sub(r"(?m)^intensity = .*$", f"intensity = {number}", text, count=1))
        for screenshot in (self._subject.folder / "work").glob("autocolor-*.png"):
            screenshot.unlink()


# The servers.


def stream_piece(chance: random.Random) -> bytes:
    """Words of a program, damaged or not, or any words."""
    from tests.fuzz_targets import stream_samples
    from tests.mutations import damaged

    samples = list(stream_samples())
    if chance.random() < 0.3:
        return chance.randbytes(chance.randint(1, 300))
    data = chance.choice(samples)[1:]
    return damaged(data, chance, samples) if chance.random() < 0.7 else data


OpenPort = Callable[[], TcpPort | UnixPort]


def visit(subject: Subject, open_port: OpenPort, chance: random.Random) -> None:
    """A host that draws or misbehaves, and leaves; or a host that asks whether the display still works."""
    subject.events += 1
    act = chance.random()
    try:
        if act < 0.2:
            with open_port() as port:
                port.reset()
                port.send(instructions.write_image(np.full((4, 4), 200)))
                port.send(instructions.read_entries(0, 2))
                port.receive(2)
            return
        port = open_port()
    except RamtekError as error:
        subject.fault(f"a host was not served: {error}")
        return
    with contextlib.suppress(RamtekError, OSError), port.wire.socket as wire:
        wire.setblocking(True)
        wire.settimeout(5)
        for _ in range(chance.randint(0, 4)):
            wire.send(stream_piece(chance)[: 1 << 16])
            if chance.random() < 0.3:
                wire.recv(chance.randint(1, 100000))
            if chance.random() < 0.1:
                port.wire.send_mark()
        if act < 0.4:
            port.wire.break_off()
        elif act < 0.5:
            time.sleep(chance.random() * 3)
        elif act < 0.8:
            wire.shutdown(socket.SHUT_WR)
            while wire.recv(1 << 16):
                pass


def attend_hosts(subject: Subject, open_port: OpenPort, chance: random.Random, over: threading.Event) -> None:
    """Hosts come one after the other, and now and then several at once."""
    while not over.wait(chance.random() / 5):
        count = 8 if chance.random() < 0.05 else 1
        seeds = [random.Random(chance.random()) for _ in range(count)]
        hosts = [threading.Thread(target=visit, args=(subject, open_port, seed)) for seed in seeds]
        for host in hosts:
            host.start()
        for host in hosts:
            host.join()


# The studio.


def use_a_studio(folder: Path, seed: int) -> None:
    """Edit, render, undo, save and open scenes until the process is ended; a file tells how many events."""
    os.chdir(folder)
    chance, events = random.Random(seed), 0
    while True:
        source = Source(chance.choice(("car", "box.obj", "small.sqlite")))
        autosave = Autosave()
        studio = Studio(History(read_scene(source.path), place_of(source)), Ramtek9300())
        for _ in range(300):
            with contextlib.suppress(AutocolorError):
                edit_at_random(studio, chance)
            autosave.update(studio.history)
            events += 1
            Path("events").write_text(str(events))
        autosave.end()


def edit_at_random(studio: Studio, chance: random.Random) -> None:
    """One edit, or one other act."""
    scene, number = studio.scene, chance.random()
    names = [surface.name for surface in scene.surfaces] or ["none"]
    lights = [light.name for light in scene.lights] or ["none"]
    color = (chance.randrange(256), chance.randrange(256), chance.randrange(256))
    acts: list[Callable[[], object]] = [
        lambda: studio.recolor(chance.choice(names), object_color=color),
        lambda: studio.recolor(chance.choice(names), blend=number),
        lambda: studio.recolor(chance.choice(names), ramp=["#200", color, "#fff"]),
        lambda: studio.light(chance.choice(lights), intensity=number),
        lambda: studio.light(chance.choice(lights), on=number < 0.5),
        lambda: studio.add_light(f"light {chance.randrange(5)}", position=(5 * number, -4, 3)),
        lambda: studio.remove_light(chance.choice(lights)),
        lambda: studio.view(angle=360 * number),
        lambda: studio.scalar(name="z"),
        lambda: studio.scalar(None),
        lambda: studio.normals(number < 0.5),
        lambda: [studio.undo() for _ in range(chance.randrange(20))],
        lambda: [studio.redo() for _ in range(chance.randrange(20))],
        lambda: studio.keep_variant(chance.choice("AB")),
        lambda: studio.show_variant(chance.choice("AB")),
        lambda: studio.drop_variant(chance.choice("AB")),
        studio.hold_exposure,
        studio.release_exposure,
        lambda: studio.open(chance.choice(("car", "box.obj", "small.sqlite"))),
        studio.reopen,
        lambda: studio.save("saved.npz", overwrite=True),
        lambda: studio.save_scene("saved", overwrite=True),
        lambda: studio.save_scene("saved.sqlite", overwrite=True),
        lambda: studio.save_session("."),
    ]
    chance.choice(acts)()


# All together.


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns its exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.soak", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=None)
    parser.add_argument("--every", type=float, default=60.0, help="seconds between two reports")
    parser.add_argument("--studio", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    seed = random.randrange(1 << 31) if options.seed is None else options.seed
    if options.studio is not None:
        use_a_studio(options.studio, seed)
    # Ending this process ends the others.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    os.nice(5)
    print(f"seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="soak-") as name:
        return soak(Path(name), 3600 * options.hours, seed, options.every)


def soak(folder: Path, seconds: float, seed: int, every: float) -> int:
    """Use all subjects for some seconds; returns the exit code."""
    from tests.virtual_screen import virtual_screen

    python, over = [sys.executable, "-m"], threading.Event()
    subjects: list[Subject] = []
    threads: list[threading.Thread] = []
    has_screen = shutil.which("Xvfb") and shutil.which("xdotool")
    with contextlib.ExitStack() as stack:
        screen = stack.enter_context(virtual_screen(folder, "1400x1100")) if has_screen else None

        @stack.callback
        def _end() -> None:
            over.set()
            for thread in threads:
                thread.join()
            for subject in subjects:
                subject.end()

        def begin(subject: Subject, use: Callable[[], None]) -> None:
            subjects.append(subject)
            threads.append(threading.Thread(target=use))

        # The studio.
        studio_work = folder / "studio" / "work"
        studio = Subject(
            "studio", [*python, "tests.soak", "--seed", str(seed), "--studio", str(studio_work)], folder
        )
        written_scenes(studio_work)

        def count_events() -> None:
            while not over.wait(1):
                with contextlib.suppress(OSError, ValueError):
                    studio.events = int((studio_work / "events").read_text())

        begin(studio, count_events)

        # The servers.
        serve = [*python, "ramtek_emu", "serve", "--idle", "2"]
        with socket.create_server(("127.0.0.1", 0)) as free:
            number = free.getsockname()[1]
        tcp = Subject("tcp", [*serve, "--port", str(number)], folder)
        unix = Subject("unix", [*serve, "--unix", str(folder / "display")], folder)

        def open_tcp() -> TcpPort:
            return TcpPort(f"tcp://127.0.0.1:{number}", timeout=60)

        def open_unix() -> UnixPort:
            return UnixPort(folder / "display", timeout=60)

        for subject, open_port in ((tcp, open_tcp), (unix, open_unix)):
            wait_for_line(subject)
            arguments = (subject, open_port, random.Random(f"{seed} {subject.name}"), over)
            begin(subject, lambda arguments=arguments: attend_hosts(*arguments))  # type: ignore[misc]

        # The window.
        if screen is not None:
            window = Subject("window", [*python, "autocolor", "view", "car"], folder, DISPLAY=screen.name)
            written_scenes(window.folder / "work")
            hand = WindowHand(window, screen.name, random.Random(f"{seed} window"))

            def use_window() -> None:
                while not over.is_set():
                    hand.act()

            begin(window, use_window)
        else:
            print("window: not used, because Xvfb or xdotool is not installed", flush=True)

        began = time.monotonic()
        for thread in threads:
            thread.start()
        while (now := time.monotonic() - began) < seconds:
            over.wait(min(every, max(0.1, seconds - now)))
            for subject in subjects:
                subject.look(time.monotonic() - began)
                print(f"{(time.monotonic() - began) / 60:6.1f} min  {subject.line()}", flush=True)
        verdicts = [subject.verdict(seconds) for subject in subjects]
    print("\n".join(text for text, _ in verdicts))
    has_faults = any(subject.faults for subject in subjects)
    has_leaks = any(leaks for _, leaks in verdicts)
    print("verdict:", "faults" * has_faults, "leaks" * has_leaks, "" if has_faults or has_leaks else "sound")
    return has_faults or has_leaks


def wait_for_line(subject: Subject) -> None:
    """Wait until a server has printed its address."""
    assert subject.process.stdout is not None
    if not subject.process.stdout.readline():
        raise SystemExit(f"{subject.name} does not start: see {subject.folder / 'errors'}")


if __name__ == "__main__":
    sys.exit(main())
