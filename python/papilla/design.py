"""Designs: a texture, its finish, the finger that feels it, the air and the drive."""

from __future__ import annotations

import filecmp
import html
import io
import json
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from papilla import _native, pictures, values as v
from papilla.errors import wrong
from papilla.progress import Progress, shown
from papilla.response import Comparison, Difference, Response, Sensitivity
from papilla.values import FloatArray, Path, Quantified

if TYPE_CHECKING:
    from papilla.trades import Exported

__all__ = ["Design", "Heights", "Look", "Number", "compare"]


@dataclass(frozen=True)
class Number:
    """A number of a design."""

    path: str
    """The key: "texture.depth"."""
    unit: str
    """For people; the numbers below are SI."""
    meaning: str
    value: float
    low: float
    """The range that is accepted."""
    high: float


@dataclass(frozen=True)
class Look:
    """How a texture looks on glass: photopic means. Source: docs/theory/optics.md."""

    haze: float
    """Share of the transmitted light beyond the cone of the view, 2.5 degrees."""
    transmittance: float
    """Share of the light that passes undeviated."""
    total_transmittance: float
    """Share of the light that passes at all."""
    gloss: float
    """Gloss units at 60 degrees (ISO 2813)."""
    gloss_20: float
    gloss_85: float
    distinctness: float
    """Of the reflected image at 20 degrees, share."""
    sparkle: float
    """Of the subpixels of ``view.panel``, share; 0 without a panel."""
    colour_shift: float
    """Distance in CIE 1976 u'v'."""
    regime: str
    """Which theory answered: "flat", "phase screen", "effective medium", "rigorous"; "refused": none can."""
    warning: str
    """Empty inside the validity of the theory."""


class Heights:
    """Heights of a patch [m]: high touches first, holes are below zero.

    ``z`` has the shape (ny, nx), float64; of ``Design.heights`` it is the memory of the library itself, without a copy.
    Pickles and copies hold the heights.
    """

    z: FloatArray
    """Shape (ny, nx) [m]; z[j, i] lies at ((i + 1/2) dx, (j + 1/2) dy)."""
    dx: float
    """Width of a pixel [m]."""
    dy: float
    """Height of a pixel [m]."""

    def __init__(self, z: FloatArray, dx: float, dy: float) -> None:
        self.z, self.dx, self.dy = z, dx, dy

    def __array__(self, dtype: npt.DTypeLike = None, copy: bool | None = None) -> npt.NDArray[Any]:
        """Its ``z``: Heights go where an array of heights does."""
        return np.asarray(self.z, dtype=dtype) if copy is None else np.array(self.z, dtype=dtype, copy=copy)

    def __reduce__(self) -> tuple[Any, ...]:
        return Heights, (np.array(self.z), self.dx, self.dy)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the patch [m]."""
        ny, nx = self.z.shape
        return nx * self.dx, ny * self.dy

    def __repr__(self) -> str:
        width, height = self.size
        return f"<papilla.Heights {self.z.shape}, {1e6 * width:.4g} x {1e6 * height:.4g} um>"

    def _repr_html_(self) -> str:
        return pictures.image(self.z)


class Design:
    """A design: what is made and where it is felt. Immutable; threads may share it.

    ``Design({...})`` takes the keys of a design file, as nested dicts or by path::

        pp.Design({"base": "m3_samples/common.toml",
                   "texture": {"type": "hole_array", "period": "6 um", "diameter": "3 um", "depth": 350e-9}})

    Texts carry units ("350 nm"); bare numbers are in the SI unit of their key (350e-9). ``base`` names a file whose
    keys hold where none are given, looked for in the working folder and in the designs folder. Every key:
    docs/reference. Raises InputError with every mistake at once; a design with more droplets than can be settled is drawn
    and exported, and refused where it is simulated.
    """

    _inside: _native.Design

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._inside = _native.Design.parse("schema_version = 1\n", v.settings(_without_version(values)))

    @classmethod
    def _of(cls, native: _native.Design) -> Design:
        design = cls.__new__(cls)
        design._inside = native
        return design

    @classmethod
    def load(cls, file: Path, values: Mapping[str, Any] | None = None) -> Design:
        """The design of a file, with values that replace its own. A study is a design too.

        A file that is not there is looked for among the designs that Papilla brings.

        Raises InputError with file, line and column of every mistake.
        """
        return cls._of(_native.Design.read(v.path(file, "file"), v.settings(values)))

    @classmethod
    def parse(cls, toml: str, values: Mapping[str, Any] | None = None) -> Design:
        """The design of the text of a file. Raises InputError."""
        return cls._of(_native.Design.parse(v.text(toml, "toml"), v.settings(values)))

    @classmethod
    def from_heights(cls, z: npt.ArrayLike, size: Quantified, values: Mapping[str, Any] | None = None, *,
                     repeats: bool = True) -> Design:
        """A texture drawn or measured as an array.

        z: shape (n, n), real numbers [m], high touches first, n at least 8. size: width of the map ("6 um", 6e-6).
        values: all other keys, as of ``Design``. repeats: the map repeats by itself and is taken as it is, but for its
        zero: one period is enough, and is pressed as often side by side as textures of that period are. Else it is
        levelled, mended and made periodic as scans are (docs/how_to/scans.md): its middle, 1/1.2 of its width, which is
        refused below 3 um: on a patch shorter than the waves of skin friction is too high (of a flat map 8 % on 3 um,
        within 1 % from 6 um). The highest place is the untouched land, z = 0, whatever is added to the array; pillars on
        a film have "texture.top", their height.

        Raises InputError, naming "heights" or "size".
        """
        heights = v.height_map(z, "heights")
        dx, dy = v.pixel_size(heights.shape, size)
        return cls._of(_native.Design.from_heights(heights, dx, dy, v.settings(_without_version(values or {})),
                                                   v.flag(repeats, "repeats")))

    def with_(self, values: Mapping[str, Any] | None = None, **by_name: Any) -> Design:
        """The design with other values: ``d.with_({"texture.depth": "262 nm"})``, ``d.with_(**{...})``.

        All values are read together, so that those which go together (a diameter and its period) are given in one
        call. Of another kind, ``"texture.type"``, it has what is given here alone. The title says what was changed,
        unless it is given. Raises InputError.
        """
        return self._of(self._inside.with_(v.settings({**_without_version({} if values is None else values), **by_name})))

    def __getitem__(self, path: str) -> float:
        """A number by its key, SI: ``d["texture.depth"]``. Raises InputError for a key that is none."""
        return self._inside.number(v.text(path, "path"))

    @property
    def title(self) -> str:
        """Of the design, for people."""
        return self._inside.title()

    @property
    def numbers(self) -> list[Number]:
        """Every number that a key names, with unit, meaning and range."""
        return [Number(*row) for row in self._inside.numbers()]

    def to_toml(self) -> str:
        """The design as a file with every value and where it came from; it reads back to the same design.

        Of a design from an array it names a file of the moment, which goes with the design: ``save`` writes the heights
        beside the text.
        """
        return self._inside.toml()

    def to_dict(self) -> dict[str, float]:
        """Every number by its key, SI."""
        return {number.path: number.value for number in self.numbers}

    def save(self, file: Path) -> None:
        """Writes the design as a file; one of that name is replaced. Raises InputError for a name that is none of a file.

        Heights from an array lie beside it, float64 in metres: those of surface.toml in surface.heights.npy. A file of
        that name that holds others stays as it is, and they lie in surface.heights-2.npy, and so on; the design names
        the file that it has.
        """
        name = v.named_file(file, "file")
        text = self.to_toml()
        drawn = self._inside.drawn()
        if drawn is not None:
            beside = _kept_heights(os.path.splitext(name)[0], drawn.z)
            own = next(line for line in text.splitlines() if line.startswith(_MAP))
            text = text.replace(own, f"file = {json.dumps(os.path.basename(beside), ensure_ascii=False)}")
        v.write_file(name, text.encode())

    def heights(self, pixels: int = 512) -> Heights:
        """A patch of whole periods, ``pixels`` along x (8 to 16384).

        A design from an array gives z - z.max() to the last bit where ``pixels`` is its width, an even number.
        Raises InputError.
        """
        made = self._inside.heights(v.whole(pixels, "pixels", 8, 16384))
        return Heights(made.z, made.dx, made.dy)

    def look(self) -> Look:
        """Haze, transmittance, gloss and colour on glass. Takes a second; where the theory is "rigorous"
        (docs/theory/optics.md) half a minute and more."""
        return Look(**self._inside.look())

    def evaluate(self, level: str = "", target: float = 0.0, *, threads: int = 0, model: bool = True, parameters: bool = False,
                 look: bool = False, voltage_for: Sequence[float] = (), force: bool = False,
                 progress: Progress = None) -> Response:
        """Friction over humidity, drive off and on, with error bars: the numbers of ``papilla evaluate``.

        level: "draft" (1.6 s of a processor, with a belief 4 s more: ``model=False`` leaves that out), "design",
        "reference"; empty: the design's own. target: a relative standard error
        of the modulation in place of a level. threads: 0, all processors; the result is the same for any number.
        model: also what is not known of finger and model, where the finger names a belief.
        parameters: without belief, also the error that the finger's fitted numbers leave. look: also haze, gloss and colour.
        voltage_for: also the amplitudes that reach these modulations (``to_dict()["points"]``). force: with model
        options that the finger was not fitted with. progress: called with the number of skin patches done.

        Other threads run meanwhile; Ctrl-C ends it within a fifth of a second. Raises InputError, KeyboardInterrupt.
        """
        if level and target:
            raise wrong("target", "give a level or a target, not both: a target finds its own level")
        how = _how(level, target, threads, model, parameters, look, voltage_for, force)
        return Response(_native.evaluate(self._inside, how, shown(progress, "evaluate")))

    def sensitivity(self, metric: str = "mean(modulation)", keys: Sequence[str] = (), *, step: float = 0.05,
                    level: str = "", threads: int = 0, force: bool = False,
                    progress: Progress = None) -> list[Sensitivity]:
        """What each number does to a metric, by finite steps on common skins, with the error of the change.

        metric: of ``papilla describe metrics``. keys: empty, the numbers of the texture and its contact angle; a
        number that can move neither way is left out. step: relative to the value, of a 0 a share of its range. Cost:
        two evaluations a key. Raises InputError, KeyboardInterrupt.
        """
        rows = _native.sensitivity(self._inside, v.text(metric, "metric"), [v.text(k, "keys") for k in v.items(keys, "keys")],
                                   v.si(step, "", "step"), _how(level, 0.0, threads, False, False, False, (), force),
                                   shown(progress, "sensitivity"))
        return [Sensitivity(path, unit, value, down, up, Difference(*change), slope, error)
                for path, unit, value, down, up, change, slope, error in rows]

    def export(self, folder: Path, formats: Sequence[str] = (), *, size: Quantified = 0.0, pixels: int = 1024,
               polarity: str = "") -> Exported:
        """Files for makers, each read back and held against the design: ``papilla export``.

        formats: "exr", "gds", ...; empty: all that the texture allows. size: the wanted side, rounded to whole
        periods; 0: about 12 um. polarity: "white-high" or "white-deep", which tiff and mask need. Of a measured or drawn
        map the folder has its own copy. Raises InputError.
        """
        from papilla.trades import Exported

        files, warnings = _native.export_files(self._inside, v.path(folder, "folder"),
                                               [v.text(f, "formats") for f in v.items(formats, "formats")], v.si(size, "m", "size"),
                                               v.whole(pixels, "pixels", 8, 65536), v.text(polarity, "polarity"))
        return Exported(tuple(files), tuple(warnings))

    def __eq__(self, other: object) -> bool:
        """The same values, and maps with the same heights, whatever .npy file holds them; another format is another map."""
        if not isinstance(other, Design):
            return NotImplemented
        mine, theirs = _values_alone(self), _values_alone(other)
        return len(mine) == len(theirs) and all(a == b or _same_map(a, b) for a, b in zip(mine, theirs))

    def __hash__(self) -> int:
        return hash(frozenset(self.to_dict().items()))

    def __reduce__(self) -> tuple[Any, ...]:
        drawn = self._inside.drawn()
        if drawn is None:
            return _parsed, (self.to_toml(),)
        return _parsed_drawn, (self.to_toml(), np.array(drawn.z), drawn.dx, drawn.dy)

    def __copy__(self) -> Design:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Design:
        return self

    def __repr__(self) -> str:
        return f"<papilla.Design {self.title!r}>" if self.title else "<papilla.Design>"

    def _repr_html_(self) -> str:
        heights = self.heights(256)
        x = (np.arange(heights.z.shape[1]) + 0.5) * heights.dx
        lowest = np.unravel_index(int(heights.z.argmin()), heights.z.shape)[0]
        rows = [[n.path, _native.quantity_text(n.value, n.unit)] for n in self.numbers
                if n.path.startswith(("texture.", "surface.contact_angle", "drive.amplitude", "finger.load"))]
        title = f"<h4>{html.escape(self.title)}</h4>" if self.title else ""
        pictured = pictures.image(heights.z) + pictures.section(x, heights.z[lowest], "section")
        return title + pictures.beside([pictured, pictures.table(["key", "value"], rows)])


def compare(first: Design, second: Design, level: str = "", *, threads: int = 0, force: bool = False,
            progress: Progress = None) -> Comparison:
    """What the second design has more than the first, with the error of the difference.

    Both meet the same skins, droplets and grids, so what is common to them cancels. level: as of ``Design.evaluate``;
    empty: the first design's own. Raises InputError (other humidities), KeyboardInterrupt.
    """
    for name, design in (("first", first), ("second", second)):
        if not isinstance(design, Design):
            raise wrong(name, f"expected a Design, got {type(design).__name__}")
    how = _how(level, 0.0, threads, True, False, False, (), force)
    return Comparison(_native.compare(first._inside, second._inside, how, shown(progress, "compare")))


def _how(level: str, target: float, threads: int, model: bool, parameters: bool, look: bool,
         voltage_for: Sequence[float], force: bool) -> dict[str, Any]:
    share = v.si(target, "", "target")
    if not 0 <= share < 1:
        raise wrong("target", f"expected a share from 0 to 1, got {share}")
    return {"level": v.text(level, "level"), "target": share, "threads": v.whole(threads, "threads", 0, 4096),
            "model": v.flag(model, "model"), "parameters": v.flag(parameters, "parameters"), "look": v.flag(look, "look"),
            "voltage_for": [v.positive(m, "", "voltage_for") for m in v.items(voltage_for, "voltage_for")], "force": v.flag(force, "force")}


def _without_version(values: Mapping[str, Any]) -> Mapping[str, Any]:
    if not isinstance(values, Mapping):
        raise wrong("values", f"expected a dict of keys, got {type(values).__name__}")
    return {key: value for key, value in values.items() if not (key == "schema_version" and value == 1)}


def _kept_heights(stem: str, z: FloatArray) -> str:
    """Writes heights beside a design file and returns the name: that of a file with the same, else one nothing has."""
    stream = io.BytesIO()
    np.save(stream, z)
    data = stream.getbuffer()
    out = stem + ".heights.npy"
    copy = 2
    while os.path.lexists(out) and not _holds(out, data):
        out = f"{stem}.heights-{copy}.npy"
        copy += 1
    v.write_file(out, data)
    return out


def _holds(name: str, data: memoryview) -> bool:
    """Whether a file holds these bytes."""
    if not os.path.isfile(name) or os.path.getsize(name) != len(data):
        return False
    with open(name, "rb") as file:
        return file.read() == data


_COMMENT = re.compile(r'((?:[^"#]|"(?:[^"\\]|\\.)*")*).*')
"""A line of TOML and its comment, which no # within quotes begins."""


_MAP = 'file = "'


def _values_alone(design: Design) -> list[str]:
    """Lines without comments."""
    return [_COMMENT.sub(r"\1", line).rstrip() for line in design.to_toml().split("\n")]


def _same_map(a: str, b: str) -> bool:
    """Of two lines: they name files of heights that hold the same."""
    if not (a.startswith(_MAP) and b.startswith(_MAP)):
        return False
    first, second = (json.loads(line.split("=", 1)[1]) for line in (a, b))
    if not (os.path.isfile(first) and os.path.isfile(second)):
        return False
    if first.lower().endswith(".npy") and second.lower().endswith(".npy"):
        return np.array_equal(np.load(first), np.load(second))
    return filecmp.cmp(first, second, shallow=False)


def _parsed(toml: str) -> Design:
    return Design._of(_native.Design.parse(toml, []))


def _parsed_drawn(toml: str, z: FloatArray, dx: float, dy: float) -> Design:
    return Design._of(_native.Design.parse_drawn(toml, z, dx, dy))
