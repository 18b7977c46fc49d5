"""Lines that a command refuses: its own sentences, and the exit codes of those that the library raises."""

from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import write_palette
from tests.autocolor.commands.conftest import Refused

COLOR = "surfaces.side.object_color"
SWEEP = "-o {name}.png --size 32x24"

NO_SURFACE = "recolor must have a SURFACE, or --set KEY=VALUE without colors; write it as in recolor PICTURE"
RENDERS = "--set: a setting of a picture must need no rendering, such as colors, the mapping, or limits"
OWN = "--made must be a file of its own, not"
MESH = "must come with a mesh file as SCENE; name a file, or leave --"
ONE = "view must have one of SCENE, --recover, --sessions and --forget, not"
EITHER = "show must have either SCENE or --recover; name a scene"
ADDRESS = "--to: an address must be tcp://host:port"
TO = "--to tcp://127.0.0.1:1"


@pytest.mark.parametrize(
    ("line", "code", "sentence"),
    [
        ("rendr two.obj", 2, "Error: there is no command 'rendr'; did you mean 'render'?"),
        ("info", 2, "Error: Missing argument 'SCENE'."),
        ("info two.obj more", 2, "Error: Got unexpected extra argument (more)"),
        ("render --up y", 2, f"--up {MESH}up out"),
        (f"show --recover --scale 2 {TO}", 2, f"--scale {MESH}scale out"),
        ("render scene --size 4097x10", 2, "Error: Invalid value for '--size'"),
        ("render scene --light kye", 2, ""),
        ("render scene --view tited", 2, ""),
        ("render scene --set scalar.name=z --normals", 2, "--set: words must be 'levels' where a scalar"),
        ("render scene -o a.png --size 1600x1200 --smooth 4 --limit 0.5", 65, "a picture of 1600 x 1200 pi"),
        ("render bad.obj", 65, ""),
        ("render ''", 65, ""),
        ("recolor scene.npz", 2, NO_SURFACE),
        ("recolor scene.npz --object navy --set mapping=gamma", 2, NO_SURFACE),
        ("recolor scene.npz --palette one.csv --set mapping=gamma", 2, NO_SURFACE),
        ("recolor scene.npz --set ambient=0.5", 2, RENDERS),
        ("recolor scene.npz side --palette one.csv --blend 1", 2, "--palette gives all colors of a surface;"),
        ("recolor scene.npz side --palette one.csv", 65, "one.csv: a ramp must have 2 to 1,024 colors, not"),
        ("recolor scene.npz side --palette many.csv", 65, "many.csv: a ramp must have 2 to 1,024 colors"),
        ("recolor scene.npz side --ramp #200,#f60 --blend 0", 2, ""),
        ("recolor two.obj side", 65, ""),
        ("palette scene spare", 2, "surface 'spare' has no levels, because no part has it; choose"),
        ("palette none.npz side -o side.png", 2, ""),
        (f"sweep scene {SWEEP}", 2, "sweep must have --vary or --table; write it as in"),
        (f"sweep scene --vary ambiet=1,2 {SWEEP}", 2, "--vary ambiet: there is no field 'ambiet'; did you"),
        (f"sweep scene --table t.csv {SWEEP}", 65, "t.csv, column ambiet: there is no field 'ambiet'"),
        (f"sweep scene --table t.csv --made ./t.csv {SWEEP}", 2, f"{OWN} ./t.csv, which is read; name"),
        (f"sweep scene --vary ambient=1 --made scene {SWEEP}", 2, f"{OWN} scene, which is read; name"),
        (f"sweep scene --vary {COLOR}=@no.gpl {SWEEP}", 66, ""),
        ("animate scene -o a.webp", 2, "animate must have --vary, --table or --turn; write it as in"),
        ("animate scene --vary ambiend=0,1 -o a.webp", 2, "--vary ambiend: there is no field 'ambiend'; did"),
        ("animate scene --table bad.csv -o a.webp", 65, "bad.csv: "),
        ("page scene.npz --size 640x480", 2, "--views, --size and --smooth are for a scene, not for"),
        ("page scene.npz --views 12", 2, "--views, --size and --smooth are for a scene, not for"),
        ("page scene --views 1", 2, "the views of a page must be a whole number from 2 to 64"),
        ("page scene --link coupe.html", 2, "a link must be the address of the page"),
        ("page scene.npz --table views.csv", 65, "views.csv: variant '3': "),
        ("page scene.npz --set view.angle=3", 2, ""),
        ("convert two.obj -", 2, "OUT must be a file or a folder, not '-'; give it a name"),
        ("convert two.obj ''", 2, "OUT must be a file or a folder, not ''; give it a name"),
        # What cannot be written is refused before anything is read.
        ("convert none.obj two.obj", 73, ""),
        ("explain scene 24 0 --size 32x24", 2, ""),
        ("--paints few.csv view scene", 2, "--paints before a command is for the demo; write it after"),
        ("view", 2, f"{ONE} 0; name a scene"),
        ("view scene --recover", 2, f"{ONE} 2; name a scene"),
        ("view --set ambient=1 --sessions", 2, "--set is for SCENE, not for sessions; leave it out"),
        ("view --sessions --paints a.csv", 2, "--paints is for a scene or a session that is shown;"),
        (f"show {TO}", 2, EITHER),
        (f"show scene --recover newest {TO}", 2, EITHER),
        (
            f"show --recover --once {TO}",
            2,
            "--set and --once are for SCENE, not for sessions; leave them out",
        ),
        (f"show scene --paints a.gpl --once {TO}", 2, "--paints is for an interactive session, not for"),
        ("show scene --to 127.0.0.1:9300", 2, ADDRESS),
        ("show scene --to display", 2, ADDRESS),
        ("show scene", 2, "Error: Missing option '--to'"),
        (f"show scene {TO}", 69, "a display must listen at tcp://127.0.0.1:1, and it is not reached"),
        (f"show --recover {TO}", 66, ""),
    ],
)
def test_what_is_refused_writes_nothing(
    saved: Path, refused: Refused, line: str, code: int, sentence: str
) -> None:
    scene = saved.parent / "scene" / "scene.toml"
    scene.write_text(f"{scene.read_text()}[surfaces.spare]\n")
    texts = {"bad.obj": "v 0 0", "t.csv": "ambiet\n1", "bad.csv": "time,ambient\n1,0.1\n1,0.2"}
    for name, text in {**texts, "views.csv": "view.angle\n3"}.items():
        Path(name).write_text(f"{text}\n")
    write_palette("one.csv", ["red"])
    write_palette("many.csv", ["red"] * 1025)
    assert refused(line, code).startswith(sentence)
