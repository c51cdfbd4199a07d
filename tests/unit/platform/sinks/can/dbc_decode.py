"""canmatrix decodes a log with every kind of frame by the DBC file of a cell with 16 tools.

Every value must be within half a step, every name right, and no signal more or less than the frame
has. The DBC file of the default cell must be the published one.

    dbc_decode.py WRITE_KNOWN_SAMPLES GLINT GLINT_DBC
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
FRAMES_A_SAMPLE = 13
NONE, LOST = 0, 3
STATES = ("none", "predicted", "measured", "lost")
REGISTRATIONS = ("none", "given", "accepted", "refused")
REASONS = (
    "none", "no_frame_yet", "too_few_markers", "no_labeling", "taken_by_other", "degenerate",
    "collinear", "bad_fit", "frame_late", "frame_doubled", "frame_invalid", "head_pose_missing",
    "too_old", "runs_full", "blobs_full", "search_full", "not_prepared", "out_of_range",
    "no_reference", "overrun_skipped", "overrun_held", "overrun_predicted", "overrun_stopped",
    "tool_changed", "imprecise", "cloud_full", "ambiguous")
OVERRUNS = range(19, 23)
LOST_OUTPUTS = {1: "dds", 2: "recording", 3: "files"}
OVERRUN_KINDS = {1: "detected_ahead", 2: "missed", 3: "tool_lost"}
NODE_STATES = {0: "boot_up", 4: "stopped", 5: "operational", 127: "pre_operational"}
NAMES = {
    "State": STATES, "Registration": REGISTRATIONS, "StoppedRegistration": REGISTRATIONS,
    "Reason": REASONS, "Valid": ("invalid", "valid"), "LeftOut": "xyzw", "NodeState": NODE_STATES,
    "Overrun": OVERRUN_KINDS, "RateGroup": ("frame", "tick"), "LostOutput": LOST_OUTPUTS,
    "Tool": [f"Probe{tool}" for tool in range(TOOLS)],
    "StoppedTool": [f"Probe{tool}" for tool in range(TOOLS)],
    "ErrorCode": {0: "error_over", **{0xFF00 + i: name for i, name in enumerate(REASONS) if i},
                  **{0xFF80 + i: "lost_" + name for i, name in LOST_OUTPUTS.items()}}}


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


def expected(number, sample):
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

    counter = {"Counter": sample["tick"] % 15}
    good = has_pose and fits(mm, -3276.8, 3276.75)
    yield "Position", {**counter, **axes("", mm if good else [0, 0, 0]), "Valid": int(good)}
    left_out, parts = smallest_three(sample["rotation_xyzw"]) if has_pose else (0, [0, 0, 0])
    yield "Orientation", {**counter, "LeftOut": left_out, "State": sample["state"],
                           **{f"Component{i}": part for i, part in enumerate(parts)}}
    yield "Velocity", {**counter, **vector(speed, 3276.7)}
    yield "AngularVelocity", {**counter, **vector(turn, 32.767)}
    yield "Quality", {**counter, **quality, "Age": capped(age, 0.2, 2047),
                      **{n: capped(v, step, over) for n, (v, step, over, _) in worth.items()}}

    good = has_pose and fits(mm, -2147483.647, 2147483.647) and fits(speed, -3276.7, 3276.7) \
        and fits(turn, -32.767, 32.767)
    zero = [0, 0, 0]
    yield "PoseFd", {
        **quality, **axes("", mm if good else zero),
        **axes("Rotation", sample["rotation_xyzw"] if good else [0, 0, 0, 0]),
        **axes("Velocity", speed if good else zero), **axes("AngularVelocity", turn if good else zero),
        "State": sample["state"] if good or not has_pose else NONE, "Age": capped(age, 0.1, 65535),
        "Counter": sample["tick"] % 256, "FrameSequence": sample["sequence"],
        "MeasurementTime": sample["unix_ns"],
        **{n: capped(v, step, over) for n, (v, step, _, over) in worth.items()}}
    yield "CovarianceFd", {"Counter": sample["tick"] % 256, "State": sample["state"],
                           **covariance(sample["covariance"] if has_pose else [0] * 36)}
    yield "Heartbeat", {"NodeState": sample["node_state"]}
    yield "Emergency", emergency(sample)
    group, kind, reason, after = sample["overrun"]
    yield "Emergency", {"ErrorCode": 0xFF00 + reason, "ErrorRegister": 0x81, "Reason": reason,
                        "RateGroup": group, "Overrun": kind, "AfterNode": after}
    yield "Emergency", {"ErrorCode": 0xFF80 + sample["lost_output"], "ErrorRegister": 0x81,
                        "LostOutput": sample["lost_output"]}
    seconds, rest = divmod(sample["unix_ns"], 10**9)
    later, nanoseconds = divmod(rest + 1_500_000_000, 10**9)
    pair = {"Domain": 0, "SequenceCounter": number % 16}
    yield "TimeSync", {**pair, "Type": 0x20, "UserByte": 0, "Seconds": seconds}
    yield "TimeFollowUp", {**pair, "Type": 0x28, "SyncToGateway": 0, "OverflowSeconds": later,
                           "Nanoseconds": nanoseconds}


def covariance(matrix):
    """Standard deviations in mm and degrees, and the correlations of the upper triangle."""
    sigma = [math.sqrt(matrix[7 * i]) for i in range(6)]
    names = ["X", "Y", "Z", "RotationX", "RotationY", "RotationZ"]
    short = ["X", "Y", "Z", "Rx", "Ry", "Rz"]
    shown = [1e3 * s for s in sigma[:3]] + [math.degrees(s) for s in sigma[3:]]
    values = {f"Sigma{name}": capped(value, 0.01, 65535) for name, value in zip(names, shown)}
    for i in range(6):
        for j in range(i + 1, 6):
            product = sigma[i] * sigma[j]
            values[f"Correlation{short[i]}{short[j]}"] = \
                matrix[6 * i + j] / product if product else 0.0
    return values


def emergency(sample):
    reason = sample["reason"]
    common = {"ErrorCode": 0xFF00 + reason if reason else 0, "ErrorRegister": 0x81 if reason else 0,
              "Reason": reason}
    if reason in OVERRUNS:
        return {**common, "Overrun": LOST, "StoppedTool": sample["tool"],
                "StoppedRegistration": sample["registration"]}
    return {**common, "Tool": sample["tool"], "State": sample["state"],
            "Registration": sample["registration"]}


def wrong_signals(message, decoded, signals):
    """What differs between the decoded signals and the expected ones; a checksum is not compared."""
    if set(decoded) - {"Crc"} != set(signals):
        yield f"signals {sorted(decoded)}, expected {sorted(signals)}"
        return
    for name, value in signals.items():
        signal, found = message.signal_by_name(name), decoded[name]
        exact = isinstance(value, int)
        difference = abs(found.phys_value - value) if exact else abs(float(found.phys_value) - value)
        if not difference <= (0 if exact else 0.51 * float(signal.factor)):
            yield f"{name}: found {found.phys_value}, written {value}"
        names = NAMES.get(name)
        if names is not None and found.named_value != names[value]:
            yield f"{name}: named {found.named_value}, expected {names[value]}"
        if names is None and signal.values and name != "Type":
            yield f"{name}: has names that are not expected"
        if name == "Type" and found.named_value != {0x20: "SyncWithCrc", 0x28: "FollowUpWithCrc"}[value]:
            yield f"Type: named {found.named_value}"


def write_cell(folder):
    """A cell with 16 tools, Probe0 to Probe15, of which no two have the same distances."""
    for tool in range(TOOLS):
        far = 60 + 6 * tool
        markers = [[0, 0, 0], [far, 0, 0], [0, far + 31, 0], [far / 2, 40, 25 + 3 * tool]]
        (folder / f"{tool}.toml").write_text(
            f'name = "probe {tool}"\nradius_mm = 6\nmarkers_mm = {markers}\ntip_mm = [0, 0, -150]\n')
    names = ", ".join(f'"{tool}.toml"' for tool in range(TOOLS))
    (folder / "cell.toml").write_text(f'tools = [{names}]\n[can]\nframes = "fd"\n')
    return folder / "cell.toml"


def dbc_of(glint, folder, *arguments):
    path = folder / "cell.dbc"
    subprocess.run([glint, "can", "dbc", "--out", path, *arguments], check=True,
                   stdout=subprocess.DEVNULL)
    return path


def main():
    writer, glint, published = sys.argv[1:]
    wrong, compared = [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if dbc_of(glint, folder).read_text() != pathlib.Path(published).read_text():
            wrong.append(f"{published} is not what `glint can dbc` writes; write it again")
        with contextlib.redirect_stdout(io.StringIO()):
            path = dbc_of(glint, folder, "--config", write_cell(folder))
            matrix = canmatrix.formats.loadp_flat(str(path))
        subprocess.run([writer, folder], check=True)
        samples = [json.loads(l) for l in (folder / "samples.jsonl").open()]
        log = list(read_log(folder / "can.log"))
    by_identifier = {frame.arbitration_id.id: frame for frame in matrix.frames}
    if len(by_identifier) != 7 * TOOLS + 4 or max(len(f.name) for f in matrix.frames) > 32:
        wrong.append(f"{len(by_identifier)} identifiers: {[f.name for f in matrix.frames]}")
    if len(log) != FRAMES_A_SAMPLE * len(samples):
        wrong.append(f"{len(log)} frames for {len(samples)} samples")
    frames, seen = iter(log), set()
    for number, sample in enumerate(samples):
        for (kind, signals), (identifier, is_fd, data) in zip(expected(number, sample), frames):
            message = by_identifier[identifier]
            is_pose = "Counter" in signals
            where = f"sample {number}, {kind}"
            if message.name != (f"Probe{sample['tool']}{kind}" if is_pose else kind):
                wrong.append(f"{where}: identifier {identifier:X} is {message.name}")
            if is_fd != bool(message.is_fd) or len(data) != message.size:
                wrong.append(f"{where}: {len(data)} bytes, the DBC has {message.size}")
            if is_pose and not protected(identifier, is_fd, data):
                wrong.append(f"{where}: its checksum is wrong")
            decoded = message.decode(data)
            seen |= {message.name} | {f"{s} {v.named_value}" for s, v in decoded.items()
                                      if s in NAMES}
            compared += len(signals)
            wrong += [f"{where}, {what}" for what in wrong_signals(message, decoded, signals)]
    unseen = {f.name for f in matrix.frames} - seen
    unseen |= {f"{s} {n}" for s, names in NAMES.items()
               for n in (names.values() if isinstance(names, dict) else names)} - seen
    wrong += [f"never in the log: {name}" for name in sorted(unseen)]
    print("\n".join(wrong[:20]))
    print(f"{compared} values of {len(log)} frames compared, {len(wrong)} wrong")
    return 1 if wrong or compared == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
