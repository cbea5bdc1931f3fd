"""The limits that a system sets: address space, open files, the size of files; and kill -9."""
import re
import resource
import signal
import subprocess
import time

from . import running, work


def drill(bench, name, kind, values, seconds):
    """Each command under each value of a resource's limit."""
    tally = running.Tally(name)
    end = time.monotonic() + seconds
    for value in values:
        for command in work.COMMANDS:
            if time.monotonic() > end:
                return tally

            def limit(value=value):
                resource.setrlimit(kind, (value, value))
                signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores it, and children inherit that
            place, outcome = bench.run(command, limit=limit)
            if loader_failed(outcome):
                tally.count("not started")
                continue
            left = running.leftovers(place, outcome)
            tally.judge(outcome, f"{command.name} under {name} {value}", f"left {left[0]} behind" if left else "")
    return tally


def loader_failed(outcome):
    """The program never reached main(): its libraries could not be mapped."""
    return "error while loading shared libraries" in outcome.error or "cannot allocate memory in static TLS" in outcome.error


def memory(bench, seconds):
    return drill(bench, "memory limits", resource.RLIMIT_AS, [m << 20 for m in (1500, 900, 700, 600, 500, 450, 400, 350, 300)], seconds)


def handles(bench, seconds):
    return drill(bench, "open file limits", resource.RLIMIT_NOFILE, [64, 32, 16, 12, 10, 8, 7, 6, 5, 4], seconds)


def sizes(bench, seconds):
    return drill(bench, "file size limits", resource.RLIMIT_FSIZE, [100000, 20000, 5000, 1000, 200, 10], seconds)  # of 0 nothing could be told: messages go to a file too


def kills(bench, seconds):
    """kill -9 at random moments of a search, which --resume then ends with the same bytes (tests/kill_test)."""
    tally = running.Tally("kill -9")
    count = max(4, int(seconds / 3))
    try:
        text = subprocess.run([bench.top / "tests" / "kill_test", bench.program, str(count)], capture_output=True, text=True,
                              timeout=seconds * 2 + 60).stdout.strip()
    except subprocess.TimeoutExpired:
        text = "ran out of time"
    found = re.search(r"(\d+) kills, (\d+) runs continued to the same bytes", text)
    if found:
        tally.count("kills", int(found[1]))
        tally.count("runs to the same bytes", int(found[2]))
    else:
        tally.faults.append(text)
    return tally
