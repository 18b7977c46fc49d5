"""The claims of the conformance suite on this display, and the command that runs them on any emulator."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

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
    seen: defaultdict[str, set[str]] = defaultdict(set)
    for claim in CLAIMS:
        if claim.subject != "listings" and not any(write.startswith(JOYSTICK) for write in claim.writes):
            for instruction in Decoder(checked_configuration(claim.display)).feed(claim.words):
                seen["named"].add(instruction.format.name)
                seen["operands"].update(instruction.operands if instruction.format.is_normal else ())
                seen["cut" if claim.cut else ""].add(instruction.format.name)
    assert seen["named"] >= {"???", *(row.name for row in FORMATS)}
    assert seen["operands"] == set(OPERANDS)
    assert seen["cut"] >= {"???", *(row.name for row in FORMATS if not row.unimplemented)}


@pytest.mark.parametrize(
    ("changes", "failure"),
    [
        ({"replies": "0000*4 0006"}, "from reply word 4 on, expected 0006, given 0005 0000*4"),
        ({"replies": "0000"}, "from reply word 1 on, expected nothing, given 0000*3 0005 0000*4"),
        ({"in_process": {"status": "ILLEGAL|READY"}}, "the status is READY, not ILLEGAL|READY"),
        ({"in_process": {"field": {"3,3": "FF00FF"}}}, "the colors from 3,3 on are 000000, not FF00FF"),
        ({"in_process": {"program": ["NOP"]}}, "the text assembles to 0700"),
    ],
)
def test_a_claim_that_does_not_hold_says_why(changes: dict[str, Any], failure: str) -> None:
    assert failure_here(replace(POINT, **changes)) == failure


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
    # The first emulator leaves more words in the pipe than it can store.
    for code in ("pass", "os.close(0)", "os.close(1)"):
        hangs = (sys.executable, "-c", f"import os, time; {code}; time.sleep(600)")
        claim = replace(POINT, ask="0700*99999 0700*99999", replies="")
        assert failure_on(claim, hangs, 0.5) == "the emulator did not end in 0.5 s"


def test_what_is_no_program_and_no_key_is_refused(tmp_path: Path) -> None:
    script = tmp_path / "script"
    script.write_text("no program")
    for mode in (0o644, 0o755):
        script.chmod(mode)
        assert f"COMMAND must be a program, not '{script}' (" in run("--", str(script), code=2)
    assert "not 'nowhere' (No such file or directory); give" in run("--", "nowhere", code=2)
    assert "--only must be the key of a claim, not NO SUCH KEY" in run("--only", "NO SUCH KEY", code=2)
    assert "a claim that a pipe can test, not listings" in run("--only", "listings", "--", "true", code=2)


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
