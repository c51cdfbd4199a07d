#!/usr/bin/env python3
"""pack_log.py CAN_LOG BASE fd|classic CYCLE_US SPEED_MAX OUT [EVENTS]: a log as follow_log reads it.

CAN_LOG: `candump -L`. EVENTS: lines of a time in microseconds and `first cycle`, `enable`, `restart` or
`end`. Without EVENTS the first frame's time is the first cycle's, a person enables 25 cycles after
each stop, and the log ends a second after the last frame.

Little endian. Settings: base u32, fd u8, cycles until enabled u8, 2 bytes 0, cycle u32 [us], speed u32
[mm/s], first cycle u64 [us]. A frame: time u64 [us], identifier u32, fd u8, length u8, 2 bytes 0,
data padded to 8 bytes. An event is a frame without data; its identifier is 0xFFFFFF00 + its number.
"""
import re
import struct
import sys

LINE = re.compile(r"\((\d+)\.(\d{6})\) \S+ ([0-9A-F]{3}|[0-9A-F]{8})#(#[0-9A-F])?([0-9A-F]*)$")
EVENTS = {"end": 0, "enable": 1, "restart": 2}
ENABLE_CYCLES = 25


def frames_of(log):
    with open(log, encoding="ascii") as lines:
        for number, line in enumerate(lines, 1):
            match = LINE.match(line.strip())
            if not match:
                sys.exit(f"{log}:{number}: not a line of candump -L")
            data = bytes.fromhex(match[5])
            yield (int(match[1]) * 1_000_000 + int(match[2]), int(match[3], 16),
                   match[4] is not None, data)


def events_of(file):
    with open(file, encoding="ascii") as lines:
        return [(int(time), what) for time, what in (line.strip().split(" ", 1) for line in lines)]


def main() -> int:
    log, base, kind, cycle, speed, out = sys.argv[1:7]
    frames = list(frames_of(log))
    if len(sys.argv) > 7:
        events = events_of(sys.argv[7])
        enable_cycles = 0
        first = next(time for time, what in events if what == "first cycle")
    else:
        first, last = frames[0][0], frames[-1][0]
        events, enable_cycles = [(last + 1_000_000, "end")], ENABLE_CYCLES
    # Of equal times a frame comes first, as it does for the controller.
    frames += [(time, 0xFFFFFF00 + EVENTS[what], False, b"") for time, what in events
               if what in EVENTS]
    frames.sort(key=lambda frame: (frame[0], frame[1] >= 0xFFFFFF00))
    with open(out, "wb") as file:
        file.write(struct.pack("<IBB2xIIQ", int(base, 0), kind == "fd", enable_cycles, int(cycle),
                               int(speed), first))
        for time, identifier, fd, data in frames:
            file.write(struct.pack("<QIBBxx", time, identifier, fd, len(data)))
            file.write(data + bytes(-len(data) % 8))
    return 0


if __name__ == "__main__":
    sys.exit(main())
