"""Judges one mutation: compiles what reads it and runs tests, nearest first, until one fails."""
import collections
import filecmp
import os
import pathlib
import re
import shutil
import threading

import mutations
from programs import run

Verdict = collections.namedtuple("Verdict", "kind by seconds")  # kind: one of KINDS
KINDS = ["caught", "survived", "did not compile", "same machine code"]

SECONDS_MAX = 150  # of the processor, after which a mutation has survived
OBJECT_SECONDS = 4  # what compiling one costs about


class NotCompiled(Exception):
    def __init__(self, output):
        super().__init__()
        self.refused = re.search(r"static assertion failed[^\n]*", output)


class Judge:
    def __init__(self, programs, work):
        self.programs, self.work = programs, work
        self.seconds = threading.local()  # of the processor, by the mutation that a thread judges

    def _run(self, *arguments, **limits):
        ran = run(*arguments, **limits)
        self.seconds.spent += ran.seconds
        return ran

    def judge(self, mutation, number):
        folder = self.work / f"mutation-{number}"
        shutil.rmtree(folder, ignore_errors=True)
        self.seconds.spent = 0.0
        try:
            mutations.write(self.programs.tree, mutation, folder / "tree")
            kind, by = self._judge(mutation, folder)
        except NotCompiled as refused:
            kind = "caught" if refused.refused else "did not compile"
            by = "the compiler: " + refused.refused.group() if refused.refused else ""
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        return Verdict(kind, by, self.seconds.spent)

    def _judge(self, mutation, folder):
        """What became of it, and by which test or after which programs."""
        objects, tried = {}, []
        for program in self._nearest_first(mutation.path):
            if self.seconds.spent > SECONDS_MAX:
                break
            affected = [o for o in program.objects if mutation.path in self.programs.reads[o]]
            for part in affected:
                if part not in objects:
                    objects[part] = self._compiled(part, mutation, folder, len(objects))
            changed = {o: objects[o] for o in affected if objects[o]}
            if not changed:
                continue
            tried.append(program.name)
            failed = self._failing_test(program, mutation.path, changed, folder)
            if failed:
                return "caught", failed
        if mutation.path.startswith("graph/") or mutation.path == "schedules/fits.hpp":
            failed = self._failing_refusal(folder)
            if failed:
                return "caught", failed
        elif not tried and mutation.path.endswith(".cpp"):
            if not objects:  # no test program is linked from it
                reader = next(o for o, read in self.programs.reads.items() if mutation.path in read)
                objects[reader] = self._compiled(reader, mutation, folder, 0)
            if not any(objects.values()):
                return "same machine code", ""
        # A header's function that no test program calls is not tested, whatever its code.
        return "survived", ", ".join(tried) or "without a test program that contains it"

    # Those whose sources mirror the file's name, then its folder; then those that cost least.
    def _nearest_first(self, path):
        stem, room = pathlib.PurePath(path).stem, os.path.dirname(path)

        def order(program):
            mirrored = any(self._mirrors(test, stem, room) for test in program.suites)
            beside = any(os.path.dirname(test) == f"tests/unit/{room}" for test in program.suites)
            count = sum(path in self.programs.reads[o] for o in program.objects)
            cost = count * OBJECT_SECONDS + self.programs.baseline[program.name]["seconds"]
            return (not mirrored, not beside, cost)
        return sorted((program for program in self.programs.programs
                       if self.programs.baseline[program.name]["usable"]
                       and any(path in self.programs.reads[o] for o in program.objects)), key=order)

    @staticmethod
    def _mirrors(test, stem, room):
        return pathlib.PurePath(test).stem.startswith(stem) and room in test

    def _compiled(self, part, mutation, folder, number):
        """The mutated object; None where it equals the unmutated one."""
        command = [*self.programs.compile[part]]
        output = folder / f"{number}.o"
        at = command.index("-o")
        command[at + 1] = str(output)
        at = command.index("-c") + 1
        command[at] = self._source(command[at], mutation, folder)
        compiler = next(i for i, c in enumerate(command) if c.endswith(("++", "g++", "cc", "gcc")))
        command.insert(compiler + 1, f"-I{folder / 'tree'}")
        ran = self._run([*command, "-w"], self.programs.build)
        if ran.code != 0:
            raise NotCompiled(ran.output)
        same = filecmp.cmp(output, self.programs.build / part, shallow=False)
        return None if same else str(output)

    def _source(self, source, mutation, folder):
        """What is compiled instead of `source`. A list of files that are compiled as one names them
        from the top: the mutated tree's comes first among the folders to include from."""
        unmutated, mutated = (str(tree / mutation.path)
                              for tree in (self.programs.tree, folder / "tree"))
        return mutated if source == unmutated else source

    def _failing_test(self, program, path, changed, folder):
        """The first test that fails with the changed objects, or None."""
        command = [changed.get(part, part) for part in program.command]
        binary = folder / "test"
        at = command.index("-o")
        # What comes from a library is linked before it, so that the library's is not taken.
        library = [changed[o] for o in changed if o not in program.command]
        command = [*command[:at], *library, "-o", str(binary), *command[at + 2:]]
        ran = self._run(command, self.programs.build)
        if ran.code != 0:
            raise NotCompiled(ran.output)
        known = self.programs.baseline[program.name]
        stem, room = pathlib.PurePath(path).stem, os.path.dirname(path)
        near = sorted(suite for test, suites in program.suites.items() for suite in suites
                      if self._mirrors(test, stem, room))
        left_out = ":".join(known["left_out"])
        near = ":".join(f"{suite}.*" for suite in near)
        filters = [f"{near}-{left_out}", f"-{near}:{left_out}"] if near else [f"-{left_out}"]
        for selected in filters:
            ran = self._run([binary, "--gtest_fail_fast", "--gtest_brief=1",
                             f"--gtest_filter={selected}"], folder,
                            seconds=90 + 20 * known["cpu"], cpu_seconds=15 + 5 * known["cpu"],
                            TMPDIR=str(folder))
            failed = re.search(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", ran.output, re.M)
            if ran.timed_out:
                return f"{program.name}, which did not end"
            if failed:
                return failed.group(1)
            if ran.code != 0:
                return f"{program.name}, which ended with {ran.code}"
        return None

    # The graphs and chains that must not compile.
    def _failing_refusal(self, folder):
        tree = self.programs.tree
        for case in sorted((tree / "tests/compile_fail").glob("*.cpp")):
            ran = self._run(["cmake", f"-DCOMPILER=g++;-I{folder / 'tree'}", f"-DROOT={tree}",
                             f"-DFILE={case}", "-P",
                             tree / "tests/compile_fail/expect_failure.cmake"], tree)
            if ran.code != 0:
                return f"CompileFail.{case.stem}"
        return None
