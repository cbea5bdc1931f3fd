"""Fifty designs of all kinds, by a fixed seed."""

from __future__ import annotations

import random
from typing import Any

from conftest import ROOT

KINDS = ["flat", "hole_array", "pillar_array", "grating", "v_grooves", "waves", "cap_array", "random_rough",
         "particle_film", "measured", "stack", "etched_glass"]
_SCAN = str(ROOT / "designs/measured_surface/scan.gsf")


def _um(random_: random.Random, low: float, high: float) -> str:
    return f"{random_.uniform(low, high):.3f} um"


def _nm(random_: random.Random, low: float, high: float) -> str:
    return f"{random_.uniform(low, high):.1f} nm"


def texture(kind: str, r: random.Random) -> dict[str, Any]:
    period, width = f"{r.choice([4, 5, 6])} um", _um(r, 1.2, 2.5)
    depth = _nm(r, 100, 600)
    of_kind: dict[str, dict[str, Any]] = {
        "flat": {},
        "hole_array": {"period": period, "diameter": width, "depth": depth},
        "pillar_array": {"period": period, "diameter": width, "height": depth},
        "grating": {"period": period, "width": width, "depth": depth},
        "v_grooves": {"period": period, "width": width, "depth": depth},
        "waves": {"period": period, "depth": depth, "directions": r.choice(["one", "both"])},
        "cap_array": {"period": period, "diameter": width, "depth": _nm(r, 50, 300)},
        "random_rough": {"rms": _nm(r, 5, 60), "seed": r.randint(1, 1000)},
        "particle_film": {"radius": _um(r, 0.3, 0.8), "coverage": f"{r.randint(5, 30)} %", "seed": r.randint(1, 1000)},
        "measured": {"file": _SCAN, "patch": "10 um"},
        "stack": {"parts": [{"type": "hole_array", "period": "6 um", "diameter": width, "depth": depth},
                            {"type": "random_rough", "rms": _nm(r, 2, 20)}]},
        "etched_glass": {"rms": _nm(r, 50, 200), "correlation_length": _um(r, 2, 10), "seed": r.randint(1, 1000)},
    }
    return {"type": kind, **of_kind[kind]}


def designs(count: int) -> list[dict[str, Any]]:
    """Dicts of designs: kinds in turn; drive, humidity and finish drawn."""
    r = random.Random(20261123)
    out = []
    for i in range(count):
        kind = KINDS[i % len(KINDS)]
        out.append({
            "base": "m3_samples/flat.toml",
            "title": f"{kind} {i}",
            "texture": texture(kind, r),
            "surface": {"contact_angle": f"{r.randint(30, 110)} deg"},
            "drive": {"amplitude": f"{r.choice([0, 100, 200])} V"},
            "environment": {"relative_humidity": [f"{r.randint(10, 80)} %"]},
            "accuracy": {"level": "draft", "grid": 48, "seed": r.randint(1, 100)},
        })
    return out
