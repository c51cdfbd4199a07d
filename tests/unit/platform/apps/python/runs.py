"""What the tests of the Python module share: the module, and runs of a cell of their own.

The test's arguments are GLINT MODULE_FOLDER. Exits with 77 where numpy is not installed.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: python3-numpy is not installed")
    sys.exit(77)

GLINT, MODULE_FOLDER = sys.argv.pop(1), sys.argv.pop(1)
sys.path[:0] = [MODULE_FOLDER, str(pathlib.Path(__file__).parents[4] / "accuracy")]
import glint  # noqa: E402

FOLDER = tempfile.TemporaryDirectory()
ROOT = pathlib.Path(FOLDER.name)
# Another random seed and tick than the page's run.
SEED, TICK_HZ = 20877, 125


def run(*words, code=0):
    done = subprocess.run([GLINT, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stderr)
    return done


def make_run(name, *options, can=""):
    """A run of another cell than the built-in one; returns its folder."""
    cell = ROOT / f"{name}.toml"
    cell.write_text(f'tools = ["pen", "board"]\n[camera]\nmodel = "hololens2_ahat"\n'
                    f'[rates]\ntick_hz = {TICK_HZ}\n[files]\ncsv = "samples.csv"\n'
                    f"[simulator]\nseed = {SEED}\n{can}")
    run("run", "--fast", "--duration", "2", "--config", cell, "--out", ROOT / name, *options)
    return ROOT / name


def fields_equal(case, one, other):
    case.assertEqual(one.dtype.names, other.dtype.names)
    case.assertEqual(len(one), len(other))
    for name in one.dtype.names:
        case.assertEqual(one[name].dtype, other[name].dtype)
        case.assertEqual(one[name].tobytes(), other[name].tobytes(), name)


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def numbers(row, *names):
    return [float(row[name]) for name in names]


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not hasattr(Runs, "full"):
            Runs.full = make_run("full", "--record-level", "full")
        cls.recording = glint.open(str(Runs.full / "run.mcap"))


def main():
    try:
        unittest.main()
    finally:
        FOLDER.cleanup()
