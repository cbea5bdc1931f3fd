"""Papilla: how a finger rubs on a textured surface over humidity, driven and not, and which texture is best.

    import papilla as pp
    d = pp.Design.load("m3_samples/a3h600.toml")
    r = d.with_({"texture.depth": "262 nm"}).evaluate(level="draft")
    r.humidity, r.modulation.value, r.modulation.error

Numbers are SI; texts carry their units. Wrong inputs raise ``InputError`` with every mistake at once. Long work
releases the interpreter's lock and ends on Ctrl-C. Guide: docs/how_to/python.md.
"""

from papilla._native import __version__
from papilla.design import Design, Heights, Look, Number, compare
from papilla.errors import InputError, Problem, Stopped
from papilla.lab import Batch, Experiment, Lab, Told
from papilla.physics import (Bridge, Contact, Drive, Droplets, Field, Persson, bridge, contact, drive, droplets, field,
                             haze, persson)
from papilla.quantity import Quantity
from papilla.response import Comparison, Difference, Differences, Response, Sensitivity
from papilla.scans import Scan, Spectrum, read_scan, roughness, spectrum
from papilla.study import (Decision, FoundDesign, Judgement, Objective, Point, Prospect, Recommendation, Run, Study,
                           Variable)
from papilla.sweeps import Sweep, sweep
from papilla.trades import (Calibration, Exported, FileVerdict, FittedParameter, FolderVerdict, Ranked, Ranking,
                            calibrate, rank, verify)

__all__ = [
    "Batch", "Bridge", "Calibration", "Comparison", "Contact", "Decision", "Design", "Difference", "Differences",
    "Drive", "Droplets", "Experiment", "Exported", "Field", "FileVerdict", "FittedParameter", "FolderVerdict",
    "FoundDesign", "Heights", "InputError", "Judgement", "Lab", "Look", "Number", "Objective", "Persson", "Point",
    "Problem", "Prospect", "Quantity", "Ranked", "Ranking", "Recommendation", "Response", "Run", "Scan", "Sensitivity",
    "Spectrum", "Stopped", "Study", "Sweep", "Told", "Variable", "__version__", "bridge", "calibrate", "compare", "contact",
    "drive", "droplets", "field", "haze", "persson", "rank", "read_scan", "roughness", "spectrum", "sweep", "verify",
]
