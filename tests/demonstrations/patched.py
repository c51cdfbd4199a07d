"""A patch adds a source, a node or a kernel with a budget to the tree; a program then uses it.

The patch is applied to copies of the files that it changes. What it changes or adds is compiled with
the program, and linked before the libraries of the build.

    patched.py source|node|kernel COMPILER SOURCE BUILD
Exit 0: the patch applies, changes few enough existing files, and the program prints what it should.
"""
import pathlib
import shlex
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import changes

HERE = pathlib.Path(__file__).resolve().parent
# What equal bits need: the libraries of the build are compiled with it.
OPTIONS = ["-ffp-contract=off", "-DEIGEN_DONT_VECTORIZE", "-c"]


class Demonstration:
    """At most `existing` files change. `target`: a program of the build that links what is needed.

    `also`: unchanged files that depend on a changed type. `printed`: the program's lines.
    """
    def __init__(self, existing, target, also, printed):
        self.existing, self.target, self.also, self.printed = existing, target, also, printed


DEMONSTRATIONS = {
    "source": Demonstration(2, "glint_sources_test", [], [
        "kind raw_frames", "raw_frames frames.raw, sum 1200",
        'source.kind: "raw"; expected simulator, dds, hl2ss, shm, folder, hl2ss_file, raw_frames, '
        "recording, rosbag, stream_recorder",
        'frames.raw: 3145761 bytes; expected "RAWFRAME" and frames of 1048584 bytes']),
    "node": Demonstration(6, "glint_budget_test", ["platform/runtime/session/pipeline.cpp"], [
        "runs BackProject", "runs FindNearestRange", "limits 64, range 0.0", "measured, at its maxima",
        "no costs of FindNearestRange"]),
    "kernel": Demonstration(3, "glint_budget_test",
                            ["platform/budget/inputs/back_project_input.cpp"], [
        "3 pairs, 2 kept", "7 loops, at their maxima", "no costs of BackProject"]),
}


def applied(patch, source, folder):
    """Applies a patch to copies of its files; returns the changed files and the added ones."""
    counted = subprocess.run(["git", "apply", "--numstat", patch], cwd=folder, check=True, text=True,
                             capture_output=True).stdout
    files = [line.split("\t")[2] for line in counted.splitlines()]
    changed = [file for file in files if (source / file).exists()]
    changes.changed_copies(source, folder, {file: [] for file in changed})
    ran = subprocess.run(["git", "apply", patch], cwd=folder, text=True, capture_output=True)
    if ran.returncode != 0:
        sys.exit(f"{patch.name} does not apply: {ran.stderr}")
    return changed, [file for file in files if file not in changed]


def linked(build, target, objects, program):
    """Links as a program of the build is linked, with other objects: theirs hold before a library's."""
    command = subprocess.run(["ninja", "-C", build, "-t", "commands", "-s", target], check=True,
                             text=True, capture_output=True).stdout.splitlines()[-1]
    words = shlex.split(command.removeprefix(": && ").removesuffix(" && :"))
    libraries = [word for word in words[words.index("-o") + 2:] if "gtest" not in word]
    return subprocess.run([words[0], *objects, "-o", program, "-Wl,-z,muldefs", *libraries],
                          cwd=build, text=True, capture_output=True)


def printed_by(name, compiler, source, build, folder):
    demonstration = DEMONSTRATIONS[name]
    changed, added = applied(HERE / f"{name}.patch", source, folder)
    print(f"{len(changed)} existing files change: {' '.join(changed)}")
    if len(changed) > demonstration.existing:
        sys.exit(f"expected at most {demonstration.existing}")
    files = [file for file in changed + added + demonstration.also if file.endswith(".cpp")]
    text = (HERE / f"{name}_check.cpp").read_text()
    ran, compiled = changes.compiled(compiler, source, folder, files, text, *OPTIONS)
    if ran.returncode == 0:
        ran = linked(build, demonstration.target, [compiled], folder / "check")
    if ran.returncode != 0:
        sys.exit(ran.stderr)
    ran = subprocess.run([folder / "check"], cwd=folder, text=True, capture_output=True)
    print(ran.stdout + ran.stderr, end="")
    return ran.stdout


def main():
    name, compiler, source, build = sys.argv[1], sys.argv[2], *map(pathlib.Path, sys.argv[3:5])
    with tempfile.TemporaryDirectory() as folder:
        text = printed_by(name, compiler, source.resolve(), build.resolve(), pathlib.Path(folder))
    missing = [line for line in DEMONSTRATIONS[name].printed if line not in text]
    print("\n".join(f"not printed: {line}" for line in missing))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
