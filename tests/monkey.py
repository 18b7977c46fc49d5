"""Use all screens at random, by the unit and by keys: `python -m tests.monkey [--minutes N] [--seed N]`.

A gesture is a move, a click, a drag, a key or a typed text at a random place. After 1,000 gestures the page
is compared with the same page drawn whole, and the picture with that of a fresh studio; then another scene
follows. The script prints each exception and difference with its seed, and leaves with 1 if there was any.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
import traceback
from pathlib import Path

from autocolor import Studio
from autocolor.screens.session import PICTURE
from autocolor.widgets.sheet import Sheet
from ramtek_emu import Ramtek9300
from tests.autocolor.random_hand import RandomHandWithKeys
from tests.autocolor.test_random_sessions import SCENES, begun
from tests.small import held

GESTURES = 1000


def run(name: str, seed: int, gestures: int = GESTURES) -> str:
    """Use a scene; returns the story of a fault, or an empty text."""
    done = 0
    try:
        with tempfile.TemporaryDirectory() as folder:
            display = Ramtek9300()
            viewer = begun(name, Path(folder), display)
            hand = RandomHandWithKeys(viewer, display, seed)
            for done in range(gestures):  # noqa: B007
                hand.do()
            # A picture that comes in line by line is shown whole.
            viewer.on_key("escape")
            whole = Ramtek9300()
            Sheet(whole).show(viewer.board.page())
            if held(display) != held(whole):
                return f"the screen {viewer.page} differs from the same page drawn whole"
            hand.let_go()
            viewer.clear()
            if viewer.page != PICTURE:
                return f"clearing leads to the screen {viewer.page}"
            fresh = Ramtek9300()
            Studio(viewer.studio.scene, fresh)
            return "" if held(display) == held(fresh) else "the picture differs from that of a fresh studio"
    except Exception:
        return f"gesture {done}: {traceback.format_exc()}"


def main() -> None:
    """Use scene after scene until the time is over, and print a line for each."""
    parser = argparse.ArgumentParser(prog="python -m tests.monkey", description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp()
    end, seed, faults = time.monotonic() + 60 * options.minutes, options.seed, 0
    while time.monotonic() < end:
        name = list(SCENES)[seed % len(SCENES)]
        fault = run(name, seed)
        faults += bool(fault)
        print(f"seed {seed}: {name}: {fault or 'as a fresh studio'}", flush=True)
        seed += 1
    print(f"{(seed - options.seed) * GESTURES:,} gestures, {faults} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
