"""Each Python example of the module's page runs, in a folder with the files of a short run.

    page_examples.py GLINT MODULE_FOLDER README
Exit 0: all run; 1: one fails, with its line; 77: numpy is not installed.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: python3-numpy is not installed")
    sys.exit(77)

EXAMPLES = 6


def main():
    glint, module_folder, readme = sys.argv[1:]
    text = pathlib.Path(readme).read_text()
    blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S))
    if len(blocks) < EXAMPLES:
        print(f"{readme}: {len(blocks)} Python examples; expected at least {EXAMPLES}")
        return 1
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([glint, "run", "--fast", "--duration", "3", "--record-level", "full",
                        "--out", "out"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        for block in blocks:
            line = text.count("\n", 0, block.start(1)) + 1
            done = subprocess.run([sys.executable, "-W", "error", "-c", block.group(1)],
                                  cwd=folder, env={"PYTHONPATH": module_folder}, text=True,
                                  capture_output=True)
            print(f"{readme}:{line}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
            failed += done.returncode != 0
            left = {path.name for path in pathlib.Path(folder).iterdir()} - {"out"}
            if left:
                print(f"{readme}:{line}: leaves {left}; expected no new file")
                failed += 1
    return 1 if failed else 0


sys.exit(main())
