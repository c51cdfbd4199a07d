"""Two projects outside the tree use the library: one installed, one by add_subdirectory.

Both build and run the examples of platform/apps/examples: a graph of two nodes, frames from memory
whose pose is decoded from CAN frames, a source and a node of their own, and a graph's budget. The
two are compiled with different options and print the same digits. Of Glint's options a program gets
those that equal bits need, and no warnings, sanitizers or others.

    library.py installed|subproject SOURCE BUILD FOLDER
BUILD: a build of the library, for `installed`. FOLDER: kept, so that a second run compiles nothing.
Exit 0: they do; 1: something differs.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

EXAMPLES = ["own_graph", "track_from_memory", "own_source", "own_node", "graph_budget"]
# Drawn by the examples themselves; the tracker must find it.
TIP_MM = (20.0, -30.0, 320.0)
# Costs hold for the build that they were measured of: without -O3 none are given.
REFUSED = "the build of this program (measure again)"
NEEDED = {"-ffp-contract=off", "-DEIGEN_DONT_VECTORIZE"}
# What the projects themselves ask for, and what CMake adds for their headers, language and outputs.
OWN = re.compile(r"-(?:O\d|DNDEBUG|march=native|std=(?:gnu|c)\+\+20|I.*|isystem|o|c|M\S*)$")


def run(*command, **environment):
    ran = subprocess.run(command, text=True, capture_output=True, env=os.environ | environment)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {ran.returncode}\n{ran.stdout[-6000:]}{ran.stderr}")
    return ran.stdout


def built(project, folder, *options, **environment):
    run("cmake", "-S", project, "-B", folder, "-G", "Ninja",
        "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)
    run("cmake", "--build", folder, "--parallel", "2", "--target", *EXAMPLES, **environment)
    return folder


def installed(source, build, folder):
    prefix = folder / "prefix"
    shutil.rmtree(prefix, ignore_errors=True)
    run("cmake", "--install", build, "--component", "library", "--prefix", prefix)
    check_headers(prefix / "include")
    return built(source / "platform/apps/examples", folder / "examples",
                 f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")


def subproject(source, _, folder):
    """Not optimised, so that it builds sooner, but with all instructions of this machine."""
    cache = {}
    options = [f"-DGLINT={source}", "-DEXAMPLE_OPTIONS=-march=native", "-DCMAKE_CXX_FLAGS=-O0",
               "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=40"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        cache = {"CCACHE_BASEDIR": str(source), "CCACHE_NOHASHDIR": "true"}
    return built(source / "tests/demonstrations/subproject", folder, *options, **cache) / "examples"


def check_headers(include):
    """An installed header includes installed headers only."""
    for header in include.rglob("*.hpp"):
        for name in re.findall(r'^#include "([^"]+)"', header.read_text(), re.M):
            if not any((place / name).exists() for place in (include / "glint", header.parent)):
                sys.exit(f"{header.relative_to(include)}: {name} is not installed")


def check_options(folder):
    """An example is compiled with what it needs of Glint's options, and nothing else."""
    root = folder if (folder / "compile_commands.json").exists() else folder.parent
    for entry in json.loads((root / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["file"])
        if file.stem not in EXAMPLES:
            continue
        options = [word for word in entry["command"].split() if word.startswith("-")]
        needed = set() if file.stem == "own_graph" else NEEDED
        other = {word for word in options if not OWN.match(word)}
        if other != needed:
            sys.exit(f"{file.name}: options {sorted(other)}; expected {sorted(needed)}")


def check_output(name, lines):
    text = "\n".join(lines)
    if name == "own_graph":
        assert [line.split()[-2] for line in lines] == ["no", "no", "V", "V"], text
    if name == "track_from_memory":
        tip = re.search(r"CAN 0x1a0: tip (\S+) (\S+) (\S+) mm\nlast tip", text)
        assert tip, text
        errors = [abs(float(found) - drawn) for found, drawn in zip(tip.groups(), TIP_MM)]
        assert max(errors) < 2, text
    if name == "own_source":
        assert text == "drawn frames: 20 measured, 20 sent, 0 held", text
    if name == "own_node":
        assert text.startswith("nearest of 5 markers at 0.41") and text.endswith("pen measured"), text
    if name == "graph_budget" and REFUSED not in text:
        bounds = dict(re.findall(r"^(\S+) +(\S+) us$", text, re.M))
        # 60 ns and 64 markers of 9 ns
        assert bounds["FindNearest"] == "0.636" and "RefinePose#3" in bounds, text


def output_of(program):
    ran = subprocess.run([program], text=True, capture_output=True)
    if ran.returncode not in ((0, 2) if program.name == "graph_budget" else (0,)):
        sys.exit(f"{program.name}: exit code {ran.returncode}\n{ran.stdout}{ran.stderr}")
    return (ran.stdout + ran.stderr).splitlines()


def main():
    kind, source, build, folder = sys.argv[1], *(pathlib.Path(p).resolve() for p in sys.argv[2:5])
    programs = {"installed": installed, "subproject": subproject}[kind](source, build, folder)
    check_options(programs)
    digits = folder.parent / "digits.json"
    printed = {name: output_of(programs / name) for name in EXAMPLES}
    for name, lines in printed.items():
        check_output(name, lines)
    refuses = REFUSED in printed.pop("graph_budget")[-1]
    if refuses != (kind == "subproject"):
        sys.exit(f"graph_budget: costs refused: {refuses}")
    if kind == "installed":
        digits.write_text(json.dumps(printed))
    elif printed != json.loads(digits.read_text()):
        sys.exit(f"the examples print\n{printed}\nexpected, as installed\n{digits.read_text()}")
    print(f"{kind}: {len(EXAMPLES)} examples")
    return 0


if __name__ == "__main__":
    sys.exit(main())
