"""The test programs of the unmutated tree, and what each is made of.

They are built once, in a copy of the tree, as the release preset builds them: the compiler's cache
mostly holds them. A mutated file is then compiled beside the copy: the
folder that holds it stands first among the include folders. Of a test program only those objects
are compiled anew that read the file, and it is linked from these and the unmutated ones.
"""
import collections
import hashlib
import json
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import tempfile
import threading

# Whose tests judge. Those of threads against real time and those of networks are not among them.
TEST_FOLDERS = ["graph", "kernels", "nodes", "schedules", "platform/sinks/can", "platform/sinks/record",
                "platform/runtime/session", "platform/apps/board", "platform/tools/mapping", "platform/sim"]
NETWORK = {"tests/unit/platform/sinks/dds/isolated_network.cpp"}
CASE_SECONDS_MAX = 8  # slower test cases judge no mutation
MEMORY_MAX = 6 << 30
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "GLINT_TEST_DATA"}  # the same anywhere

Program = collections.namedtuple("Program", "name objects suites command")
Ran = collections.namedtuple("Ran", "code output timed_out seconds")  # processor seconds


def run(command, folder, seconds=None, cpu_seconds=None, **environment):
    """Runs a command that may never end, or take all memory."""
    def limit():
        if cpu_seconds:
            resource.setrlimit(resource.RLIMIT_CPU, (int(cpu_seconds), int(cpu_seconds) + 5))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_MAX, MEMORY_MAX))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
    with tempfile.TemporaryFile("w+", errors="replace") as output:
        process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, env={**ENVIRONMENT, **environment},
                                   preexec_fn=limit, start_new_session=True)
        overdue = threading.Timer(seconds or 1e6, os.killpg, (process.pid, signal.SIGKILL))
        overdue.start()
        _, status, usage = os.wait4(process.pid, 0)
        overdue.cancel()
        process.returncode = code = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return Ran(code, output.read(), code in (-signal.SIGXCPU, -signal.SIGKILL),
                   usage.ru_utime + usage.ru_stime)


def checked(command, folder, **environment):
    ran = run(command, folder, **environment)
    if ran.code != 0:
        raise SystemExit(f"tests/mutation: {shlex.join(map(str, command))}: exit {ran.code}\n" +
                         "\n".join(ran.output.split("\n")[-40:]))
    return ran.output


class Programs:
    def __init__(self, repository, work, jobs, only, say):
        self.tree, self.build, self.jobs = work / "tree", work / "tree/build", jobs
        self._copy(repository, work)
        say("building the unmutated tests")
        self._configure()
        edges = self._edges()
        folders = [f for f in TEST_FOLDERS if f.startswith(only)] or [only]
        chosen = [t for t, edge in edges.items() if self._judges(t, edge, folders)]
        checked(["cmake", "--build", self.build, "-j", str(jobs), "--target", *chosen], self.build)
        self.compile = self._compile_commands()
        self.reads = self._dependencies()
        self.programs = [program for program in (self._program(t, edges) for t in chosen)
                         if not any(self.reads[part] & NETWORK for part in program.objects)]
        say(f"running {len(self.programs)} unmutated test programs")
        self.baseline = self._baseline(work / "baseline.json")

    # The commit with what was changed since and is known to git; only what differs is written, so
    # that the next run builds little.
    def _copy(self, repository, work):
        git = ["git", "-C", str(repository)]
        changed = checked([*git, "stash", "create"], repository).strip()
        self.commit = checked([*git, "rev-parse", changed or "HEAD"], repository).strip()
        self.tree.mkdir(parents=True, exist_ok=True)
        checked([*git, f"--work-tree={self.tree}", "read-tree", "--reset", "-u", self.commit],
                repository, GIT_INDEX_FILE=str(work / "index"))

    def _configure(self):
        checked(["cmake", "--preset", "release", "-DGLINT_TOGETHER=ON"], self.tree)

    def _edges(self):
        """What each program and library is linked from."""
        text = (self.build / "build.ninja").read_text().replace("$\n", "")
        found = re.findall(r"^build (\S+): CXX_(?:EXECUTABLE|STATIC_LIBRARY)_LINKER__\S+ (.*)$",
                           text, re.M)
        return {target: parts.split("||")[0].replace("|", " ").split() for target, parts in found}

    @staticmethod
    def _judges(target, edge, folders):
        own = [part for part in edge if part.endswith(".o")]
        return (any("gtest_main" in part for part in edge)
                and any(part.startswith(f"tests/unit/{folder}/") for part in own
                        for folder in folders)
                and not target.endswith(".a"))

    def _compile_commands(self):
        entries = json.loads((self.build / "compile_commands.json").read_text())
        commands = [shlex.split(entry["command"]) for entry in entries]
        return {command[command.index("-o") + 1]: command for command in commands}

    def _dependencies(self):
        reads, current = collections.defaultdict(set), None
        for line in checked(["ninja", "-t", "deps"], self.build).split("\n"):
            if line.startswith("    "):
                path = os.path.normpath(self.build / line.strip())
                if path.startswith(f"{self.tree}/"):
                    reads[current].add(path[len(str(self.tree)) + 1:])
            elif ": #deps" in line:
                current = line.split(": #deps")[0]
        return reads

    def _program(self, target, edges):
        line = checked(["ninja", "-t", "commands", "-s", target], self.build).strip()
        command = shlex.split(line.split("&&")[1])
        objects = [part for part in edges[target] if part.endswith(".o")]
        trace = checked([*self._to(command, "/dev/null"), "-Wl,-t,-t"], self.build)
        for library, member in re.findall(r"^\(([^()]+\.a)\)(\S+\.o)$", trace, re.M):
            objects += [part for part in edges.get(library, ())
                        if os.path.basename(part) == member]
        suites = collections.defaultdict(set)  # by test source
        for part in edges[target]:
            for path in self.reads.get(part, ()):
                if path.startswith("tests/") and path.endswith(".cpp"):
                    text = (self.tree / path).read_text()
                    suites[path] |= set(re.findall(r"^TEST(?:_F|_P)?\((\w+)", text, re.M))
        return Program(target, list(dict.fromkeys(objects)), dict(suites), command)

    @staticmethod
    def _to(command, output):
        at = command.index("-o")
        return [*command[:at + 1], str(output), *command[at + 2:]]

    def _baseline(self, stored_in):
        """For each program: processor seconds of the cases that judge, and what leaves out the
        others. Kept for programs that did not change."""
        stored = json.loads(stored_in.read_text()) if stored_in.exists() else {}
        for program in self.programs:
            path = self.build / program.name
            digest = hashlib.sha256(path.read_bytes()).hexdigest()
            if stored.get(program.name, {}).get("digest") == digest:
                continue
            report = self.build / "report.json"
            report.unlink(missing_ok=True)
            ran = run([path, f"--gtest_output=json:{report}"], self.build, cpu_seconds=600)
            left_out, seconds = [], 0.0
            report_of = json.loads(report.read_text()) if report.exists() else {"testsuites": []}
            suites = report_of["testsuites"]
            # A case's time is the wall's: on a busy machine more than the processor's.
            share = min(1, ran.seconds / max(float(report_of.get("time", "0s").rstrip("s")), 0.001))
            for suite in suites:
                for case in suite["testsuite"]:
                    took = float(case["time"].rstrip("s")) * share
                    if "failures" in case or took > CASE_SECONDS_MAX:
                        left_out.append(f"{suite['name']}.{case['name']}")
                    else:
                        seconds += took
            stored[program.name] = {
                "digest": digest, "left_out": left_out, "seconds": seconds, "usable": bool(suites),
                "cpu": ran.seconds}
            stored_in.write_text(json.dumps(stored, indent=1))
        return stored
