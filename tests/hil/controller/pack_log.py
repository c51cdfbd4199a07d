#!/usr/bin/env python3
"""pack_log.py CAN_LOG BASE fd|classic CYCLE_US SPEED_MAX OUT: a candump log as follow_log reads it.

Little endian. Settings: base u32, fd u8, 3 bytes 0, cycle u32 [us], speed u32 [mm/s]. A frame: time
u64 [us], identifier u32, fd u8, length u8, 2 bytes 0, data padded to 8 bytes. The last frame has the
identifier 0xFFFFFFFF and no data; its time is a second after the last real one.
"""
import re
import struct
import sys

LINE = re.compile(r"\((\d+)\.(\d{6})\) \S+ ([0-9A-F]{3}|[0-9A-F]{8})#(#[0-9A-F])?([0-9A-F]*)$")


def main() -> int:
    log, base, kind, cycle, speed, out = sys.argv[1:]
    packed = struct.pack("<IB3xII", int(base, 0), kind == "fd", int(cycle), int(speed))
    last = 0
    with open(log, encoding="ascii") as lines:
        for number, line in enumerate(lines, 1):
            match = LINE.match(line.strip())
            if not match:
                print(f"{log}:{number}: not a line of candump -L", file=sys.stderr)
                return 2
            data = bytes.fromhex(match[5])
            last = int(match[1]) * 1_000_000 + int(match[2])
            packed += struct.pack("<QIBBxx", last, int(match[3], 16), match[4] is not None,
                                  len(data))
            packed += data + bytes(-len(data) % 8)
    packed += struct.pack("<QIBBxx", last + 1_000_000, 0xFFFFFFFF, 0, 0)
    with open(out, "wb") as file:
        file.write(packed)
    return 0


if __name__ == "__main__":
    sys.exit(main())
