"""The commands that the drills disturb, on small inputs that end within a second or two."""
import shutil
from dataclasses import dataclass
from typing import Callable

from . import running

DESIGN = """schema_version = 1
[texture]
type = "hole_array"
period = "6 um"
diameter = "3 um"
depth = "350 nm"
[accuracy]
level = "draft"
[drive]
amplitude = "200 V"
frequency = "5 kHz"
[environment]
relative_humidity = ["55 %"]
"""
STUDY = """schema_version = 1
base = "design.toml"
[objective]
maximise = "mean(modulation)"
minimise = "mean(friction)"
[search]
evaluations = 4
drafts = 4
[design_space]
"texture.depth" = ["200 nm", "500 nm"]
"""


@dataclass
class Command:
    """One command: `arguments` after the program's name, run in a copy of `inputs`."""
    name: str
    arguments: list
    cheap: bool = False  # a fraction of a second, so that hundreds of runs are affordable


class Bench:
    """A folder with all inputs made once; every run gets a copy of it."""

    def __init__(self, program, top, folder):
        self.program, self.top, self.folder = program, top, folder
        self.inputs = folder / "inputs"
        self.inputs.mkdir(parents=True)
        (self.inputs / "design.toml").write_text(DESIGN)
        (self.inputs / "other.toml").write_text(DESIGN.replace("350 nm", "200 nm"))
        (self.inputs / "study.toml").write_text(STUDY)
        self.make("optimize", "study.toml", "--out", "results", "--jobs", "1")
        self.make("export", "design.toml", "--out", "files", "--pixels", "32", "--polarity", "white-high",
                  "--format", "exr,tiff,gsf,x3p,npy,png,gds,oasis,stl")
        self.made = running.files_of(self.inputs)
        for command in COMMANDS:  # what fails by itself would refuse all that disturbs it
            self.expect_success(command.arguments, self.run(command)[1])

    def make(self, *arguments):
        self.expect_success(arguments, running.run([self.program, "--quiet", *arguments], self.inputs))

    @staticmethod
    def expect_success(arguments, outcome):
        if outcome.status != 0:
            raise SystemExit(f"torture: papilla {' '.join(arguments)} failed before anything was disturbed:\n{outcome.error}")

    def copy(self):
        """A fresh copy of the inputs."""
        place = self.folder / "run"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(self.inputs, place, symlinks=True)
        return place

    def run(self, command, place=None, **how):
        place = place or self.copy()
        return place, running.run([self.program, "--quiet", *command.arguments], place, **how)


COMMANDS = [
    Command("describe", ["describe", "texture"], cheap=True),
    Command("explain", ["explain", "study.toml"], cheap=True),
    Command("evaluate", ["evaluate", "design.toml", "--out", "evaluated"]),
    Command("export", ["export", "design.toml", "--out", "exported", "--pixels", "16", "--format", "exr,gsf,npy,gds"], cheap=True),
    Command("verify", ["verify", "files"], cheap=True),
    Command("surface", ["surface", "files/heightmap.gsf"], cheap=True),
    Command("report", ["report", "results"], cheap=True),
    Command("rank", ["rank", "design.toml", "other.toml", "--by", "friction:low", "--out", "ranked"]),
    Command("optimize", ["optimize", "study.toml", "--out", "searched", "--jobs", "1"]),
    Command("resume", ["optimize", "study.toml", "--out", "results", "--jobs", "1", "--resume"]),
]
