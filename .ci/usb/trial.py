#!/usr/bin/env python3
"""cc67 at the controller's USB chip, in a virtual machine: `trial.py CC67 LINUX`.

CC67 is the command, LINUX the folder of an unpacked kernel package. Prints what the guest prints, and exits with 1 if
something else was expected.
"""

from __future__ import annotations

import asyncio
import gzip
import lzma
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from chip import Chip

HERE = Path(__file__).parent
MODULES = [
    "usb/common/usb-common",
    "usb/core/usbcore",
    "usb/host/xhci-hcd",
    "usb/host/xhci-pci",
    "usb/serial/usbserial",
    "usb/serial/ftdi_sio",
]
# Seconds after which the trial has failed.
LIMIT = 600

HELLO = '#include "KMotionDef.h"\nmain() { printf("hello %d\\n", 6 * 7); }\n'
COUNTS = '#include "KMotionDef.h"\nint count = 5;\nmain() { for (;;) { count++; Delay_sec(0.01); } }\n'
PRINTS = '#include "KMotionDef.h"\nmain() { int i; for (i = 0;; i++) { printf("line %d\\n", i); Delay_sec(0.01); } }\n'


def large() -> str:
    """A program of more than 50 KB."""
    words = ", ".join(str(number * 2654435761 % 2**31) for number in range(13000))
    body = "main() { int i; unsigned sum = 0; for (i = 0; i < 13000; i++) sum += table[i]; printf(\"sum %u\\n\", sum); }\n"
    return f'#include "KMotionDef.h"\nint table[] = {{{words}}};\n{body}'


SUM = sum(number * 2654435761 % 2**31 for number in range(13000)) % 2**32

# What each trial of the guest must print, as regular expressions, and its status.
EXPECTED = [
    (r"cc67 boards", [r"usb:\d+-\d+", r"KFLOP", r"KF000067"], 0),
    (r"hello\.c", [r"hello 42$"], 0),
    (r"large\.c", [rf"sum {SUM}$"], 0),
    (r"Version", [r"^KFLOP 4\.34", r"^42$", r"invalid command"], 0),
    (r"counts\.c", [r"\$1 = [1-9]\d+"], 0),
    (r"nobody", [r"permission|SUBSYSTEM"], 2),
    (r"hello\.c", [r"another program"], 2),
    (r"tail", [r"disconnected"], 0),
    (r"hello\.c", [r"no board on USB"], 2),
    (r"hello\.c", [r"hello 42$"], 0),
    (r"serial:.*hello\.c", [r"hello 42$"], 0),
    (r"hello\.c", [r"hello 42$"], 0),
    (r"end", [], None),
]


def kernel(linux: Path) -> bytes:
    """The kernel; without its compression where that is xz: QEMU takes it as it is, and the guest need not undo it."""
    image = next(linux.glob("boot/vmlinuz-*")).read_bytes()
    at = image.find(b"\xfd7zXZ\0")
    return image if at < 0 else lzma.LZMADecompressor().decompress(image[at:])


def module(linux: Path, name: str) -> bytes | None:
    """A module of the kernel; None if it is built in."""
    found = next(linux.rglob(f"drivers/{name}.ko*"), None)
    if found is None:
        return None
    if found.suffix == ".zst":
        return subprocess.run(["zstd", "-dc", found], capture_output=True, check=True).stdout
    data = found.read_bytes()
    return lzma.decompress(data) if found.suffix == ".xz" else data


def libraries(program: Path) -> list[Path]:
    """The shared libraries of a program."""
    listed = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    return [Path(found) for found in re.findall(r"(/\S+) \(0x", listed)]


def initramfs(root: Path, cc67: Path, linux: Path) -> bytes:
    """The files of the guest."""
    for folder in ["bin", "dev", "proc", "sys", "tmp", "mod", "programs", "etc"]:
        (root / folder).mkdir()
    (root / "tmp").chmod(0o777)
    shutil.copy("/bin/busybox", root / "bin/busybox")
    (root / "bin/sh").symlink_to("busybox")
    shutil.copy(cc67, root / "bin/cc67")
    for library in libraries(cc67):
        place = root / str(library).lstrip("/")
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(library, place)
    for name in MODULES:
        if data := module(linux, name):
            (root / "mod" / f"{Path(name).name}.ko").write_bytes(data)
    sources = {"hello.c": HELLO, "large.c": large(), "counts.c": COUNTS, "prints.c": PRINTS}
    for name, text in sources.items():
        (root / "programs" / name).write_text(text)
    (root / "etc/passwd").write_text("root::0:0::/:/bin/sh\nnobody::65534:65534::/:/bin/sh\n")
    (root / "etc/group").write_text("root::0:\nnogroup::65534:\n")
    shutil.copy(HERE / "init", root / "init")
    (root / "init").chmod(0o755)
    names = subprocess.run(["find", "."], cwd=root, capture_output=True, check=True).stdout
    packed = subprocess.run(["cpio", "-o", "-H", "newc"], cwd=root, input=names, capture_output=True, check=True)
    return gzip.compress(packed.stdout, 1)


async def board(cc67: Path, folder: Path) -> tuple[asyncio.subprocess.Process, tuple[str, int]]:
    """The simulated board behind the chip."""
    process = await asyncio.create_subprocess_exec(
        cc67, "serve", "--listen", "tcp-raw:0", cwd=folder, stderr=asyncio.subprocess.PIPE
    )
    assert process.stderr
    line = (await process.stderr.readline()).decode()
    host, port = line.split()[-1].removeprefix("tcp:").rsplit(":", 1)
    return process, (host, int(port))


async def guest(folder: Path, port: int) -> asyncio.subprocess.Process:
    """The virtual machine."""
    words = f"""qemu-system-x86_64 -M pc -m 256 -nodefaults -no-user-config -display none -serial stdio -no-reboot
        -kernel {folder}/kernel -initrd {folder}/init.gz -device qemu-xhci,id=u -accel tcg
        -chardev socket,id=r,host=127.0.0.1,port={port} -device usb-redir,chardev=r,id=board,bus=u.0""".split()
    append = "console=ttyS0 quiet panic=-1 no_timer_check mitigations=off"
    return await asyncio.create_subprocess_exec(
        *words, "-append", append, stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE
    )


async def trials(cc67: Path, linux: Path, folder: Path) -> list[str]:
    """Runs the guest, and returns its lines."""
    (folder / "kernel").write_bytes(kernel(linux))
    (folder / "root").mkdir()
    (folder / "init.gz").write_bytes(initramfs(folder / "root", cc67, linux))
    served, address = await board(cc67, folder)
    chips: list[Chip] = []

    async def connected(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        chip = Chip(writer, address)
        chips.append(chip)
        chip.hello()
        await chip.plug()
        await chip.serve(reader)

    server = await asyncio.start_server(connected, "127.0.0.1", 0)
    machine = await guest(folder, server.sockets[0].getsockname()[1])
    begin, lines = time.monotonic(), []
    assert machine.stdout
    try:
        while line := await asyncio.wait_for(machine.stdout.readline(), LIMIT):
            text = line.decode(errors="replace").rstrip()
            print(f"{time.monotonic() - begin:6.1f} {text}", flush=True)
            lines.append(text)
            if text.startswith("host: unplug"):
                await chips[0].unplug()
            elif text.startswith("host: plug"):
                await chips[0].plug()
    finally:
        for process in (machine, served):
            if process.returncode is None:
                process.kill()
            await process.wait()
    order = [request for request in chips[0].requests[:5]]
    assert order == [(0, 0), (9, 2), (6, 0x010A), (0, 1), (0, 2)], f"the requests to the chip: {order}"
    return lines


def wrong(lines: list[str]) -> list[str]:
    """What is not as expected."""
    parts: list[tuple[str, list[str]]] = []
    for line in lines:
        if line.startswith("trial: "):
            parts.append((line, []))
        elif parts:
            parts[-1][1].append(line)
    found = []
    if len(parts) != len(EXPECTED):
        found.append(f"{len(parts)} trials in place of {len(EXPECTED)}")
    for (title, text), (name, patterns, status) in zip(parts, EXPECTED):
        missing = [pattern for pattern in patterns if not any(re.search(pattern, line) for line in text)]
        if not re.search(name, title) or missing or status is not None and f"status: {status}" not in text:
            found.append(f"{title}: expected {patterns}, status {status}")
    return found


def main() -> int:
    cc67, linux = (Path(argument).resolve() for argument in sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        lines = asyncio.run(trials(cc67, linux, Path(folder)))
    problems = wrong(lines)
    print("\n".join(problems) or f"{len(EXPECTED) - 1} trials at USB are as expected")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
