"""tshark opens the CAN log and decodes every frame with its identifier and its bytes.

    tshark_decode.py WRITE_KNOWN_SAMPLES
Exit 0: it does; 1: something differs; 77: tshark is not installed.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

if shutil.which("tshark") is None:
    print("skipped: tshark is not installed")
    sys.exit(77)

HEARTBEAT, EMERGENCY = 0x720, 0xA0


def tshark(log, *options):
    return subprocess.run(["tshark", "-r", log, *options], check=True, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout.splitlines()


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        log = pathlib.Path(folder) / "can.log"
        written = []
        for line in log.read_text().splitlines():
            identifier, _, data = line.split()[2].partition("#")
            written.append((int(identifier, 16), data[2:] if data.startswith("#") else data))
        fields = tshark(log, "-T", "fields", "-e", "can.id", "-e", "data.data")
        canopen = ("-d", "can.subdissector,canopen", "-T", "fields", "-e", "can.id", "-Y")
        heartbeats = tshark(log, *canopen, "canopen.nmt_guard.state == 5")
        emergencies = tshark(log, *canopen, "canopen.em.err_code")
    seen = []
    for line in fields:
        identifier, data = line.split("\t")
        seen.append((int(identifier, 0), data.upper()))
    wrong = [(w, s) for w, s in zip(written, seen) if w != s]
    for written_frame, seen_frame in wrong[:10]:
        print(f"written {written_frame}, decoded {seen_frame}")
    print(f"{len(written)} frames written, {len(seen)} decoded, {len(wrong)} differ, "
          f"{len(heartbeats)} heartbeats, {len(emergencies)} emergencies")
    operational = written.count((HEARTBEAT, "05"))
    errors = sum(identifier == EMERGENCY for identifier, _ in written)
    right = written and len(written) == len(seen) and not wrong
    counted = len(heartbeats) == operational > 0 and len(emergencies) == errors > 0
    return 0 if right and counted else 1


if __name__ == "__main__":
    sys.exit(main())
