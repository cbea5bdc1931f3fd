"""Fault injection: every allocation, every call on a file and every byte of disk space fails in turn."""
import pathlib
import subprocess
import time

from . import running, work

SOURCE = pathlib.Path(__file__).with_name("faults.cpp")


def shim(folder):
    """The library that makes calls fail, compiled."""
    library = folder / "faults.so"
    subprocess.run(["g++", "-std=c++20", "-O1", "-shared", "-fPIC", "-o", library, SOURCE, "-ldl"], check=True)
    return library


def turns(total, most):
    """`most` numbers of 1..total at the most, evenly spread and with both ends."""
    if total <= most:
        return range(1, total + 1)
    return sorted({1 + round(k * (total - 1) / (most - 1)) for k in range(most)})


def pages_that_lack(place, differing):
    """Of the reports that are not the undisturbed ones those that say so themselves."""
    pages = [name for name in differing if name.endswith("report.html") and (place / name).exists()]
    return [name for name in pages if 'role="alert"' in (place / name).read_text(errors="replace")]


def drill(bench, library, kind, seconds):
    """Each command again and again, another call of the kind failing each time. A run tells an error or what it lacks (a warning), or does its work whole."""
    tally = running.Tally({"allocation": "allocations", "file": "file calls", "disk": "disk full"}[kind])
    end = time.monotonic() + seconds
    commands = [c for c in work.COMMANDS if kind == "allocation" or c.name not in ("describe", "explain", "surface")]
    for number, command in enumerate(commands):
        share = (end - time.monotonic()) / (len(commands) - number)
        begin = time.monotonic()
        counter = bench.folder / "count"
        environment = {"LD_PRELOAD": str(library), "PAPILLA_FAULT_KIND": kind, "PAPILLA_FAULT_COUNT": str(counter)}
        place, whole = bench.run(command, environment={**environment, "PAPILLA_FAULT_AT": "0"})
        if whole.status != 0:
            tally.faults.append(f"{command.name}: failed undisturbed: {whole.error.strip()}")
            continue
        sound = running.files_of(place)
        total = int(counter.read_text())
        one = max(time.monotonic() - begin, 0.02)
        tally.count("places", total)
        for at in turns(total, max(4, int(share / one))):
            if time.monotonic() > begin + share:
                break
            place, outcome = bench.run(command, environment={**environment, "PAPILLA_FAULT_AT": str(at)})
            after = running.files_of(place)
            more = ""
            differing = sorted(name for name in {*after, *sound} if after.get(name) != sound.get(name))
            lacking = pages_that_lack(place, differing)
            lacks_said = "warning:" in outcome.error or lacking
            damaged = [name for name, digest in bench.made.items() if name not in lacking and after.get(name, digest) not in (digest, sound.get(name))]
            if left := running.leftovers(place, outcome):
                more = f"left {left[0]} behind"
            elif outcome.status == 0 and differing and not lacks_said:
                more = f"said success and wrote another {differing[0]}"
            elif damaged:
                more = f"damaged {damaged[0]}, which was there before"
            tally.judge(outcome, f"{command.name}, {kind} {at} of {total}", more)
    return tally
