"""Runs suites of tests with a mutant switched on, and finds out which mutants a suite reaches."""
import concurrent.futures
import fnmatch
import json
import os
import resource
import signal
import subprocess
import time

from . import planting

MEMORY = 8 << 30


class Test:
    def __init__(self, name, command, labels, folder):
        self.name, self.command, self.folder = name, command, folder
        self.fast = any(label.endswith("_fast") for label in labels)
        self.room = next((label.rsplit("_", 1)[0] for label in labels), "")
        self.seconds = 0.0
        program = os.stat(command[0])
        self.state = f"{program.st_size} {program.st_mtime_ns}"
        self.filter = next((word.split("=", 1)[1] for word in command if word.startswith("--gtest_filter=")), None)


def listed(build):
    """What ctest would run: the suites of its programs, and commands of other kinds."""
    out = subprocess.run(["ctest", "--test-dir", str(build), "--show-only=json-v1"], check=True,
                         capture_output=True).stdout
    tests = []
    for entry in json.loads(out)["tests"]:
        properties = {p["name"]: p["value"] for p in entry.get("properties", [])}
        built = "command" in entry and os.path.exists(entry["command"][0])
        if built and not properties.get("DISABLED"):
            rest = properties.get("LABELS", []), properties.get("WORKING_DIRECTORY")
            if not entry["command"][0].endswith("_tests"):
                tests.append(Test(entry["name"], entry["command"], *rest))
                continue
            for suite in _suites(entry["command"][0]):
                tests.append(Test(f"{entry['name']}.{suite}", [*entry["command"], f"--gtest_filter={suite}.*"], *rest))
    return sorted(tests, key=lambda t: t.name)


def _suites(program):
    lines = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout.splitlines()
    return [line.split("#")[0].strip().rstrip(".") for line in lines if line and not line.startswith((" ", "Running main"))]


class Runner:
    """One slot a worker: its own folder for temporary files, one thread for each test."""

    def __init__(self, folder):
        self.folder = folder

    def run(self, command, folder, timeout, mutant=0, reached=None):
        """(passed, seconds); what runs longer than `timeout` has not passed. What it prints is left in `self.printed`."""
        self.folder.mkdir(parents=True, exist_ok=True)
        environment = dict(os.environ, TMPDIR=str(self.folder), TEST_TMPDIR=str(self.folder), OMP_NUM_THREADS="1",
                           PAPILLA_MUTANT=str(mutant))
        if reached:
            environment["PAPILLA_MUTANTS_REACHED"] = str(reached)
        start = time.monotonic()
        with open(self.printed, "wb") as stream:
            process = subprocess.Popen(command, cwd=folder or self.folder, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=stream, stderr=subprocess.DEVNULL, preexec_fn=_limited)
            try:
                code = process.wait(timeout)
            except subprocess.TimeoutExpired:
                code = None
            try:  # what the test started and left behind
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        return code == 0, time.monotonic() - start

    @property
    def printed(self):
        return self.folder.with_suffix(".printed")

    def fails(self, tests, mutant, passed):
        """The name of what notices the mutant, of some suites of one program, or None. They run in one process: the start
        of each would cost more than its tests. A suite that fails there is asked again alone."""
        left = list(tests)
        while left:
            if len(left) > 1:
                command = [left[0].command[0], "--gtest_filter=" + ":".join(t.filter for t in left), "--gtest_fail_fast"]
                if self.run(command, left[0].folder, _patience(left), mutant)[0]:
                    passed.update((t.name, t.state) for t in left)
                    return None
                begun = [line.split()[-1].decode() for line in self.printed.read_bytes().splitlines() if line.startswith(b"[ RUN")]
                suspect = next((t for t in left if begun and fnmatch.fnmatchcase(begun[-1], t.filter)), left[0])
            else:
                suspect = left[0]
            if not self.run(suspect.command, suspect.folder, _patience([suspect]), mutant)[0]:
                failed = [line.split()[3].decode() for line in self.printed.read_bytes().splitlines()
                          if line.startswith(b"[  FAILED  ]") and len(line.split()) > 3]
                return failed[0] if failed else suspect.name
            passed[suspect.name] = suspect.state
            left.remove(suspect)
        return None


def _patience(tests):
    return 15 + 6 * sum(t.seconds for t in tests)


def _limited():
    os.setsid()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))  # a browser reserves far more addresses than it fills


def reach(tests, runners, folder, kept, report, stop):
    """name -> (passed, seconds, ids reached, state of the program) without a mutant; `kept` is what an earlier call found."""
    found = {t.name: kept[t.name] for t in tests if t.name in kept and kept[t.name][0] and kept[t.name][3] == t.state}
    free = list(runners)

    def one(test):
        runner = free.pop()
        page = folder / f"reached_{runner.folder.name}"
        page.write_bytes(bytes(planting.REACHED_BYTES))
        try:
            passed, seconds = runner.run(test.command, test.folder, 1800, reached=page)
            ids = [i for i, b in enumerate(page.read_bytes()) if b]
        finally:
            free.append(runner)
        return test.name, (passed, seconds, ids, test.state)

    todo = [t for t in tests if t.name not in found]
    with concurrent.futures.ThreadPoolExecutor(len(runners)) as pool:
        jobs = [pool.submit(lambda t=t: None if stop() else one(t)) for t in todo]
        for number, job in enumerate(concurrent.futures.as_completed(jobs)):
            if job.result():
                name, result = job.result()
                found[name] = result
                report(f"which mutants a test reaches {number + 1}/{len(todo)}", found)
    return found


def batches(tests):
    """The tests from short to long, in lots of one second, two, four ...; of a lot those of one program together."""
    left, limit = sorted(tests, key=lambda t: (not t.fast, t.seconds, t.name)), 1.0
    while left:
        lot, seconds = [], 0.0
        while left and (not lot or seconds + left[0].seconds <= limit):
            seconds += left[0].seconds
            lot.append(left.pop(0))
        together = {}
        for test in lot:
            together.setdefault(test.command[0] if test.filter else test.name, []).append(test)
        yield from together.values()
        limit *= 2


def verdict(mutant, tests, runner, mirrors, options, passed, stop):
    """(verdict, test that noticed): `folder`, `all`, `none`, `unreached`, or `open` when stopped. `passed`: the tests
    that did not notice it, by name, with the state of their program; those known from earlier are not run again."""
    reaching = [t for t in tests if mutant["id"] in t.reaches and (t.fast or not options.fast)]
    end = time.monotonic() + options.patience
    if not reaching:
        return "unreached", ""
    own = [t for t in reaching if t.fast and t.room in mirrors]
    rest = [t for t in reaching if t not in own]
    for group, name in ((own, "folder"), (rest, "all")):
        for batch in batches([t for t in group if passed.get(t.name) != t.state]):
            if stop():
                return "open", ""
            if time.monotonic() > end:
                return "none", "out of patience"
            noticed = runner.fails(batch, mutant["id"], passed)
            if noticed:
                return name, noticed
    return "none", ""
