"""Fails if one of the files that are handed out lacks what must be in each: artefacts.py FILE …

Archives, packages and wheels need both licences, and with machine code the notices of third parties.
"""

from __future__ import annotations

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MIT, APACHE = (ROOT / name for name in ("LICENSE-MIT", "LICENSE-APACHE"))
NOTICES = ROOT / "cc67/THIRD-PARTY.txt"


def contents(path: Path) -> dict[str, bytes]:
    """The files in an artefact, by their names."""
    name = path.name
    if name.endswith((".zip", ".whl", ".vsix")):
        with zipfile.ZipFile(path) as archive:
            return {each: archive.read(each) for each in archive.namelist() if not each.endswith("/")}
    if name.endswith((".tar.gz", ".crate")):
        with tarfile.open(path) as archive:
            return {each.name: archive.extractfile(each).read() for each in archive if each.isfile()}  # type: ignore[union-attr]
    if name.endswith(".deb"):
        unpacked = subprocess.run(["dpkg-deb", "--fsys-tarfile", path], check=True, capture_output=True).stdout
        import io

        with tarfile.open(fileobj=io.BytesIO(unpacked)) as archive:
            return {each.name: archive.extractfile(each).read() for each in archive if each.isfile()}  # type: ignore[union-attr]
    sys.exit(f"{path}: what is this?")


def lacking(path: Path) -> list[str]:
    """What an artefact must have and has not."""
    files = contents(path)
    whole = b"\n".join(files.values())
    wanted = {MIT.name: MIT, APACHE.name: APACHE}
    if not path.name.endswith((".vsix", ".crate")):
        wanted[NOTICES.name] = NOTICES
    missing = [name for name, file in wanted.items() if file.read_bytes().strip() not in whole]
    if path.name.startswith("cc67-") and path.name.endswith((".tar.gz", ".zip")) and "PKG-INFO" not in str(list(files)):
        ends = ["man/man1/cc67.1", "man/man1/cc67-run.1", "completions/cc67.bash", "completions/_cc67", "completions/cc67.fish",
                "completions/_cc67.ps1", "include/cc67board.h", "CHANGELOG.md", "README.md"]
        missing += [end for end in ends if not any(name.endswith(end) and text for name, text in files.items())]
    return missing


if __name__ == "__main__":
    found = {path: lacking(Path(path)) for path in sys.argv[1:]}
    for path, missing in found.items():
        print(f"{path}: {'lacks ' + ', '.join(missing) if missing else 'whole'}")
    sys.exit(any(found.values()))
