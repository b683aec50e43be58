"""Runs the tests under Wine or qemu's user mode, and compares their number with that of this system:
`elsewhere.py SYSTEM TARGET RUNNER [PROGRAM …]`, where SYSTEM is `wine` or `qemu`.

All tests of the workspace are run but those that `elsewhere.tsv` names with the reason. One that is missing there, or that fails,
and one that is named but would not be missed, is an error.
"""

import fnmatch
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIMIT_SECONDS = 3600
# As many failures as are run again alone: under load Wine sometimes starts no process ("Internal error").
MOST_REPEATED = 5


def programs(target):
    """The test programs of the workspace by name, built for `target`, or for this system."""
    command = ["cargo", "test", "--no-run", "--quiet", "--locked", "--workspace", "--message-format=json"]
    built = subprocess.run(command + (["--target", target] if target else []), cwd=ROOT, stdout=subprocess.PIPE, check=True)
    found = {}
    for line in built.stdout.decode().splitlines():
        message = json.loads(line)
        if message.get("reason") != "compiler-artifact" or not message["executable"] or not message["profile"]["test"]:
            continue
        folder = Path(message["manifest_path"]).parent
        kind = message["target"]["kind"][0]
        if kind == "bench":
            continue
        package = "cc67-tests" if folder.name == "tests" else re.search(r'name = "(.*?)"', (folder / "Cargo.toml").read_text())[1]
        name = {"test": message["target"]["name"], "bin": "main"}.get(kind, "unit")
        found[f"{package}/{name}"] = (message["executable"], folder)
    return found


def execute(runner, program, words):
    """The output of a test program, in the folder and with the variables that Cargo gives it."""
    executable, folder = program
    variables = dict(os.environ, CARGO_MANIFEST_DIR=str(folder))
    command = [*runner, executable, *words]
    # A file, as a process that a test has left behind would keep the end of a pipe open.
    with tempfile.TemporaryFile() as output:
        try:
            subprocess.run(command, cwd=folder, env=variables, stdout=output, stderr=subprocess.STDOUT, timeout=LIMIT_SECONDS)
            ending = ""
        except subprocess.TimeoutExpired:
            ending = "\nthe time limit has passed\n"
        output.seek(0)
        return output.read().decode(errors="replace") + ending


def listed(runner, program):
    """The names of the tests of a program."""
    lines = execute(runner, program, ["--list"]).replace("\r", "").splitlines()
    return {line.removesuffix(": test") for line in lines if line.endswith(": test")}


def rows(system):
    """The rows of the list for a system: program, pattern of tests, reason."""
    lines = (ROOT / ".ci/elsewhere.tsv").read_text().splitlines()[1:]
    return [row[1:] for row in (line.split("\t") for line in lines) if row[0] in (system, "both")]


def successes(output):
    """The tests that passed; Wine may write before a line."""
    return set(re.findall(r"\btest (.+?)(?: - should panic)? +\.\.\. ok$", output, re.M))


def main(system, target, runner, chosen):
    here, there = programs(None), programs(target)
    problems, repeated, totals = [], [], [0, 0, 0]
    print(f"| tests | Linux | {system} | named in .ci/elsewhere.tsv |\n|---|---|---|---|")
    for name in sorted(here):
        if chosen and not any(fnmatch.fnmatch(name, each) for each in chosen):
            continue
        patterns = [pattern for program, pattern, _ in rows(system) if program == name]
        is_named = lambda test: any(fnmatch.fnmatchcase(test, pattern) for pattern in patterns)
        all_tests = listed([], here[name])
        named = {test for test in all_tests if is_named(test)}
        for pattern in patterns:
            if not fnmatch.filter(all_tests, pattern):
                problems.append(f"{name}: no test is called {pattern}, which the list names")
        built = listed(runner, there[name]) if "*" not in patterns else set()
        problems += [f"{name}: {test} is not built for {target}" for test in sorted(all_tests - built - named)]
        run = built - named
        passed = 0
        if run:
            skipped = [word for test in sorted(built & named) for word in ("--skip", test)]
            output = execute(runner, there[name], ["--exact", *skipped]).replace("\r", "")
            good = run & successes(output)
            is_over = "test result:" in output
            failed = sorted(run - good) if is_over and len(run - good) <= MOST_REPEATED else []
            for test in failed:
                if test in successes(execute(runner, there[name], ["--exact", test]).replace("\r", "")):
                    good.add(test)
                    repeated.append(f"{name}: {test} passed only when it ran again alone")
            passed = len(good)
            if passed < len(run) or not is_over:
                problems.append(f"{name}: {len(run) - passed} of {len(run)} tests did not pass")
                log = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / f"{system}-{name.replace('/', '-')}.txt"
                log.write_text(output)
        print(f"| {name} | {len(all_tests)} | {passed} | {len(named)} |", flush=True)
        totals = [total + more for total, more in zip(totals, (len(all_tests), passed, len(named)))]
    print("| all | {} | {} | {} |".format(*totals))
    print("\n".join(repeated + problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3].split(), sys.argv[4:]))
