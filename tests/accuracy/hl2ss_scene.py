"""A simulated scene with ground truth, played by hl2ss_server.py in real time, and the figures of a
run that tracked it: error, coverage and age at the output, and each frame's pose."""
import csv
import dataclasses
import math
import mmap
import statistics
import struct
import subprocess

import frame_formats as formats
import hl2ss_server

RATE_HZ = hl2ss_server.RATE_HZ
CHI2_3_95 = 7.814727903251179  # 95 % of 3 degrees of freedom


def read_tum(path):
    rows = [[float(v) for v in line.split()] for line in path.read_text().splitlines()
            if not line.startswith("#")]
    return [(row[1:4], row[4:8]) for row in rows]


def with_poses(packets, heads):
    """The packets with the headset's poses."""
    assert len(packets) == len(heads), (len(packets), len(heads))
    return [dataclasses.replace(p, pose=struct.pack("<16f", *formats.row_vectors(formats.rig_pose(h))))
            for p, h in zip(packets, heads)]


def make(glint, work, seconds, camera=""):
    """(packets, truth) of a simulated pen; `truth` by frame: (tip, quaternion x y z w)."""
    cell, out = work / "scene.toml", work / "scene"
    cell.write_text(f'tools = ["pen"]\n[camera]\n{camera}[simulator]\nduration_s = {seconds}\n')
    subprocess.run([glint, "simulate", "--config", cell, "--out", out, "--frame-files", "1"],
                   check=True, stdout=subprocess.DEVNULL)
    head, truth = read_tum(out / "localised_head.tum"), read_tum(out / "truth_tool.tum")
    packets = with_poses(hl2ss_server.read_folder(out), head)
    assert len(packets) == len(truth), (len(packets), len(truth))
    return packets, truth


def truth_at(truth, seconds):
    """Tip and rotation between two frames of the scene, which runs forwards and backwards."""
    last = len(truth) - 1
    at = (seconds * RATE_HZ) % (2 * last)
    at = at if at <= last else 2 * last - at
    i = min(int(at), last - 1)
    part = at - i
    (a, qa), (b, qb) = truth[i], truth[i + 1]
    sign = 1 if sum(x * y for x, y in zip(qa, qb)) >= 0 else -1
    q = [(1 - part) * x + sign * part * y for x, y in zip(qa, qb)]
    norm = math.sqrt(sum(v * v for v in q))
    return [(1 - part) * x + part * y for x, y in zip(a, b)], [v / norm for v in q]


def rotation_error(found, true):
    """Rotation vector of found * true^-1, quaternions x y z w."""
    x, y, z, w = found
    a, b, c, d = -true[0], -true[1], -true[2], true[3]
    vector = [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
              w * c + x * b - y * a + z * d]
    real = w * d - x * a - y * b - z * c
    sine = math.sqrt(sum(v * v for v in vector))
    angle = 2 * math.atan2(sine, abs(real))
    sign = 1 if real >= 0 else -1
    return [sign * v * (angle / sine if sine > 1e-12 else 2.0) for v in vector]


def mahalanobis2(error, m):
    """error' m^-1 error of a symmetric 3 x 3 matrix, by its cofactors."""
    c = [[m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
          m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3] for j in range(3)]
         for i in range(3)]
    det = sum(m[0][j] * c[0][j] for j in range(3))
    return sum(error[i] * c[i][j] * error[j] for i in range(3) for j in range(3)) / det


def session_begin_ns(recording):
    """Unix time of session time 0, as the recording's metadata state it."""
    with open(recording, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        at = data.find(b"unix_offset_ns") + len(b"unix_offset_ns")
        size, = struct.unpack_from("<I", data, at)
        return int(data[at + 4:at + 4 + size])


@dataclasses.dataclass
class Figures:
    ticks: int
    tip_rms_mm: float
    sigma_mm: float       # stated, root of the covariance's trace
    tip_inside: float     # of the errors inside the 95 % ellipsoid
    rotation_inside: float
    age_ms: float         # median
    age_max_ms: float

    def __str__(self):
        return (f"{self.ticks} ticks, tip {self.tip_rms_mm:.2f} mm rms, stated {self.sigma_mm:.2f}, "
                f"inside 95 %: tip {100 * self.tip_inside:.0f} %, rotation "
                f"{100 * self.rotation_inside:.0f} %, age {self.age_ms:.1f} ms, at most "
                f"{self.age_max_ms:.1f}")


def figures(samples, truth, scene_begin_s, state):
    """Of the ticks of that state; `scene_begin_s`: session time of the scene's first frame."""
    squares, inside, turned, ages, traces = [], 0, 0, [], []
    with open(samples) as file:
        for row in csv.DictReader(file):
            if row["state"] != state or row["frame"] != "world":
                continue
            tip, q = truth_at(truth, float(row["tick_s"]) - scene_begin_s)
            error = [float(row[k]) - t for k, t in zip(("x_m", "y_m", "z_m"), tip)]
            turn = rotation_error([float(row[k]) for k in ("qx", "qy", "qz", "qw")], q)
            c = [[float(row[f"c{i}{j}"]) for j in range(1, 7)] for i in range(1, 7)]
            squares.append(sum(e * e for e in error))
            traces.append(c[0][0] + c[1][1] + c[2][2])
            inside += mahalanobis2(error, [r[:3] for r in c[:3]]) <= CHI2_3_95
            turned += mahalanobis2(turn, [r[3:] for r in c[3:]]) <= CHI2_3_95
            ages.append(1000 * (float(row["tick_s"]) - float(row["measurement_s"])))
    n = len(squares)
    if n == 0:
        return Figures(0, math.inf, 0, 0, 0, math.inf, math.inf)
    return Figures(n, 1000 * math.sqrt(sum(squares) / n), 1000 * math.sqrt(statistics.mean(traces)),
                   inside / n, turned / n, statistics.median(ages), max(ages))


def frame_poses(glint, recording, work):
    """Rows of `glint export csv`: one of each recorded frame."""
    path = work / "frames.csv"
    subprocess.run([glint, "export", "csv", recording, "--tool", "pen", "--out", path], check=True,
                   stdout=subprocess.DEVNULL)
    with open(path) as file:
        return list(csv.DictReader(file))
