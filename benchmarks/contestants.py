"""The peers of a run: how far each agrees, and its cases."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from autocolor import Scene
from benchmarks.agreement import Agreement, agreement
from benchmarks.cases import Case
from benchmarks.comparison import EDITS
from benchmarks.peers import PEERS, opened
from benchmarks.peers.peer import AbsentError, Peer
from benchmarks.points import STEP

FIRST = "first picture"
FAR = 1.0
"""How far eye and lights are moved for pictures to compare."""
WAKING = 3
"""Pictures of a peer that are not timed before the one that is."""


@dataclass
class Contestant:
    """A peer, how far its pictures agree, and the scene that it shows."""

    name: str
    peer: Peer
    agreements: dict[str, Agreement]
    scene: Scene

    def compare_pictures(self) -> None:
        """Compare the first picture, and one after each edit, by a step that leaves nothing as it was."""
        self.agreements[FIRST] = agreement(self.peer.field(), self.scene)
        for edit, show in self.peer.edits.items():
            there = EDITS[edit](self.scene, FAR)
            show(there)
            self.agreements[edit] = agreement(self.peer.field(), there)
            show(self.scene)

    @property
    def agrees(self) -> bool:
        """Whether all its pictures agree."""
        return all(each.holds for each in self.agreements.values())

    @property
    def disagreement(self) -> str:
        """The first of its pictures that does not agree, and how far it does."""
        return next(f"{edit}: {each}" for edit, each in self.agreements.items() if not each.holds)

    def cases(self) -> Iterator[Case]:
        """Its edits as cases; the edited scene is made before.

        So are some pictures, for its threads to be awake: while others have their turns they fall asleep so
        deeply that the next picture takes up to a third longer.
        """
        for edit, show in self.peer.edits.items():

            def make(edit: str = edit, show: Callable[[Scene], object] = show) -> None:
                for _ in range(0 if self.peer.is_slow else WAKING):
                    show(self.scene)
                self.scene = EDITS[edit](self.scene, STEP)

            yield Case(case_of(self.name, edit), lambda show=show: show(self.scene), make)  # type: ignore[misc]


def contestants(scene: Scene, names: Iterable[str] = PEERS) -> tuple[list[Contestant], dict[str, str]]:
    """The peers that are there, each with its pictures compared, and why the others are not."""
    present, absent = [], {}
    for name in names:
        try:
            peer = opened(name, scene)
        except AbsentError as error:
            absent[name] = str(error)
            continue
        contestant = Contestant(name, peer, {}, scene)
        contestant.compare_pictures()
        present.append(contestant)
    return present, absent


def case_of(name: str, edit: str) -> str:
    """The name of a peer's case."""
    return f"{name}: {edit}"
