"""A strokes file and its MCAP form have the same names, times, poses and covariances.

The MCAP records and their CDR payloads are decoded here, with the struct module alone.

    strokes_mcap.py GLINT
Exit 0: equal; 1: something differs.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile


def point(number):
    covariance = [0.0] * 36
    for i in range(6):
        covariance[7 * i] = (i + number) * 1e-6
    covariance[1] = covariance[6] = 1e-7
    return {"time_ns": 1_500_000_001 + 10 * number, "position_m": [0.1 * number, -0.2, 1 / 3],
            "rotation_xyzw": [0.5, -0.5, 0.5, 0.5], "covariance": covariance}


STROKES = {"format": "glint_strokes", "version": 1, "frame": "robot", "tool": "pen",
           "unix_offset_ns": 1_700_000_000_000_000_000,
           "elements": [{"name": "start", "kind": "waypoint", "points": [point(1)]},
                        {"name": "seam", "kind": "stroke", "points": [point(i) for i in range(40)]}]}


class Cdr:
    def __init__(self, data):
        assert data[:4] == bytes([0, 1, 0, 0]), data[:4]
        self.data, self.at = data[4:], 0

    def get(self, kind):
        size = struct.calcsize(kind)
        self.at += -self.at % size
        value = struct.unpack_from("<" + kind, self.data, self.at)[0]
        self.at += size
        return value

    def text(self):
        size = self.get("I")
        self.at += size
        return self.data[self.at - size:self.at - 1].decode()

    def header(self):
        seconds, nanoseconds = self.get("i"), self.get("I")
        return 1_000_000_000 * seconds + nanoseconds, self.text()


def stroke(cdr):
    assert cdr.header()[1] == "robot_base"
    found = {"name": cdr.text(), "kind": ("waypoint", "stroke")[cdr.get("B")], "points": []}
    for _ in range(cdr.get("I")):
        time, frame = cdr.header()
        assert frame == "robot_base"
        numbers = [cdr.get("d") for _ in range(43)]
        found["points"].append({"time_ns": time - STROKES["unix_offset_ns"],
                                "position_m": numbers[:3], "rotation_xyzw": numbers[3:7],
                                "covariance": numbers[7:]})
    assert cdr.at == len(cdr.data)
    return found


def strokes(data, at, end):
    while at + 9 <= end:
        kind, length = struct.unpack_from("<BQ", data, at)
        at += 9
        if kind == 5:
            yield stroke(Cdr(data[at + 22:at + length]))
        elif kind == 6:
            size = struct.unpack_from("<I", data, at + 28)[0]
            yield from strokes(data, at + 40 + size, at + length)
        at += length


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "a.json").write_text(json.dumps(STROKES))
        for out in ("b.json", "b.mcap"):
            subprocess.run([sys.argv[1], "path", folder / "a.json", "--program", folder / out],
                           check=True, stdout=subprocess.DEVNULL)
        again = json.loads((folder / "b.json").read_text())
        data = (folder / "b.mcap").read_bytes()
        recorded = list(strokes(data, 8, len(data) - 8))
        if again != STROKES or recorded != STROKES["elements"]:
            print(f"expected {STROKES}\nJSON {again}\nMCAP {recorded}")
            return 1
        print(f"{len(recorded)} elements agree")
        return 0


sys.exit(main())
