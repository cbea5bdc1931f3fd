"""Numbers, units and arrays on their way into the library."""

from __future__ import annotations

import contextlib
import json
import math
import os
import re
import secrets
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from papilla import _native
from papilla.errors import InputError, Problem, wrong

__all__ = ["FloatArray", "Path", "Quantified"]

FloatArray = npt.NDArray[np.float64]
Path = Union[str, "os.PathLike[str]"]
Quantified = Union[str, float]
"""A number with its unit, "350 nm", or a number in the SI unit, 350e-9."""

class WithArrays:
    """A dataclass with arrays among its members: equal to another of the same members, arrays item by item (what is no
    number equals what is none); its representation tells the shapes of its arrays, and the ends of long texts, in place
    of all of them. Of its subclasses the decorator has eq=False, repr=False."""

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(value, vars(other)[name]) for name, value in vars(self).items())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        shown = (f"{name}={_brief(value)}" for name, value in vars(self).items() if not name.startswith("_"))
        return f"{type(self).__name__}({', '.join(shown)})"


def _same(a: Any, b: Any) -> bool:
    """Of two members; numbers and arrays of them with what is no number."""
    if isinstance(a, (float, np.ndarray)) and isinstance(b, (float, np.ndarray)):
        return np.array_equal(a, b, equal_nan=True)
    return bool(a == b)


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"<{' x '.join(map(str, value.shape))} {value.dtype}>"
    if isinstance(value, str) and len(value) > 60:
        return repr(value[:57] + "...")
    if isinstance(value, (list, tuple, dict)) and len(value) > 6:
        return f"<{len(value)} items>"
    return repr(value)


def masked(value: object) -> int:
    """How many values of a masked array are masked: what numpy has below its mask (0, 1e20) is no number."""
    return int(np.count_nonzero(np.asarray(value.mask))) if isinstance(value, np.ma.MaskedArray) else 0


def unmasked(value: Any, key: str) -> None:
    """Raises InputError where values are masked."""
    if (hidden := masked(value)):
        raise wrong(key, f"{hidden} of {np.size(value)} values are masked and have no number: fill them, x.filled(...), "
                         "or leave them out")


def fixed(numbers: npt.ArrayLike, key: str = "values") -> FloatArray:
    """A copy that nobody can write to."""
    unmasked(numbers, key)
    out = np.array(numbers, dtype=np.float64)
    out.flags.writeable = False
    return out


# Sections of a study: their numbers are written with units, as in its file.
STUDY_SECTIONS = {"design_space", "objective", "constraints", "population", "scenarios", "scatter",
                  "search"}
_KEY = re.compile(r"[A-Za-z0-9_.() =+-]+")
_ARGUMENTS = re.compile(r"\([^()]*\)")


def si(value: Quantified, unit: str, key: str) -> float:
    """The value in SI; a text must have the dimension of ``unit``."""
    if isinstance(value, str):
        try:
            return _native.in_si(_unicode(value, key), unit)
        except InputError as error:
            raise InputError([Problem("", 0, 0, key, p.message) for p in error.problems]) from None
    number = _number(value, key)
    if not math.isfinite(number):
        raise wrong(key, f"expected a finite number, got {number}")
    return number


def _plain(value: object, key: str) -> object:
    """Of an array without axes its one number. Raises InputError where values are masked."""
    unmasked(value, key)
    return value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value


def _number(value: object, key: str) -> float:
    value = _plain(value, key)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise wrong(key, f"expected a number or a text with a unit, got {type(value).__name__}")
    try:
        return float(value)
    except OverflowError:
        raise wrong(key, "expected a number of 64 bits, at most 1.8e308") from None


def whole(value: object, key: str, low: int, high: int) -> int:
    """A whole number within its range."""
    value = _plain(value, key)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise wrong(key, f"expected a whole number, got {type(value).__name__}")
    if not low <= int(value) <= high:
        raise wrong(key, f"{int(value)} is outside {low} to {high}")
    return int(value)


def positive(value: Quantified, unit: str, key: str) -> float:
    number = si(value, unit, key)
    if number <= 0:
        raise wrong(key, "must be positive")
    return number


def flag(value: object, key: str) -> bool:
    value = _plain(value, key)
    if not isinstance(value, (bool, np.bool_)):
        raise wrong(key, f"expected True or False, got {type(value).__name__}")
    return bool(value)


def text(value: object, key: str) -> str:
    if not isinstance(value, str):
        raise wrong(key, f"expected a text, got {type(value).__name__}")
    return _unicode(value, key)


def _unicode(value: str, key: str) -> str:
    """The text. Raises InputError for one that is none, as names of files are that are not in UTF-8."""
    try:
        value.encode()
    except UnicodeEncodeError:
        raise wrong(key, f"expected a text of Unicode characters, got {value!r}") from None
    return value


def items(values: Any, key: str) -> list[Any]:
    """The items of a sequence; a single text or number is one item, not its letters."""
    values = _plain(values, key)
    if isinstance(values, (str, int, float, np.generic)):
        return [values]
    if isinstance(values, Mapping) or not isinstance(values, Iterable):
        raise wrong(key, f"expected a list, got {type(values).__name__}")
    return list(values)


def path(value: Path, key: str) -> str:
    if not isinstance(value, (str, os.PathLike)):
        raise wrong(key, f"expected the name of a file, got {type(value).__name__}")
    return text(os.fspath(value), key)


def named_file(value: Path, key: str) -> str:
    """The name of a file to write: none of a folder, in a folder that is there."""
    name = path(value, key)
    folder, base = os.path.split(name)
    if os.path.isdir(name) or not base:
        raise wrong(key, f"{name!r} is a folder: expected the name of a file" if base or name else
                    "expected the name of a file, got an empty text")
    if folder and not os.path.isdir(folder):
        raise wrong(key, f"the folder {folder} is not there: make it first")
    return name


# Files in folders that anybody may have made: nothing is written through a link, and nothing read that is no file.


def write_file(name: str, data: bytes | memoryview) -> None:
    """Whole or not at all, with the mode of the file that it replaces; a link of the name is replaced, not followed."""
    folder, base = os.path.split(name)
    part = os.path.join(folder, f".{base[:40]}.{secrets.token_hex(8)}.part")  # a name that nobody can put a link at
    try:
        handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    except OSError as error:
        error.filename = name  # as its caller knows it
        raise
    try:
        with open(handle, "wb") as stream:
            stream.write(data)
            if os.path.isfile(name) and not os.path.islink(name):
                os.fchmod(handle, os.stat(name).st_mode & 0o777)
            stream.flush()
            os.fsync(handle)
        os.replace(part, name)
    except BaseException:
        os.unlink(part)
        raise


def text_in(folder: str, name: str, expected: str) -> str:
    """A text in a folder. Raises InputError where it is no file: a pipe would wait for ever, a device never end."""
    place = os.path.join(folder, name)
    if not os.path.isfile(place):
        raise wrong("folder", f"{folder} holds no {name}: expected {expected}")
    try:
        with open(place, encoding="utf-8") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise wrong("folder", f"cannot read {place}: {error}") from None


@contextlib.contextmanager
def as_written(place: str) -> Iterator[None]:
    """What is taken from a document that is not as it was written is an InputError, whatever Python calls it."""
    try:
        yield
    except InputError:
        raise
    except (AttributeError, IndexError, KeyError, RecursionError, TypeError, ValueError) as error:
        raise wrong("folder", f"{place} is not as papilla writes it ({type(error).__name__}: {error}): "
                              "make its folder anew") from None


def document_in(folder: str, name: str, expected: str) -> dict[str, Any]:
    """A JSON object in a folder. Raises InputError."""
    with as_written(os.path.join(folder, name)):
        out: dict[str, Any] = json.loads(text_in(folder, name, expected))
        out.keys()
        return out


def paths(values: Path | Sequence[Path], key: str) -> list[str]:
    """One name of a file, or several."""
    several = [values] if isinstance(values, (str, os.PathLike)) else items(values, key)
    return [path(one, key) for one in several]


def height_map(z: npt.ArrayLike, key: str) -> FloatArray:
    """A map of numbers, shape (ny, nx): real, finite, none masked, 2 x 2 pixels at least."""
    for part in z if isinstance(z, (list, tuple)) else [z]:  # of rows in a list numpy.asarray drops the masks
        unmasked(part, key)
    try:
        array = np.asarray(z)
    except ValueError:
        raise wrong(key, "expected an array of shape (ny, nx), got rows of several lengths") from None
    if array.dtype.kind not in "fiu":
        raise wrong(key, f"expected an array of real numbers, got dtype {array.dtype}")
    if array.ndim != 2:
        raise wrong(key, f"expected an array of shape (ny, nx), got shape {array.shape}")
    if min(array.shape) < 2 or array.size > 2**28:
        raise wrong(key, f"expected 2 x 2 to 2**28 pixels, got shape {array.shape}")
    out = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(out).all():
        raise wrong(key, f"{int((~np.isfinite(out)).sum())} of {out.size} values are not finite")
    return out


def pixel_size(shape: tuple[int, ...], size: Quantified | Sequence[Quantified],
               key: str = "size") -> tuple[float, float]:
    """dx, dy [m] of a map (ny, nx) as large as ``size``: its width, or width and height."""
    ny, nx = shape
    size = _plain(size, key)  # type: ignore[assignment]
    if isinstance(size, (list, tuple, np.ndarray)):
        if len(size) != 2:
            raise wrong(key, f"expected a width, or a width and a height, got {len(size)} values")
        return positive(size[0], "m", key) / nx, positive(size[1], "m", key) / ny
    dx = positive(size, "m", key) / nx  # type: ignore[arg-type]
    return dx, dx


def settings(values: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Keys and values as the library reads them: nested sections by their path."""
    if values is None:
        return []
    if not isinstance(values, Mapping):
        raise wrong("values", f"expected a dict of keys, got {type(values).__name__}")
    return list(_flat("", values))


def _is_key(name: str) -> bool:
    """Whether a text may be one: a = stands among the arguments of a metric alone, voltage_for(modulation = 0.5)."""
    outside, found = name, 1
    while found:
        outside, found = _ARGUMENTS.subn("", outside)
    return _KEY.fullmatch(name) is not None and "=" not in outside


def _flat(prefix: str, values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        if not isinstance(name, str) or not _is_key(name):
            raise wrong(prefix + str(name), "expected the name of a key")
        key = prefix + name
        if isinstance(value, Mapping):
            yield from _flat(key + ".", value)
        else:
            bare_is_si = key.split(".", 1)[0] not in STUDY_SECTIONS
            yield key + (":" if bare_is_si else ""), _toml(value, key)


def _toml(value: Any, key: str) -> str:
    unmasked(value, key)
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise wrong(key, f"expected a finite number, got {value}")
        return repr(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        if "\x7f" in value:
            raise wrong(key, "expected a text without control characters")
        return json.dumps(_unicode(value, key), ensure_ascii=False)
    if isinstance(value, Mapping):
        members = (f"{json.dumps(str(k), ensure_ascii=False)} = {_toml(v, f'{key}.{k}')}"
                   for k, v in value.items())
        return "{ " + ", ".join(members) + " }"
    if isinstance(value, Iterable) and not isinstance(value, (bytes, bytearray, Set)):  # sets have no order
        return "[" + ", ".join(_toml(v, f"{key}.{i}") for i, v in enumerate(value)) + "]"
    raise wrong(key, f"expected a number, a text, a list or a dict, got {type(value).__name__}")
