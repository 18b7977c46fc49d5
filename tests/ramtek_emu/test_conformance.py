"""The claims of the conformance suite on this display, and the command that runs them on any emulator."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from docs.generate.blocks import blocks_of
from ramtek_emu.commands.ramtek import ramtek
from ramtek_emu.configuration import CONFIGURATIONS, checked_configuration
from ramtek_emu.conformance import claims as module
from ramtek_emu.conformance.claims import JOYSTICK, all_claims
from ramtek_emu.conformance.runner import failure_here, failure_on
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.table import FORMATS, OPERANDS
from tests.ramtek_emu.processes import ROOT, environment

CLAIMS = all_claims()
FOLDER = Path(module.__file__).parent
SERVE = (sys.executable, "-m", "ramtek_emu", "serve", "--stdio", "--configuration", "{}")
POINT = next(claim for claim in CLAIMS if claim.name == "a vector to the operating point is a point")


@pytest.mark.parametrize("subject", sorted({claim.subject for claim in CLAIMS}))
def test_every_claim_holds_wherever_its_stream_is_cut(subject: str) -> None:
    failures = {claim.name: failure_here(claim) for claim in CLAIMS if claim.subject == subject}
    assert {name: failure for name, failure in failures.items() if failure} == {}


def test_the_claims_cover_the_instruction_set_and_say_where_they_come_from() -> None:
    assert len(CLAIMS) >= 400
    assert len({(claim.name, claim.display) for claim in CLAIMS}) == len(CLAIMS)
    assert sum(path.stat().st_size for path in FOLDER.glob("*.jsonl")) <= 1_000_000
    keys = set(re.findall(r"^## (\w+):", (ROOT / "docs" / "SOURCES.md").read_text("utf-8"), re.MULTILINE))
    assert {claim.source.partition(" ")[0] for claim in CLAIMS} <= keys
    assert {claim.kind for claim in CLAIMS} == {"sourced", "assumed"}
    assert {checked_configuration(claim.display).name for claim in CLAIMS} == set(CONFIGURATIONS)
    names: set[str] = set()
    operands: set[str] = set()
    cut: set[str] = set()
    for claim in CLAIMS:
        if claim.subject != "listings" and not any(write.startswith(JOYSTICK) for write in claim.writes):
            for instruction in Decoder(checked_configuration(claim.display)).feed(claim.words):
                names.add(instruction.format.name)
                operands.update(instruction.operands if instruction.format.is_normal else ())
                cut.update([instruction.format.name] if claim.cut else ())
    assert names >= {"???", *(row.name for row in FORMATS)}
    assert operands == set(OPERANDS)
    assert cut >= {"???", *(row.name for row in FORMATS if not row.unimplemented)}


def test_a_claim_that_does_not_hold_says_what_was_expected_and_given() -> None:
    wrong = replace(POINT, replies=POINT.replies.replace("0005", "0006"))
    assert failure_here(wrong) == "from reply word 4 on, expected 0006 0000*4, given 0005 0000*4"
    assert failure_here(replace(POINT, replies="0000")).endswith("expected nothing, given 0000*3 0005 0000*4")
    unread = replace(POINT, in_process={"status": "ILLEGAL|READY"})
    assert failure_here(unread) == "the status is READY, not ILLEGAL|READY"
    black = replace(POINT, in_process={"field": {"3,3": "FFFFFF"}})
    assert failure_here(black) == "the colors from 3,3 on are 000000, not FFFFFF"
    listed = replace(POINT, in_process={"listing": []})
    assert failure_here(listed).startswith("the listing is ['00000: 0802 8002 0005")
    program = replace(POINT, in_process={"program": ["NOP"], "refused": ["NOP"]})
    assert failure_here(program) == "the text assembles to 0700"
    refused = replace(program, writes=("0700",), ask="", replies="")
    assert failure_here(refused) == "the text 'NOP' is not refused"


def run(*arguments: str, code: int) -> str:
    done = CliRunner(env=environment()).invoke(ramtek, ["conformance", *arguments])
    assert done.exit_code == code, done.output
    return done.output


def test_the_suite_runs_on_an_emulator_on_a_pipe() -> None:
    assert run("--only", "recorded", "--only", "zp", "--", *SERVE, code=0).splitlines() == [
        "subject        claims  passed  failed",
        "recorded            2       2       0",
        "all                 2       2       0",
    ]
    # A claim with `cut` is sent once more, in writes of a byte.
    cut = next(claim for claim in CLAIMS if claim.cut and claim.subject == "reading")
    assert failure_on(cut, SERVE, 60) == ""
    table = run(
        "--only", POINT.name, "--seconds", "60", "--", sys.executable, "-c", "print(end='!!')", code=1
    )
    assert table.splitlines()[1:] == [
        "vectors             1       0       1",
        f"  {POINT.name} (princeton-9300, BTL point.c, sourced)",
        "    from reply word 0 on, expected 0000*4 0005 0000*4, given 2121",
        "all                 1       0       1",
    ]


def test_an_emulator_that_hangs_is_ended_and_fails() -> None:
    hangs = (sys.executable, "-c", "import time; time.sleep(600)")
    assert failure_on(POINT, hangs, 0.5) == "the emulator did not end in 0.5 s"
    assert "COMMAND must be a program, not 'nowhere'" in run("--", "nowhere", code=2)
    assert "--only must be the key of a claim, not NO SUCH KEY" in run("--only", "NO SUCH KEY", code=2)


@pytest.mark.skipif(shutil.which("node") is None, reason="node runs JavaScript")
def test_the_runner_of_the_document_runs_the_claims(tmp_path: Path) -> None:
    document = (ROOT / "docs" / "CONFORMANCE.md").read_text("utf-8")
    (code,) = (block.text for block in blocks_of(document) if block.language == "js")
    (tmp_path / "runner.js").write_text(code)
    lines = (FOLDER / "recorded.jsonl").read_text("utf-8").splitlines()[-2:]
    (tmp_path / "claims.jsonl").write_text("\n".join(lines))
    command = ["node", "runner.js", "claims.jsonl", *SERVE]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment(), capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout == ""
