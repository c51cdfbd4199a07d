"""Frames in the formats of files and folders that `glint track` reads, written without Glint and
without a package; mcap_format.py writes bags and reads recordings.

A frame is a Frame: stamp in ns, planes of uint16 (array.array or numpy's), and the camera's pose in
the world as (position, quaternion x y z w), or None. `arrival_ns` follows the stamp by ARRIVAL_NS.
"""
import array
import csv
import dataclasses
import io
import math
import struct
import sys
import tarfile
import zlib

ARRIVAL_NS = 9_000_000          # exposure / 2 and transport of Glint's AHAT preset
FILE_TIME_OF_UNIX = 116_444_736_000_000_000
# Of Glint's AHAT preset: platform/formats/camera.cpp.
AHAT_LENS = """[camera]
lens = "rational"
width = 512
height = 512
fx_px = 253.247009763
fy_px = 253.582053183
cx_px = 258.754402348
cy_px = 254.752807282
k1_k2_p1_p2_k3_k4_k5_k6 = [0.483160358562, 0.192690496386, 0.000807326604142, -9.40674893651e-05,
  0.0138065295212, 0.815416536943, 0.289178608617, 0.0623515734461]
field_tangent = 1.7363
"""
# The camera on the rig: any rigid transform will do.
RIG_POSITION = (0.021, -0.034, 0.055)
RIG_QUATERNION = (0.1, -0.2, 0.05, math.sqrt(1 - 0.1**2 - 0.2**2 - 0.05**2))


@dataclasses.dataclass
class Frame:
    stamp_ns: int
    bright: array.array
    depth: array.array
    pose: tuple | None
    sequence: int = 0
    arrival_ns: int | None = None

    def arrives_ns(self):
        return self.stamp_ns + ARRIVAL_NS if self.arrival_ns is None else self.arrival_ns


# Rigid transforms as (rotation rows, position).

def matrix_of(q):
    x, y, z, w = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def times(a, b):
    """a after b."""
    (ra, pa), (rb, pb) = a, b
    rotation = tuple(tuple(sum(ra[i][k] * rb[k][j] for k in range(3)) for j in range(3))
                     for i in range(3))
    return rotation, tuple(sum(ra[i][k] * pb[k] for k in range(3)) + pa[i] for i in range(3))


def inverse(a):
    rotation, position = a
    back = tuple(zip(*rotation))
    return back, tuple(-sum(back[i][k] * position[k] for k in range(3)) for i in range(3))


def quaternion_of(rotation):
    """Of the largest component, as x y z w."""
    m = rotation
    squares = [1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
               1 - m[0][0] - m[1][1] + m[2][2], 1 + m[0][0] + m[1][1] + m[2][2]]
    i = max(range(4), key=lambda k: squares[k])
    s = math.sqrt(squares[i])
    d = 0.5 / s
    sums = {(0, 1): m[0][1] + m[1][0], (0, 2): m[0][2] + m[2][0], (1, 2): m[1][2] + m[2][1],
            (0, 3): m[2][1] - m[1][2], (1, 3): m[0][2] - m[2][0], (2, 3): m[1][0] - m[0][1]}
    return tuple(s / 2 if k == i else d * sums[(min(i, k), max(i, k))] for k in range(4))


RIG = (matrix_of(RIG_QUATERNION), RIG_POSITION)  # T_rig_camera


def rig_pose(pose):
    """T_world_rig of a camera's pose."""
    position, q = pose
    return times((matrix_of(q), position), inverse(RIG))


def row_major(transform):
    rotation, position = transform
    return [*rotation[0], position[0], *rotation[1], position[1], *rotation[2], position[2],
            0.0, 0.0, 0.0, 1.0]


def row_vectors(transform):
    """The same for p' = p M."""
    m = row_major(transform)
    return [m[4 * (i % 4) + i // 4] for i in range(16)]


# Pictures and arrays.

def pgm(width, height, values):
    swapped = array.array("H", values.tobytes())
    if sys.byteorder == "little":
        swapped.byteswap()
    return b"P5 %d %d 65535\n" % (width, height) + swapped.tobytes()


def npy(shape, values):
    text = "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }" % (shape,)
    text = text.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + values.tobytes()


def png_rgba(width, height, pixels):
    """`pixels`: red, green, blue, alpha; no filter."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    rows = b"".join(b"\0" + pixels[4 * width * y:4 * width * (y + 1)] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b""))


# Writers: of a list of frames of width x height pixels.

def write_folder(folder, width, height, frames):
    folder.mkdir()
    with open(folder / "frames.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow("time_ns arrival_ns sequence reflectivity depth x_m y_m z_m qx qy qz qw"
                        .split())
        for i, f in enumerate(frames):
            (folder / f"{i}_ab.pgm").write_bytes(pgm(width, height, f.bright))
            (folder / f"{i}.pgm").write_bytes(pgm(width, height, f.depth))
            pose = [repr(v) for v in (*f.pose[0], *f.pose[1])] if f.pose else [""] * 7
            writer.writerow([f.stamp_ns, f.arrives_ns(), f.sequence, f"{i}_ab.pgm", f"{i}.pgm",
                             *pose])
    return folder


def write_stream_recorder(folder, width, height, frames, rays=None):
    folder.mkdir()
    sensor = "Depth AHaT" if width == 512 else "Depth Long Throw"
    with tarfile.open(folder / f"{sensor}.tar", "w", format=tarfile.USTAR_FORMAT) as archive, \
            open(folder / f"{sensor}_rig2world.txt", "w") as poses:
        for f in frames:
            stamp = f.stamp_ns // 100 + FILE_TIME_OF_UNIX
            for name, values in ((f"{stamp}.pgm", f.depth), (f"{stamp}_ab.pgm", f.bright)):
                data = pgm(width, height, values)
                entry = tarfile.TarInfo(name)
                entry.size = len(data)
                archive.addfile(entry, io.BytesIO(data))
            if f.pose:
                numbers = row_major(rig_pose(f.pose))
                poses.write(",".join([str(stamp), *map(repr, numbers)]) + "\n")
    (folder / f"{sensor}_extrinsics.txt").write_text(
        ",".join(map(repr, row_major(inverse(RIG)))) + "\n")
    if rays is not None:
        (folder / f"{sensor}_lut.bin").write_bytes(rays.tobytes())
    return folder


def write_hl2ss(path, width, height, frames):
    """AHAT is raw; long throw has one PNG a frame, as the server sends them."""
    ahat = width == 512
    configuration = (struct.pack("<BBBBBIB", 1, 1, 0, 255, 255, 0, 0) if ahat else
                     struct.pack("<BBI", 1, 1, 0))
    user = b"by hand"
    with open(path, "wb") as file:
        file.write(b"HL2SSV23" + struct.pack("<HI", 3804 if ahat else 3805, len(user)) + user +
                   configuration)
        for f in frames:
            planes = f.depth.tobytes() + f.bright.tobytes()
            if ahat:
                payload = struct.pack("<II", 0, len(planes)) + planes
            else:
                swapped = bytearray(planes)  # the bytes are blue, green, red, alpha
                swapped[0::4], swapped[2::4] = planes[2::4], planes[0::4]
                payload = png_rgba(width, height, bytes(swapped))
            payload += struct.pack("<Q", f.sequence)
            pose = row_vectors(rig_pose(f.pose)) if f.pose else [0.0] * 16
            file.write(struct.pack("<QI", f.stamp_ns // 100, len(payload)) + payload +
                       struct.pack("<16f", *pose))
    return path


def write_hl2ss_calibration(path, rays, alias):
    """Of unit rays: x and y at z = 1, extrinsics, scale, alias, a map and a pinhole."""
    pixels = len(rays) // 3
    planes = [array.array("f", (rays[3 * i + axis] / rays[3 * i + 2] if rays[3 * i + 2] else 0.0
                                for i in range(pixels))) for axis in (0, 1)]
    rest = array.array("f", row_vectors(inverse(RIG)) + [1000.0] + ([1055.0] if alias else []))
    rest.extend([0.0] * (2 * pixels + 4))
    path.write_bytes(planes[0].tobytes() + planes[1].tobytes() + rest.tobytes())
    return path
