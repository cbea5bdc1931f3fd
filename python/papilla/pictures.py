"""Pictures for notebooks, made of numbers: PNG of a map, SVG of a section, tables of HTML."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from papilla.values import FloatArray

_LOW, _MIDDLE, _HIGH = (0x44, 0x01, 0x54), (0x21, 0x91, 0x8C), (0xFD, 0xE7, 0x25)


def png(z: FloatArray) -> bytes:
    """A map as colours, low dark to high bright; the last row on top, as y grows upwards."""
    low, high = float(z.min()), float(z.max())
    share = (z[::-1] - low) / (high - low) if high > low else np.zeros_like(z)
    colours = np.stack([np.interp(share, [0, 0.5, 1], [_LOW[c], _MIDDLE[c], _HIGH[c]])
                        for c in range(3)], axis=-1).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in colours)
    ny, nx = z.shape
    head = struct.pack(">IIBBBBB", nx, ny, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", head) + _chunk(b"IDAT", zlib.compress(rows))
            + _chunk(b"IEND", b""))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def image(z: FloatArray, width: int = 240) -> str:
    data = base64.b64encode(png(z)).decode()
    return f'<img width="{width}" alt="heights" src="data:image/png;base64,{data}">'


def section(x: FloatArray, z: FloatArray, label: str) -> str:
    """A line of heights over x as SVG; the axes say their ends in um and nm."""
    low, high = float(z.min()), float(z.max())
    span = high - low or 1e-9
    points = " ".join(f"{20 + 300 * (a - x[0]) / (x[-1] - x[0]):.1f},{90 - 60 * (b - low) / span:.1f}"
                      for a, b in zip(x, z))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="340" height="120" font-size="11" '
            f'font-family="sans-serif"><polyline points="{points}" fill="none" stroke="#1b6ca8" '
            f'stroke-width="1.5"/><text x="20" y="112">{html.escape(label)}: '
            f'{1e6 * (x[-1] - x[0]):.3g} um wide, {1e9 * (high - low):.4g} nm high</text></svg>')


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table><thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"


def beside(parts: Sequence[str]) -> str:
    cells = "".join(f'<div style="margin-right:1em">{part}</div>' for part in parts)
    return f'<div style="display:flex;align-items:flex-start">{cells}</div>'


def numbers(values: npt.ArrayLike, digits: int = 4) -> list[str]:
    return [f"{value:.{digits}g}" for value in np.asarray(values).ravel()]
