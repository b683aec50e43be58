#!/usr/bin/env python3
"""Draws comments, names, messages and help texts for a reader who has not seen the code.

    tests/readers.py [SEED] [--command PATH]

The reader writes down each place that needs a second look; its whole kind is mended, and the next draw has a new seed.
Help texts are drawn if PATH names a built `cc67`.
"""

import argparse
import random
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COUNTS = {"comments": 60, "names": 40, "messages": 40, "help": 10}


def sources():
    """The source files of the repository, with their lines."""
    listed = subprocess.run(["git", "ls-files", "*.rs"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.split():
        yield name, (ROOT / name).read_text(encoding="utf-8").splitlines()


def comments():
    """Doc comments, each with the line of the item that it describes."""
    found = []
    for name, lines in sources():
        at = 0
        while at < len(lines):
            if not re.match(r"\s*//[/!]($|[^/])", lines[at]):
                at += 1
                continue
            begin = at
            while at < len(lines) and re.match(r"\s*//[/!]", lines[at]):
                at += 1
            text = "\n".join("    " + re.sub(r"^\s*//[/!] ?", "", line) for line in lines[begin:at])
            item = at
            while item < len(lines) and re.match(r"\s*(#|$)", lines[item]):
                item += 1
            shown = lines[item].strip() if item < len(lines) else ""
            found.append(f"{name}:{begin + 1}\n{text}\n    > {shown}")
    return found


def names():
    """Names of types and functions outside tests."""
    item = re.compile(r"\s*(?:pub(?:\([^)]*\))? )?(?:const |unsafe )*(?:struct|enum|trait|type|fn) (\w+).*")
    found = []
    for name, lines in sources():
        if "test" not in name:
            found += [f"{name}: {line.strip()}" for line in lines if item.fullmatch(line)]
    return found


def messages():
    """The messages of the compiler, from the book's list."""
    text = (ROOT / "cc67/book/src/messages.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```text\n(.*?)^```", text, re.M | re.S)
    lines = [line for block in blocks for line in block.splitlines()] or text.splitlines()
    return [line for line in lines if len(line.split()) > 2 and not line.startswith("#")]


def help_texts(command):
    """The help of each command."""
    text = subprocess.run([command, "--help"], capture_output=True, text=True, check=True).stdout
    words = re.findall(r"^  ([a-z-]+)  ", text, re.M)
    return [subprocess.run([command, word, "--help"], capture_output=True, text=True).stdout for word in words]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seed", nargs="?", type=int, default=random.randrange(10**6))
    parser.add_argument("--command")
    options = parser.parse_args()
    draw = random.Random(options.seed)
    print(f"seed {options.seed}")
    kinds = {"comments": comments(), "names": names(), "messages": messages()}
    if options.command:
        kinds["help"] = help_texts(options.command)
    for kind, texts in kinds.items():
        count = min(COUNTS[kind], len(texts))
        print(f"\n== {count} of {len(texts)} {kind}\n")
        for number, text in enumerate(draw.sample(texts, count), 1):
            print(f"{number:3} {text}")


if __name__ == "__main__":
    sys.exit(main())
