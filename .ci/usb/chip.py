"""The controller's USB chip as a usb-redir device for QEMU: an FT245R with its identifiers, strings and packets.

The bytes behind it are those of a TCP connection, such as `cc67 serve --listen tcp-raw:PORT`.
"""

from __future__ import annotations

import asyncio
import struct
from dataclasses import dataclass

VENDOR, PRODUCT, RELEASE = 0x0403, 0xF231, 0x0600
STRINGS = ["Dynomotion", "KFLOP - Motion Controller", "KF000067"]
IN, OUT = 0x81, 0x02
PACKET = 64
STATUS = b"\x01\x60"

# Packets of the usb-redir protocol.
HELLO, CONNECT, DISCONNECT, RESET, INTERFACES, ENDPOINTS = 0, 1, 2, 3, 4, 5
SET_CONFIGURATION, GET_CONFIGURATION, CONFIGURATION = 6, 7, 8
SET_ALTERNATE, GET_ALTERNATE, ALTERNATE = 9, 10, 11
CANCEL, CONTROL, BULK = 21, 100, 101
CAPABILITIES = 1 << 1 | 1 << 4 | 1 << 5 | 1 << 6
SUCCESS, CANCELLED, STALL = 0, 1, 4


def descriptors() -> dict[tuple[int, int], bytes]:
    """The descriptors by type and index."""
    device = struct.pack(
        "<BBHBBBBHHHBBBB", 18, 1, 0x0200, 0, 0, 0, 8, VENDOR, PRODUCT, RELEASE, 1, 2, 3, 1
    )
    interface = struct.pack("<BBBBBBBBB", 9, 4, 0, 0, 2, 255, 255, 255, 2)
    endpoints = [struct.pack("<BBBBHB", 7, 5, address, 2, PACKET, 0) for address in (IN, OUT)]
    body = interface + b"".join(endpoints)
    configuration = struct.pack("<BBHBBBBB", 9, 2, 9 + len(body), 1, 1, 0, 0x80, 250) + body
    found = {(1, 0): device, (2, 0): configuration, (3, 0): b"\x04\x03\x09\x04"}
    for index, text in enumerate(STRINGS, 1):
        letters = text.encode("utf-16-le")
        found[3, index] = bytes([2 + len(letters), 3]) + letters
    return found


def packets(data: bytes) -> bytes:
    """A transfer of the chip: two status bytes before every 62 bytes of data."""
    parts = [data[at : at + PACKET - 2] for at in range(0, len(data), PACKET - 2)] or [b""]
    return b"".join(STATUS + part for part in parts)


@dataclass
class Read:
    """A read of the guest that was not answered yet."""

    number: int
    length: int
    stream: int
    is_wanted: bool = True


class Chip:
    """The chip: QEMU at one side, the bytes of the board at the other."""

    def __init__(self, qemu: asyncio.StreamWriter, board: tuple[str, int]) -> None:
        self.qemu = qemu
        self.address = board
        self.board: asyncio.StreamWriter | None = None
        self.descriptors = descriptors()
        self.latency = 0.016
        self.fresh = bytearray()
        self.arrived = asyncio.Event()
        self.reads: asyncio.Queue[Read] = asyncio.Queue()
        self.open_reads: dict[int, Read] = {}
        self.requests: list[tuple[int, int]] = []
        self.tasks: list[asyncio.Task[None]] = []

    def send(self, kind: int, number: int, body: bytes) -> None:
        head = struct.pack("<II", kind, len(body))
        self.qemu.write(head + struct.pack("<I" if kind == HELLO else "<Q", number) + body)

    def hello(self) -> None:
        self.send(HELLO, 0, b"cc67 trial".ljust(64, b"\0") + struct.pack("<I", CAPABILITIES))

    async def plug(self) -> None:
        """Power for the board, and the device for the guest."""
        reader, self.board = await asyncio.open_connection(*self.address)
        self.fresh.clear()
        self.tasks = [asyncio.create_task(self.hear(reader)), asyncio.create_task(self.answer())]
        one = lambda value: bytes([value]) + bytes(31)
        self.send(INTERFACES, 0, struct.pack("<I", 1) + bytes(32) + one(255) + one(255) + one(255))
        types = bytearray([255] * 32)
        types[0] = types[16] = 0
        types[OUT] = types[16 + (IN & 15)] = 2
        sizes = struct.pack("<32H", *[PACKET if kind == 2 else 8 for kind in types])
        self.send(ENDPOINTS, 0, bytes(types) + bytes(32) + bytes(32) + sizes)
        self.send(CONNECT, 0, struct.pack("<BBBBHHH", 1, 0, 0, 0, VENDOR, PRODUCT, RELEASE))

    async def unplug(self) -> None:
        """The cable comes out, and the board loses its power."""
        self.send(DISCONNECT, 0, b"")
        for task in self.tasks:
            task.cancel()
        if self.board:
            self.board.close()
        self.board, self.latency = None, 0.016
        self.reads, self.open_reads = asyncio.Queue(), {}

    async def hear(self, reader: asyncio.StreamReader) -> None:
        while data := await reader.read(4096):
            self.fresh += data
            self.arrived.set()

    async def answer(self) -> None:
        """Answers reads: with what has come, or with the status alone after the latency time."""
        while True:
            read = await self.reads.get()
            if not self.fresh and read.is_wanted:
                self.arrived.clear()
                try:
                    await asyncio.wait_for(self.arrived.wait(), self.latency)
                except asyncio.TimeoutError:
                    pass
            if not read.is_wanted:
                continue
            del self.open_reads[read.number]
            room = max(read.length // PACKET, 1) * (PACKET - 2)
            data, self.fresh = bytes(self.fresh[:room]), self.fresh[room:]
            self.bulk(read.number, IN, read.stream, packets(data))

    def bulk(self, number: int, endpoint: int, stream: int, data: bytes, status: int = SUCCESS) -> None:
        head = struct.pack("<BBHIH", endpoint, status, len(data) & 0xFFFF, stream, len(data) >> 16)
        self.send(BULK, number, head + data)

    async def serve(self, reader: asyncio.StreamReader) -> None:
        """Takes packets until QEMU ends."""
        is_first = True
        while True:
            try:
                kind, length = struct.unpack("<II", await reader.readexactly(8))
                number = struct.unpack("<I" if is_first else "<Q", await reader.readexactly(4 if is_first else 8))[0]
                body = await reader.readexactly(length)
            except (asyncio.IncompleteReadError, ConnectionError):
                return
            is_first = False
            await self.take(kind, number, body)

    async def take(self, kind: int, number: int, body: bytes) -> None:
        if kind == SET_CONFIGURATION:
            self.send(CONFIGURATION, number, bytes([SUCCESS, body[0]]))
        elif kind == GET_CONFIGURATION:
            self.send(CONFIGURATION, number, bytes([SUCCESS, 1]))
        elif kind == SET_ALTERNATE:
            self.send(ALTERNATE, number, bytes([SUCCESS, *body[:2]]))
        elif kind == GET_ALTERNATE:
            self.send(ALTERNATE, number, bytes([SUCCESS, body[0], 0]))
        elif kind == CONTROL:
            self.control(number, body)
        elif kind == BULK:
            endpoint, _, low, stream, high = struct.unpack("<BBHIH", body[:10])
            if endpoint == IN:
                read = Read(number, low | high << 16, stream)
                self.open_reads[number] = read
                await self.reads.put(read)
            elif self.board:
                self.board.write(body[10:])
                await self.board.drain()
                head = struct.pack("<BBHIH", OUT, SUCCESS, low, stream, high)
                self.send(BULK, number, head)
        elif kind == CANCEL:
            read = self.open_reads.pop(number, None)
            if read:
                read.is_wanted = False
                self.bulk(number, IN, read.stream, b"", CANCELLED)

    def control(self, number: int, body: bytes) -> None:
        endpoint, request, direction, _, value, index, length = struct.unpack("<BBBBHHH", body[:10])
        data, status = b"", SUCCESS
        if direction == 0x80 and request == 6:
            found = self.descriptors.get((value >> 8, value & 0xFF))
            data, status = (found[:length], SUCCESS) if found else (b"", STALL)
        elif direction == 0x80 and request == 0:
            data = b"\0\0"
        elif direction == 0xC0 and request == 0x0A:
            data = bytes([int(self.latency * 1000)])
        elif direction == 0x40:
            self.requests.append((request, value))
            if request == 9:
                self.latency = value / 1000
            if (request, value) == (0, 1):
                self.fresh.clear()
        head = struct.pack("<BBBBHHH", endpoint, request, direction, status, value, index, len(data))
        self.send(CONTROL, number, head + data)
