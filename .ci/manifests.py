"""Writes what package managers need for a release: manifests for winget and scoop, a formula for Homebrew.

manifests.py VERSION ADDRESS SHA256SUMS FOLDER: ADDRESS is where the files of the release are (`https://…/releases/download/v1.2.3`),
SHA256SUMS the list of their checksums. `manifests.py --check FOLDER` compares what is there with the schemas of the package managers,
which are in `.ci/schemas` (winget: Microsoft, MIT; scoop: Unlicense or MIT).
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCHEMAS = ROOT / ".ci/schemas"

DESCRIPTION = "Compile, run, test and debug programs for KFLOP motion controllers"
LICENCE = "MIT OR Apache-2.0"

# The archives of a release: target, how scoop, winget and Homebrew call its system. The workflow builds these and no others.
TARGETS = [
    ("x86_64-unknown-linux-gnu", None, None, ("linux", "intel")),
    ("aarch64-unknown-linux-gnu", None, None, ("linux", "arm")),
    ("aarch64-apple-darwin", None, None, ("macos", "arm")),
    ("x86_64-apple-darwin", None, None, ("macos", "intel")),
    ("x86_64-pc-windows-msvc", "64bit", "x64", None),
    ("aarch64-pc-windows-msvc", "arm64", "arm64", None),
]


def archive(version: str, target: str) -> str:
    return f"cc67-{version}-{target}" + (".zip" if "windows" in target else ".tar.gz")


def scoop(version: str, address: str, sums: dict[str, str]) -> str:
    def one(target: str) -> dict[str, str]:
        name = archive(version, target)
        return {"url": f"{address}/{name}", "hash": sums[name], "extract_dir": f"cc67-{version}-{target}"}

    manifest = {
        "version": version,
        "description": DESCRIPTION,
        "homepage": home(address),
        "license": "MIT|Apache-2.0",
        "architecture": {name: one(target) for target, name, _, _ in TARGETS if name},
        "bin": "cc67.exe",
    }
    return json.dumps(manifest, indent=4) + "\n"


def home(address: str) -> str:
    """The page of the repository whose release is at an address."""
    return address.split("/releases/")[0]


def winget(version: str, address: str, sums: dict[str, str]) -> dict[str, str]:
    def manifest(kind: str, **fields: object) -> str:
        # YAML is JSON with more ways to write it.
        head = {"PackageIdentifier": "cc67.cc67", "PackageVersion": version}
        return json.dumps({**head, **fields, "ManifestType": kind, "ManifestVersion": "1.12.0"}, indent=2) + "\n"

    def installer(target: str, architecture: str) -> dict[str, object]:
        name = archive(version, target)
        nested = {"RelativeFilePath": f"cc67-{version}-{target}\\cc67.exe", "PortableCommandAlias": "cc67"}
        return {
            "Architecture": architecture,
            "InstallerUrl": f"{address}/{name}",
            "InstallerSha256": sums[name].upper(),
            "NestedInstallerFiles": [nested],
        }

    installers = [installer(target, name) for target, _, name, _ in TARGETS if name]
    return {
        "cc67.cc67.yaml": manifest("version", DefaultLocale="en-US"),
        "cc67.cc67.installer.yaml": manifest(
            "installer", InstallerType="zip", NestedInstallerType="portable", Commands=["cc67"], Installers=installers
        ),
        "cc67.cc67.locale.en-US.yaml": manifest(
            "defaultLocale", PackageLocale="en-US", Publisher="The cc67 authors", PackageName="cc67", PackageUrl=home(address),
            License=LICENCE, ShortDescription=DESCRIPTION, Tags=["cnc", "compiler", "kflop", "motion-control", "simulator"],
        ),
    }


def homebrew(version: str, address: str, sums: dict[str, str]) -> str:
    lines = ["class Cc67 < Formula", f'  desc "{DESCRIPTION}"', f'  homepage "{home(address)}"', f'  version "{version}"',
             '  license any_of: ["MIT", "Apache-2.0"]', ""]
    for system in ("macos", "linux"):
        lines.append(f"  on_{system} do")
        for target, _, _, brew in TARGETS:
            if brew and brew[0] == system:
                name = archive(version, target)
                lines += [f"    on_{brew[1]} do", f'      url "{address}/{name}"', f'      sha256 "{sums[name]}"', "    end"]
        lines += ["  end", ""]
    lines += [
        "  def install",
        '    bin.install "cc67"',
        '    man1.install Dir["man/man1/*.1"]',
        '    bash_completion.install "completions/cc67.bash" => "cc67"',
        '    zsh_completion.install "completions/_cc67"',
        '    fish_completion.install "completions/cc67.fish"',
        '    include.install "include/cc67board.h"',
        '    lib.install Dir["lib/*"]',
        "  end",
        "",
        "  test do",
        '    assert_match version.to_s, shell_output("#{bin}/cc67 --version")',
        "  end",
        "end",
    ]
    return "\n".join(lines) + "\n"


def write(version: str, address: str, checksums: Path, folder: Path) -> None:
    sums: dict[str, str] = {}
    for line in checksums.read_text(encoding="utf-8").splitlines():
        value, name = line.split(maxsplit=1)
        sums[name.lstrip("*")] = value
    files = {"scoop/cc67.json": scoop(version, address, sums), "homebrew/cc67.rb": homebrew(version, address, sums)}
    files |= {f"winget/{name}": text for name, text in winget(version, address, sums).items()}
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def check(folder: Path) -> None:
    from jsonschema import Draft7Validator

    schemas = {"cc67.cc67.yaml": "winget.version", "cc67.cc67.installer.yaml": "winget.installer",
               "cc67.cc67.locale.en-US.yaml": "winget.defaultLocale", "cc67.json": "scoop"}
    files = sorted(path for path in folder.rglob("*") if path.name in schemas)
    assert len(files) == len(schemas), files
    for path in files:
        schema = json.loads((SCHEMAS / f"{schemas[path.name]}.json").read_text(encoding="utf-8-sig"))
        Draft7Validator(schema).validate(json.loads(path.read_text(encoding="utf-8")))
        print(f"{path.relative_to(folder)}: valid")
    formula = (folder / "homebrew/cc67.rb").read_text(encoding="utf-8")
    assert formula.count("sha256 \"") == sum(1 for row in TARGETS if row[3])
    try:
        subprocess.run(["ruby", "-c", folder / "homebrew/cc67.rb"], check=True)
    except FileNotFoundError:
        print("homebrew/cc67.rb: its syntax is not checked: there is no Ruby")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["--targets"]:
            print("\n".join(row[0] for row in TARGETS))
        case ["--check", folder]:
            check(Path(folder))
        case [version, address, checksums, folder]:
            write(version, address, Path(checksums), Path(folder))
        case _:
            sys.exit(__doc__)
