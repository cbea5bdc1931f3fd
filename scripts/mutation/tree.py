"""The copy of the source tree under build/mutate that mutants are planted in, and its build."""
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess

from . import candidates, planting

SOURCES = ("src", "geometry", "optim")
LEFT_OUT = ("src/cli/", "src/report/page")


class Failure(Exception):
    pass


def digest(*parts):
    h = hashlib.sha256()
    for part in parts:
        h.update(part if isinstance(part, bytes) else str(part).encode())
        h.update(b"\0")
    return h.hexdigest()[:20]


class Tree:
    def __init__(self, top, jobs):
        self.top, self.jobs = top, jobs
        self.work = top / "build" / "mutate"
        self.copy = self.work / "tree"
        self.build = self.copy / "build"
        self.files = self._listed()
        self._refused_at = self.work / "refused.json"
        self._refused = set(json.loads(self._refused_at.read_text())) if self._refused_at.is_file() else set()

    def _listed(self):
        """The working tree as git would add it."""
        out = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=self.top,
                             check=True, capture_output=True).stdout.decode().split("\0")
        return sorted(f for f in set(out) if f and (self.top / f).is_file())

    def mutable(self, folders):
        """Headers, and the sources that this build compiles: what stands in for a library that it has is in none of its programs."""
        built = self.built()
        chosen = [f for f in self.files
                  if (f.endswith(".h") or f in built) and f.split("/")[0] in SOURCES and not f.startswith(LEFT_OUT)]
        if folders:
            chosen = [f for f in chosen if any(f.startswith(x.rstrip("/") + "/") or f == x for x in folders)]
        return chosen

    def rooms(self):
        """The folders of tests/."""
        return {f.split("/")[1] for f in self.files if f.startswith("tests/") and f.count("/") > 1}

    def state(self, *prefixes):
        return digest(*(x for f in self.files if f.startswith(prefixes) for x in (f, (self.top / f).read_bytes())))

    # -- copy -----------------------------------------------------------------
    def write(self, planted):
        """Copies what changed; `planted` is file -> text with mutants. Unchanged files keep their times."""
        wanted = {f: planted.get(f) or (self.top / f).read_bytes() for f in self.files}
        wanted["papilla_mutant.h"] = planting.HEADER.encode()
        for file, text in wanted.items():
            path = self.copy / file
            if path.is_file() and path.read_bytes() == text:
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text)
            if (self.top / file).is_file():
                shutil.copymode(self.top / file, path)
        for path in sorted(self.copy.rglob("*"), reverse=True):
            name = str(path.relative_to(self.copy))
            if path.is_file() and name not in wanted and not name.startswith("build/"):
                path.unlink()

    def configure(self):
        command = ["cmake", "-S", str(self.copy), "-B", str(self.build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                   "-DPAPILLA_NATIVE=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]
        if shutil.which("ccache"):
            command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        if self._logged(command, "configure"):
            raise Failure(f"cmake failed: {self.work / 'configure.log'}")

    def build_with(self, mutants, rooms, report):
        """Everything, or the fast test programs of some rooms of tests/ alone, with the mutants that compile."""
        while True:
            kept = [m for m in mutants if not self.refused(m)]
            self.write(self.planted_texts(kept))
            self.configure()
            log = self._compile(rooms)
            if log is None:
                return
            named = self._named_in(log)
            bad = [m for m in kept if m["id"] in named]
            if not bad:  # the initial value of a member is refused where a constant of its type is made
                bad = [m for m in kept if m["file"].endswith(".h") and not m["function"]]
            if not bad:
                raise Failure("\n".join([x for x in log.splitlines() if "error" in x.lower()][:10] + ["the build failed"]))
            report(f"the compiler refuses {len(bad)} mutants: they are left out")
            self._refused |= {self.key(m) for m in bad}
            self._refused_at.write_text(json.dumps(sorted(self._refused)))

    def key(self, mutant):
        return digest(*((self.top / f).read_bytes() for f in sorted({e["file"] for e in mutant["edits"]})),
                      json.dumps(mutant["edits"]))

    def refused(self, mutant):
        """Whether an earlier build found that the mutant does not compile."""
        return self.key(mutant) in self._refused

    def _compile(self, rooms):
        """The log of a build that failed, else None."""
        targets = ["all"]
        if rooms is not None:
            listed = subprocess.run(["ninja", "-C", str(self.build), "-t", "targets", "all"], check=True,
                                    capture_output=True, text=True).stdout
            known = {line.split(":")[0] for line in listed.splitlines()}
            targets = [t for t in (f"{room}_fast_tests" for room in sorted(rooms)) if t in known]
            targets += ["papilla"] if targets else []  # which some of them start
        return self._logged(["ninja", "-C", str(self.build), f"-j{self.jobs}", "-k0", *targets], "build") if targets else None

    def _named_in(self, log):
        """Ids of the mutants at the places of the compiler's errors; a mutant may end some lines further down."""
        named = set()
        for path, line in set(re.findall(r"^(\S+?):(\d+):\d+: (?:fatal )?error", log, re.M)):
            text = (self.build / path).read_bytes().split(b"\n") if (self.build / path).is_file() else []
            for number in range(int(line), max(0, int(line) - 6), -1):
                found = {int(i) for i in re.findall(rb"papilla_mutant\((\d+)\)", text[number - 1])} if number <= len(text) else set()
                named |= found
                if found:
                    break
        return named

    def _logged(self, command, name):
        """The log of a command that failed, else None."""
        log = self.work / f"{name}.log"
        with open(log, "wb") as stream:
            failed = subprocess.run(command, stdout=stream, stderr=subprocess.STDOUT).returncode
        return log.read_text(errors="replace") if failed else None

    # -- compile commands -----------------------------------------------------
    def commands(self):
        table = {}
        for entry in json.loads((self.build / "compile_commands.json").read_text()):
            file = os.path.relpath(entry["file"], self.copy)
            words = entry.get("arguments") or shlex.split(entry["command"])
            table[file] = [w for w in words if not w.endswith("ccache")]
        return table

    def arguments_for(self, file, commands):
        """Compiler and options for a source, or for a header those of any source of the library."""
        words = commands.get(file)
        if words is None:
            words = next((commands[f] for f in sorted(commands)
                          if f.startswith(file.rsplit("/", 1)[0] + "/") and f.endswith(".cpp")),
                         None) or next(commands[f] for f in sorted(commands) if f.startswith(SOURCES))
        kept, skip = [], False
        for word in words[1:]:
            if skip or word == "-c" or word.endswith(".cpp"):
                skip = False
            elif word in ("-o", "-MF", "-MT", "-MQ"):
                skip = True
            elif word not in ("-MD", "-MMD") and not word.startswith("-W"):
                kept.append(word)
        return words[0], kept

    def built(self):
        """Sources that are compiled, alone or several in one file."""
        out = set(self.commands())
        for together in self.build.glob("**/Unity/unity_*.cxx"):
            out |= {os.path.relpath(f, self.copy) for f in re.findall(r'#include "(.+)"', together.read_text())}
        return out

    # -- candidates -----------------------------------------------------------
    def all_candidates(self, files, report):
        """Every candidate of the files, in an order that depends on the tree alone."""
        commands = self.commands()
        cache = self.work / "candidates"
        cache.mkdir(exist_ok=True)
        version = digest((self.top / "scripts/mutation/candidates.py").read_bytes())
        jobs, out = {}, {}
        with concurrent.futures.ProcessPoolExecutor(self.jobs) as pool:
            for file in files:
                kept = cache / f"{digest(version, file, (self.top / file).read_bytes())}.json"
                if kept.is_file():
                    out[file] = json.loads(kept.read_text())
                    continue
                _, options = self.arguments_for(file, commands)
                options = [o.replace(str(self.copy), str(self.top)) for o in options]
                jobs[pool.submit(candidates.of_file, self.top, file, ["-x", "c++"] + options)] = (file, kept)
            for number, job in enumerate(concurrent.futures.as_completed(jobs)):
                file, kept = jobs[job]
                out[file] = job.result()
                kept.write_text(json.dumps(out[file]))
                report(f"reading the sources {number + 1}/{len(jobs)}")
        uses = {}
        for file in files:
            for place, ranges in out[file]["constants"].items():
                if place.split(" ")[0] in files:
                    uses.setdefault(place, {})[file] = ranges
        return [c for file in files for c in out[file]["candidates"]] + candidates.of_constants(self.top, uses)

    # -- planting -------------------------------------------------------------
    def planted_texts(self, mutants):
        edits = {}
        for mutant in mutants:
            for edit in mutant["edits"]:
                edits.setdefault(edit["file"], []).append(dict(edit, id=mutant["id"]))
        return {f: planting.plant((self.top / f).read_bytes(), e) for f, e in edits.items()}
