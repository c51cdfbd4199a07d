"""Button frames that canmatrix encodes with a cell's DBC file are decoded as encoded.

    dbc_buttons.py READ_KNOWN_BUTTONS GLINT
Exit 0: all as encoded; 1: something differs; 77: canmatrix is not installed.
"""
import contextlib
import io
import pathlib
import random
import subprocess
import sys
import tempfile

try:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        import canmatrix.formats
except ImportError:
    print("skipped: python3-canmatrix is not installed")
    sys.exit(77)

BUTTONS = ("Draw", "DeleteLast", "Undo", "Finish")
FRAMES = 200
IDENTIFIER = 0x19F


def main():
    reader, glint = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        cell, dbc = pathlib.Path(folder) / "cell.toml", pathlib.Path(folder) / "cell.dbc"
        cell.write_text(f"[can]\nbuttons = {IDENTIFIER}\n")
        subprocess.run([glint, "can", "dbc", "--config", cell, "--out", dbc], check=True,
                       stdout=subprocess.DEVNULL)
        message = canmatrix.formats.loadp_flat(str(dbc)).frame_by_name("PenButtons")
    draws, lines, expected = random.Random(3), [], []
    before = dict.fromkeys(BUTTONS, 0)
    for number in range(FRAMES):
        held = {button: draws.randrange(2) for button in BUTTONS}
        data = bytes(message.encode(held)).hex().upper()
        lines.append(f"({number}.000000) can0 {message.arbitration_id.id:03X}#{data}\n")
        expected += [f"{i} {held[b]}" for i, b in enumerate(BUTTONS) if held[b] != before[b]]
        before = held
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "buttons.log"
        log.write_text("".join(lines))
        heard = subprocess.run([reader, log, str(message.arbitration_id.id)], text=True,
                               capture_output=True, check=False)
    found = heard.stdout.split("\n")[:-1]
    print(f"{len(found)} changes received of {len(expected)} in {FRAMES} frames, exit {heard.returncode}")
    same = found == expected and message.arbitration_id.id == IDENTIFIER
    return 0 if heard.returncode == 0 and same and expected else 1


if __name__ == "__main__":
    sys.exit(main())
