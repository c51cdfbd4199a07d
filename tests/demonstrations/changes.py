"""Changed copies of source files, and a program compiled from them.

A demonstration lists for each file the replacements that an extension needs. Only these files are
copied; all others are those of the tree.
"""
import pathlib
import subprocess
import sys
import tempfile


def changed_copies(source, folder, changes):
    """Writes the files of {file: [(old, new), ..]} into folder; ends if a text is not there once."""
    for file, replacements in changes.items():
        text = (source / file).read_text()
        for old, new in replacements:
            if text.count(old) != 1:
                sys.exit(f"{file}: {text.count(old)} times {old!r}; expected once")
            text = text.replace(old, new)
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text)


def compiled(compiler, source, folder, files, program, *options):
    """Compiles the files and a main program as one; returns (completed process, executable)."""
    main, executable = folder / "program.cpp", folder / "program"
    main.write_text("".join(f'#include "{file}"\n' for file in files) + program)
    ran = subprocess.run([compiler, "-std=c++20", "-O0", *options, f"-I{folder}", f"-I{source}",
                          "-isystem", "/usr/include/eigen3", main, "-o", executable],
                         capture_output=True, text=True)
    return ran, executable


def printed_lines(compiler, source, changes, files, program):
    """What a program prints that was compiled from changed copies."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        changed_copies(source, folder, changes)
        ran, executable = compiled(compiler, source, folder, files, program)
        if ran.returncode != 0:
            sys.exit(ran.stderr)
        return subprocess.run([executable], check=True, text=True,
                              stdout=subprocess.PIPE).stdout.splitlines()
