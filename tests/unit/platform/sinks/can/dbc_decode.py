"""Decodes a log of known poses with canmatrix and the DBC file; every value must be within one step.

    dbc_decode.py WRITE_KNOWN_SAMPLES GLINT_DBC
Exit 0: all as written; 1: something differs; 77: canmatrix is not installed.
"""
import contextlib
import io
import json
import math
import pathlib
import subprocess
import sys
import tempfile

try:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        import canmatrix.formats
except ImportError:
    print("skipped: python3-canmatrix is not installed")
    sys.exit(77)

BASE, STRIDE, TOOLS = 0x1A0, 0x10, 16
FRAMES_A_SAMPLE = 10
NONE, LOST = 0, 3


def crc(data, polynomial, width, start):
    top = 1 << (width - 1)
    for byte in data:
        start ^= byte << (width - 8)
        for _ in range(8):
            start = (start << 1 ^ (polynomial if start & top else 0)) & (2 * top - 1)
    return start


def read_log(path):
    for line in path.read_text().splitlines():
        identifier, _, data = line.split()[2].partition("#")
        is_fd = data.startswith("#")
        yield int(identifier, 16), is_fd, bytes.fromhex(data[2:] if is_fd else data)


def protected(identifier, is_fd, data):
    own = identifier.to_bytes(2, "little")
    if is_fd:
        return int.from_bytes(data[:2], "little") == crc(data[2:] + own, 0x1021, 16, 0xFFFF)
    return data[0] == crc(own + data[1:], 0x1D, 8, 0)


def smallest_three(q):
    left_out = max(range(4), key=lambda i: (abs(q[i]), -i))
    sign = -1 if q[left_out] < 0 else 1
    return left_out, [sign * q[i] for i in range(4) if i != left_out]


def fits(values, low, high):
    return all(low <= v <= high for v in values)


def capped(value, step, over):
    """All ones where it does not fit below: `over` steps."""
    return value if -0.5 < value / step < over - 0.5 else over * step


def axes(prefix, values):
    return {prefix + axis: value for axis, value in zip("XYZW", values)}


def expected(sample):
    """The signals that the frames of one sample must show, by the documentation alone."""
    has_pose = sample["state"] in (1, 2)
    mm = [1e3 * v for v in sample["position_m"]]
    speed = [1e3 * v for v in sample["velocity_m_s"]]
    turn = sample["angular_velocity_rad_s"]
    quality = {
        "State": sample["state"], "Registration": sample["registration"],
        "Markers": bin(sample["marker_mask"]).count("1"), "Buttons": sample["buttons"]}
    unknown = float("inf")
    worth = {
        "SigmaPosition": (1e3 * sample["sigma_position_m"] if has_pose else unknown, 0.01, 1023, 65535),
        "SigmaOrientation": (math.degrees(sample["sigma_orientation_rad"]) if has_pose else unknown,
                             0.01, 1023, 65535),
        "RegistrationRms": (1e3 * sample["registration_rms_m"], 0.1, 127, 255)}
    age = sample["age_ns"] / 1e6 if has_pose else unknown

    def vector(values, limit):
        if not has_pose or not fits(values, -limit, limit):
            return {**axes("", [0, 0, 0]), "State": NONE if has_pose else sample["state"]}
        return {**axes("", values), "State": sample["state"]}

    good = has_pose and fits(mm, -3276.8, 3276.75)
    yield "PenPosition", {**axes("", mm if good else [0, 0, 0]), "Valid": int(good),
                          "Counter": sample["tick"] % 15}
    left_out, parts = smallest_three(sample["rotation_xyzw"]) if has_pose else (0, [0, 0, 0])
    yield "PenOrientation", {"LeftOut": left_out, "State": sample["state"],
                             **{f"Component{i}": part for i, part in enumerate(parts)}}
    yield "PenVelocity", vector(speed, 3276.7)
    yield "PenAngularVelocity", vector(turn, 32.767)
    yield "PenQuality", {**quality, "Age": capped(age, 0.2, 2047),
                         **{n: capped(v, step, over) for n, (v, step, over, _) in worth.items()}}

    good = has_pose and fits(mm, -2147483.647, 2147483.647) and fits(speed, -3276.7, 3276.7) \
        and fits(turn, -32.767, 32.767)
    zero = [0, 0, 0]
    yield "PenPoseFd", {
        **quality, **axes("", mm if good else zero),
        **axes("Rotation", sample["rotation_xyzw"] if good else [0, 0, 0, 0]),
        **axes("Velocity", speed if good else zero), **axes("AngularVelocity", turn if good else zero),
        "State": sample["state"] if good or not has_pose else NONE, "Age": capped(age, 0.1, 65535),
        "Counter": sample["tick"] % 256, "FrameSequence": sample["sequence"],
        "MeasurementTime": sample["unix_ns"],
        **{n: capped(v, step, over) for n, (v, step, _, over) in worth.items()}}
    yield "Heartbeat", {"NodeState": 5}
    reason = sample["reason"]
    yield "Emergency", {"ErrorCode": 0xFF00 + reason if reason else 0, "Tool": sample["tool"],
                        "ErrorRegister": 0x81 if reason else 0, "State": sample["state"],
                        "Reason": reason, "Registration": sample["registration"]}
    seconds, rest = divmod(sample["unix_ns"], 10**9)
    later, nanoseconds = divmod(rest + 1_500_000_000, 10**9)
    yield "TimeSync", {"Type": 0x20, "Seconds": seconds, "Domain": 0}
    yield "TimeFollowUp", {"Type": 0x28, "Nanoseconds": nanoseconds, "OverflowSeconds": later}


def main():
    writer, dbc = sys.argv[1:]
    with contextlib.redirect_stdout(io.StringIO()):
        matrix = canmatrix.formats.loadp_flat(dbc)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([writer, folder], check=True)
        samples = [json.loads(l) for l in (pathlib.Path(folder) / "samples.jsonl").open()]
        log = list(read_log(pathlib.Path(folder) / "can.log"))
    wrong, compared = [], 0
    if len(log) != FRAMES_A_SAMPLE * len(samples):
        wrong.append(f"{len(log)} frames for {len(samples)} samples")
    frames = iter(log)
    for number, sample in enumerate(samples):
        for (name, signals), (identifier, is_fd, data) in zip(expected(sample), frames):
            message = matrix.frame_by_name(name)
            is_pose = name.startswith("Pen")
            shift = STRIDE * sample["tool"] if is_pose else 0
            where = f"sample {number}, {name}"
            if identifier != message.arbitration_id.id + shift or is_fd != bool(message.is_fd):
                wrong.append(f"{where}: identifier {identifier:X}")
            if len(data) != message.size:
                wrong.append(f"{where}: {len(data)} bytes, the DBC says {message.size}")
            if is_pose and not protected(identifier, is_fd, data):
                wrong.append(f"{where}: its checksum is wrong")
            decoded = message.decode(data)
            for signal, value in signals.items():
                step = float(message.signal_by_name(signal).factor)
                found = decoded[signal].phys_value
                difference = abs(found - value) if isinstance(value, int) else abs(float(found) - value)
                compared += 1
                if not difference <= (0 if isinstance(value, int) else 0.51 * step):
                    wrong.append(f"{where}, {signal}: found {found}, written {value}")
    print("\n".join(wrong[:20]))
    print(f"{compared} values of {len(log)} frames compared, {len(wrong)} wrong")
    return 1 if wrong or compared == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
