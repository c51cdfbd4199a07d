"""Live runs of `glint run` and their producers: for the tests of live sources."""
import csv
import json
import math
import os
import signal
import struct
import subprocess
import sys
import time

TICK_NS = 4_000_000
WAIT_S = 60  # for another process to go on, however busy the machine
# As ROS 2 users set it for one machine; Glint has its own.
CYCLONE = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="false"/>
</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""


class Judge:
    failed = 0

    def __call__(self, what, found, holds, bar):
        print(f"{what}: {found} (bar: {bar}){'' if holds else '  FAILED'}", flush=True)
        self.failed += not holds


def in_own_network():
    """Starts the script again in a network of its own; where it may not, the test is skipped."""
    if os.environ.get("GLINT_OWN_NETWORK"):
        return
    if subprocess.run(["unshare", "-n", "true"], capture_output=True).returncode != 0:
        print("skipped: no right to make a network of the test's own")
        sys.exit(77)
    os.environ["GLINT_OWN_NETWORK"] = "1"
    os.execvp("unshare", ["unshare", "-n", "sh", "-c", 'ip link set lo up && exec "$@"', "sh",
                          sys.executable, *sys.argv])


def wait_for(what, holds):
    end = time.monotonic() + WAIT_S
    while not holds():
        if time.monotonic() > end:
            sys.exit(f"no {what} within {WAIT_S} s")
        time.sleep(0.02)


def start(glint, work, name, cell, *options):
    """A run until it is stopped."""
    return subprocess.Popen([glint, "run", "--config", cell, "--out", work / name, "--json",
                             work / f"{name}.json", *options], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def wait_for_ticks(run, work, name):
    log = work / name / "can.log.part"
    wait_for("tick", lambda: run.poll() is not None or (log.exists() and log.stat().st_size > 0))


def end(run, work, name):
    run.send_signal(signal.SIGTERM)
    out, err = run.communicate(timeout=WAIT_S)
    return json.loads((work / f"{name}.json").read_text()), out, err


def ticks_in(path, state=","):
    """Ticks so far, of a file that is still written."""
    part = path.with_name(path.name + ".part")
    return sum(state in line for line in part.read_text().splitlines()[1:]) if part.exists() else 0


def samples_of(out):
    with open(out / "samples.csv") as file:
        return {round(float(r["tick_s"]) * 1e9 / TICK_NS): r for r in csv.DictReader(file)}


def largest_difference(live, again, shift):
    """(m, ticks compared, poses of them measured): ticks of the same frame and state."""
    largest, compared, measured = 0.0, 0, 0
    for tick, a in live.items():
        b = again.get(tick - shift)
        if b is None or any(a[k] != b[k] for k in ("frame_sequence", "state")):
            continue
        if a["state"] in ("measured", "predicted"):
            compared += 1
            measured += a["state"] == "measured"
            largest = max(largest, math.dist(*([float(r[k]) for k in ("x_m", "y_m", "z_m")]
                                               for r in (a, b))))
    return largest, compared, measured


class DdsPublisher:
    """Of topics (type, quality, ROS name); messages are their bytes."""

    def __init__(self, program, topics, domain=0):
        self.numbers = {name: i for i, (_, _, name) in enumerate(topics)}
        self.process = subprocess.Popen(
            [program, str(domain), *(f"{kind}:{quality}:rt{name}" for kind, quality, name in topics)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, "CYCLONEDDS_URI": CYCLONE})

    def send(self, topic, message):
        self.process.stdin.write(struct.pack("=II", self.numbers[topic], len(message)) + message)
        self.process.stdin.flush()

    def wait_for_reader(self, *topics):
        for topic in topics:
            self.send(topic, b"")
            self.process.stdout.readline()
        time.sleep(1)  # the reader's side finds the writer a little later

    def close(self):
        self.process.stdin.close()
        self.process.wait(timeout=WAIT_S)

    def kill(self):
        self.process.kill()
        self.process.wait()
