"""Runs the program once in a folder of its own and judges how it ended."""
import hashlib
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import threading
from dataclasses import dataclass, field

SECONDS = 60          # longer is a hang: the commands of these drills take a second
MEMORY = 1 << 30      # bytes of resident memory that no refused or small input may take
ENDS = (0, 1, 2)      # success, the work failed, wrong input


@dataclass
class Outcome:
    """How one run ended: its status (negative: the signal), what it printed, its memory in bytes."""
    status: int
    out: str
    error: str
    memory: int
    hung: bool = False

    def trouble(self):
        """What is wrong with this end, or an empty text."""
        if self.hung:
            return f"ran for more than {SECONDS} s"
        if self.status not in ENDS:
            return f"ended by signal {-self.status}" if self.status < 0 else f"ended with {self.status}"
        if self.status != 0 and "error:" not in self.error and "not sound:" not in self.error:
            return f"ended with {self.status} and told no error"
        if self.memory > MEMORY:
            return f"took {self.memory >> 20} MB"
        return ""


def run(arguments, folder, environment=None, limit=None, seconds=SECONDS):
    """Runs `arguments` in `folder`; `limit` is called in the child before it starts."""
    def prepare():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if limit:
            limit()

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as error:
        process = subprocess.Popen(
            [str(a) for a in arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=error, preexec_fn=prepare,
            env={**os.environ, "OMP_NUM_THREADS": "1", "NO_COLOR": "1", **(environment or {})})
        timer = threading.Timer(seconds, process.kill)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        hung = not timer.is_alive()
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for stream in (out, error):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
    return Outcome(process.returncode, texts[0], texts[1], usage.ru_maxrss << 10, hung)


def files_of(folder):
    """Digest of every file below `folder`, by its path, but for the one that tells seconds."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(pathlib.Path(folder).rglob("*")) if p.is_file() and not p.is_symlink() and p.name != "timing.json"}


def leftovers(folder, outcome):
    """Half-written files that a run left behind and did not tell of."""
    if "may be left as .NAME.part" in outcome.error:
        return []
    return [str(p) for p in pathlib.Path(folder).rglob("*") if re.search(r"\.part($|\.)", p.name)]


@dataclass
class Tally:
    """What a drill counted, and its line."""
    name: str
    counts: dict = field(default_factory=dict)
    faults: list = field(default_factory=list)

    def count(self, what, number=1):
        self.counts[what] = self.counts.get(what, 0) + number

    def judge(self, outcome, what, more=""):
        """Counts one run as told (an error), as done, or as a fault named by `what`."""
        trouble = outcome.trouble() or more
        if trouble:
            self.faults.append(f"{what}: {trouble}")
        self.count("faults" if trouble else "done" if outcome.status == 0 else "told")

    def line(self):
        counts = ", ".join(f"{number} {what}" for what, number in self.counts.items() if what != "faults")
        return f"{self.name}: {counts}, {len(self.faults)} faults"
