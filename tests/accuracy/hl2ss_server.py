#!/usr/bin/env python3
"""Stand-in for the hl2ss server of a HoloLens 2: AHAT raw or long throw, its calibration, the remote
configuration.

  tests/accuracy/hl2ss_server.py RECORDING_OR_FOLDER --rate 45 --calibration ahat.bin

Written from the wire format of hl2ss 9a70fad; it shares no code with Glint. Little endian.
A connection of the stream sends a configuration. Mode 2 returns the calibration, modes 0 and 1 a
packet a frame: u64 stamp (QPC, 100 ns), u32 size, payload, and in mode 1 a pose of 16 floats.
One client at a time. Faults are planted by the number of the packet: KIND@NUMBER.
"""
import argparse
import array
import dataclasses
import pathlib
import random
import re
import socket
import struct
import sys
import threading
import time

import frame_formats as formats

SIDE = 512
PLANE_BYTES = 2 * SIDE * SIDE
PACKET_BYTES = 12 + 8 + 2 * PLANE_BYTES + 8 + 64
CALIBRATION_BYTES = 4 * (4 * SIDE * SIDE + 16 + 2 + 4)
RATE_HZ = 45
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
FAULTS = ("stall", "silence", "cut", "half", "doubled", "backward", "wrong_size", "wrong_blob",
          "oversize", "empty", "no_pose")


@dataclasses.dataclass
class Packet:
    stamp: int      # 100 ns
    payload: bytes
    pose: bytes     # of mode 1: 64 bytes

    def on_wire(self, with_pose=True):
        return (struct.pack("<QI", self.stamp, len(self.payload)) + self.payload +
                (self.pose if with_pose else b""))


def ahat_payload(depth, ab, ticks):
    """Of two planes as bytes; raw mode has no blob of z of its own."""
    return struct.pack("<II", 0, len(depth) + len(ab)) + depth + ab + struct.pack("<Q", ticks)


def long_throw_payload(depth, ab, width, height, ticks):
    """The planes' bytes as blue, green, red and alpha of a PNG image."""
    planes = bytearray(depth + ab)
    planes[0::4], planes[2::4] = planes[2::4], planes[0::4]  # a PNG's order is red, green, blue
    return formats.png_rgba(width, height, bytes(planes)) + struct.pack("<Q", ticks)


def read_recording(path):
    """(configuration, packets) of a file HL2SSV23 of port 3804 with poses."""
    data = path.read_bytes()
    port, user = struct.unpack_from("<HI", data, 8)
    if data[:8] != b"HL2SSV23" or port != 3804:
        sys.exit(f"{path}: not a recording of AHAT by hl2ss 23")
    at = 14 + user
    configuration = data[at:at + 10 + 16 * data[at + 9]]
    at += len(configuration)
    pose_bytes = 64 if configuration[0] == 1 else 0
    packets = []
    while at < len(data):
        stamp, size = struct.unpack_from("<QI", data, at)
        at += 12
        packets.append(Packet(stamp, data[at:at + size], data[at + size:at + size + pose_bytes]))
        at += size + pose_bytes
    return configuration, packets


def plane_of_pgm(path):
    data = path.read_bytes()
    head = re.match(rb"P5\s+(\d+)\s+(\d+)\s+65535\s", data)
    values = array.array("H", data[head.end():])  # big endian
    if sys.byteorder == "little":
        values.byteswap()
    return values.tobytes()


def read_folder(folder):
    """A frame from each NAME.bin (depth, then AB), or each pair NAME.pgm and NAME_ab.pgm."""
    planes = [path.read_bytes() for path in sorted(folder.glob("*.bin"))]
    planes += [plane_of_pgm(path.with_name(path.name.replace("_ab.pgm", ".pgm"))) + plane_of_pgm(path)
               for path in sorted(folder.glob("*_ab.pgm"))]
    return [Packet(i * 10_000_000 // RATE_HZ,
                   ahat_payload(both[:PLANE_BYTES], both[PLANE_BYTES:], 1_385_454 * i),
                   struct.pack("<16f", *IDENTITY)) for i, both in enumerate(planes)]


@dataclasses.dataclass
class Play:
    rate_hz: float | None = RATE_HZ  # None: the stamps' own spacing
    count: int | None = None         # packets; None: without an end, from the first again
    jitter_ms: tuple = (0.0, 0.0)    # delay of each packet after its exposure, uniform
    latency_ms: float = 9.0          # from the stamp to the first byte, at least
    faults: dict = dataclasses.field(default_factory=dict)  # kind by the packet's number
    stall_s: float = 0.6
    silence_s: float = 3.0
    random_seed: int = 1
    stamps_begin: int = 36_000_000_000  # QPC at the first packet: an hour after the device's start
    clock_offset: int = 133_800_000_000_000_000  # FILETIME - QPC
    long_throw: bool = False  # the stream's configuration: mode, divisor, u32 PNG filter
    scene: bool = False  # the packets are a scene at RATE_HZ: chosen by time, forwards and backwards


@dataclasses.dataclass
class Sent:
    number: int
    stamp: int       # as sent
    kind: str | None  # of the fault
    exposure_ns: int  # of the pixels, on this machine's monotonic clock
    at_ns: int       # likewise, after the last byte; of a fault before the first


def with_fault(packet, kind, before):
    """The bytes sent instead of the packet; `before`: stamp of the one before."""
    if kind == "doubled":
        packet = dataclasses.replace(packet, stamp=before)
    elif kind == "backward":
        packet = dataclasses.replace(packet, stamp=before - 50_000)
    elif kind == "empty":
        packet = dataclasses.replace(packet, payload=ahat_payload(b"", b"", 0))
    elif kind == "wrong_size":  # the frame of a smaller sensor
        packet = dataclasses.replace(packet, payload=ahat_payload(bytes(184_320), bytes(184_320), 0))
    elif kind == "wrong_blob":  # blobs that do not fill the payload
        packet = dataclasses.replace(
            packet, payload=struct.pack("<II", 7, 0xFFFFFFF0) + packet.payload[8:])
    elif kind == "no_pose":
        packet = dataclasses.replace(packet, pose=packet.pose[:60] + bytes(4))
    wire = packet.on_wire()
    if kind == "oversize":
        wire = wire[:8] + b"\xff\xff\xff\xff" + wire[12:]
    return wire[:len(wire) // 2] if kind == "half" else wire


class Server:
    """Serves until close(). `configurations` and `sent` record what the client did and received.

    Counts and faults begin with packet `begin`; None: good packets without an end, until it is set.
    """

    def __init__(self, packets, calibration=b"", play=None, port=0, remote_port=0, begin=0):
        self.begin = begin
        self.packets, self.calibration, self.play = packets, calibration, play or Play()
        self.random = random.Random(self.play.random_seed)
        self.configurations, self.sent, self.number = [], [], 0
        self.finished = threading.Event()
        self.closing = threading.Event()
        self.due_ns = self.first_ns = None
        self.stream, self.remote = (self.listen(one) for one in (port, remote_port))
        self.port, self.remote_port = (s.getsockname()[1] for s in (self.stream, self.remote))
        self.threads = [threading.Thread(target=self.serve, args=of, daemon=True)
                        for of in ((self.stream, self.send_stream), (self.remote, self.answer))]
        for thread in self.threads:
            thread.start()

    @staticmethod
    def listen(port):
        listener = socket.socket()
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(("127.0.0.1", port))
        listener.listen(1)
        listener.settimeout(0.05)
        return listener

    def serve(self, listener, use):
        while not self.closing.is_set():
            try:
                client, _ = listener.accept()
            except TimeoutError:
                continue
            with client:
                client.settimeout(30)
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                try:
                    use(client)
                except OSError:  # the client has closed
                    pass

    @staticmethod
    def receive(client, count):
        data = b""
        while len(data) < count:
            part = client.recv(count - len(data))
            if not part:
                raise ConnectionResetError
            data += part
        return data

    def answer(self, client):
        while self.receive(client, 1) == b"\x01":
            client.sendall(struct.pack("<Q", self.play.clock_offset))

    def send_stream(self, client):
        configuration = self.receive(client, 1)
        if configuration == b"\x02":
            self.configurations.append(configuration)
            client.sendall(self.calibration)
            return
        if self.play.long_throw:
            configuration += self.receive(client, 5)
        else:
            configuration += self.receive(client, 9)
            configuration += self.receive(client, 16 * configuration[9])
        self.configurations.append(configuration)
        while not self.closing.is_set():
            if None not in (self.play.count, self.begin) and self.number - self.begin >= self.play.count:
                self.finished.set()
                self.closing.wait(0.05)
                continue
            if not self.send_packet(client, configuration[0] == 1, max(1, configuration[1])):
                return

    def exposure_ns(self, divisor):
        """When the next packet's exposure is, on this machine's clock; a busy one exposes later."""
        now = time.monotonic_ns()
        if self.play.rate_hz is None:
            self.first_ns = self.first_ns or now
            stamps = self.packets[self.number % len(self.packets)].stamp, self.packets[0].stamp
            return self.first_ns + 100 * (stamps[0] - stamps[1])
        period = int(1e9 * divisor / self.play.rate_hz)
        self.first_ns = self.first_ns or now
        self.due_ns = now if self.due_ns is None else max(self.due_ns + period, now)
        return self.due_ns

    def packet_at(self, exposure):
        """(packet, its exposure): of a scene the frame nearest in time."""
        if not self.play.scene:
            return self.packets[self.number % len(self.packets)], exposure
        step = round((exposure - self.first_ns) * RATE_HZ / 1e9)
        last = len(self.packets) - 1
        index = step % (2 * last)
        return (self.packets[index if index <= last else 2 * last - index],
                self.first_ns + step * 1_000_000_000 // RATE_HZ)

    def send_packet(self, client, with_pose, divisor):
        """False: the connection ends here."""
        number, play = self.number, self.play
        kind = None if self.begin is None else play.faults.get(number - self.begin)
        packet, exposure = self.packet_at(self.exposure_ns(divisor))
        delay_ms = play.latency_ms + self.random.uniform(*play.jitter_ms)
        self.closing.wait(max(0, exposure + 1e6 * delay_ms - time.monotonic_ns()) * 1e-9)
        self.number += divisor if play.rate_hz is None else 1
        if kind in ("cut", "stall", "silence"):
            self.sent.append(Sent(number, 0, kind, exposure, time.monotonic_ns()))
            self.closing.wait({"cut": 0, "stall": play.stall_s, "silence": play.silence_s}[kind])
            return kind != "cut"
        stamp = play.stamps_begin + (exposure - self.first_ns) // 100
        before = next((s.stamp for s in reversed(self.sent) if s.stamp), stamp)
        packet = dataclasses.replace(packet, stamp=stamp, pose=packet.pose if with_pose else b"")
        sent = Sent(number, stamp if kind not in ("doubled", "backward") else before, kind, exposure,
                    time.monotonic_ns())
        if kind is not None:  # the client may end the connection meanwhile
            self.sent.append(sent)
        client.sendall(with_fault(packet, kind, before))
        if kind is None:
            self.sent.append(dataclasses.replace(sent, at_ns=time.monotonic_ns()))
        return kind != "half"

    def close(self):
        self.closing.set()
        for thread in self.threads:
            thread.join(timeout=40)
        self.stream.close()
        self.remote.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("source", type=pathlib.Path, help="recording of hl2ss, or folder of frames")
    parser.add_argument("--port", type=int, default=3804)
    parser.add_argument("--remote-port", type=int, default=3809)
    parser.add_argument("--rate", type=float, default=RATE_HZ, help="Hz; 0: the recording's spacing")
    parser.add_argument("--jitter-ms", type=float, nargs=2, default=(0.0, 0.0))
    parser.add_argument("--calibration", type=pathlib.Path)
    parser.add_argument("--count", type=int, help="packets; default: no end")
    parser.add_argument("--fault", action="append", default=[], metavar="KIND@NUMBER",
                        help=", ".join(FAULTS))
    options = parser.parse_args()
    faults = {}
    for text in options.fault:
        kind, _, number = text.partition("@")
        if kind not in FAULTS or not number.isdigit():
            parser.error(f"--fault {text}: expected KIND@NUMBER, KIND of {', '.join(FAULTS)}")
        faults[int(number)] = kind
    packets = (read_folder(options.source) if options.source.is_dir()
               else read_recording(options.source)[1])
    calibration = options.calibration.read_bytes() if options.calibration else b""
    server = Server(packets, calibration,
                    Play(options.rate or None, options.count, tuple(options.jitter_ms), faults=faults),
                    options.port, options.remote_port)
    print(f"AHAT on 127.0.0.1:{server.port}, remote configuration on {server.remote_port}", flush=True)
    try:
        server.finished.wait()
    except KeyboardInterrupt:
        pass
    server.close()


if __name__ == "__main__":
    main()
