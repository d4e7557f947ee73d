"""Guards against geometry that nests without end, run before any recursive parser sees it.

GEOS and others read collections recursively, so a few hundred kilobytes of collections in collections
overflow the stack and end the process. Layers hold no collections anyway, so the guards never recurse:

    JSON text   brackets are counted, outside strings, before GDAL reads the file, in a .gz too
    WKB         a collection is refused at its first header; members of a multi geometry must be simple
    WKT         the word GEOMETRYCOLLECTION and deep brackets are refused
    objects     coordinates of __geo_interface__ are followed down to their depth in a loop

Other formats and archives reach GDAL as they are, which stops at some tens of levels by itself.
"""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import FileError, InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ._paths import Readable

DEEPEST_JSON = 128
DEEPEST_COORDINATES = 4
CHUNK_BYTES = 16 << 20
# Below this size even a chain of nothing but headers is too short to overflow a stack.
SMALL_WKB = 16 << 10
WKB_NAMES = {
    1: "Point", 2: "LineString", 3: "Polygon", 4: "MultiPoint", 5: "MultiLineString", 6: "MultiPolygon",
    7: "GeometryCollection", 8: "CircularString", 9: "CompoundCurve", 10: "CurvePolygon", 11: "MultiCurve",
    12: "MultiSurface", 15: "PolyhedralSurface", 16: "TIN", 17: "Triangle",
}  # fmt: skip
MEMBERS = {4: 1, 5: 2, 6: 3}
NOT_BRACKETS = bytes(byte for byte in range(256) if byte not in b"[]{}")


def check_json(stream: Readable, name: str) -> None:
    """Raise FileError when `stream` is JSON text that nests deeper than any geometry does.

    Reads to the end of what starts like JSON and only the start of anything else. name: for messages.
    """
    chunk = stream.read(1024)
    if not chunk.lstrip(b"\xef\xbb\xbf\x1e \t\r\n").startswith((b"{", b"[")):
        return
    depth, in_string = 0, False
    while chunk:
        while chunk.endswith(b"\\") and (more := stream.read(1)):
            chunk += more
        # Escaped characters go first, so that every quote left opens or closes a string.
        pieces = chunk.replace(b"\\\\", b"").replace(b'\\"', b"").split(b'"')
        outside = b"".join(pieces[1 if in_string else 0 :: 2])
        in_string ^= len(pieces) % 2 == 0
        brackets = np.frombuffer(outside.translate(None, NOT_BRACKETS), dtype=np.uint8)
        steps = np.where((brackets == ord("[")) | (brackets == ord("{")), 1, -1)
        depths = depth + np.cumsum(steps)
        if depths.size:
            if int(depths.max()) > DEEPEST_JSON:
                raise FileError(
                    f"{name!r} nests brackets more than {DEEPEST_JSON} deep, which no map layer needs, so it"
                    " is not opened. Write its geometry collections out as single features."
                )
            depth = int(depths[-1])
        chunk = stream.read(CHUNK_BYTES)


def wkb_type(blob: bytes, position: int = 0) -> int:
    """The plain type code (1 to 17) of the WKB header at `position`; 0 when there is none."""
    if len(blob) < position + 5:
        return 0
    code = struct.unpack_from("<I" if blob[position] == 1 else ">I", blob, position + 1)[0]
    return int((code & 0x0FFFFFFF) % 1000)


def check_wkb(blobs: Iterable[bytes | None], layer_name: str) -> None:
    """Raise InputError at the first blob that GEOS should not be given."""
    for row, blob in enumerate(blobs):
        if blob is None or len(blob) < 5:
            continue
        kind = wkb_type(blob)
        if kind == 7 and _is_bare(blob):
            continue
        if kind == 7 or kind not in WKB_NAMES or kind > 7:
            raise InputError(unsupported_type(layer_name, row, WKB_NAMES.get(kind, f"WKB type {kind}")))
        if kind in MEMBERS and len(blob) > SMALL_WKB and not _members_are_simple(blob, MEMBERS[kind]):
            raise InputError(
                f"Layer {layer_name!r} holds a damaged {WKB_NAMES[kind]} at row {row}: its members are not of"
                f" type {WKB_NAMES[MEMBERS[kind]]} or it is cut short. Write the layer anew from its source."
            )


def unsupported_type(layer_name: str, row: int, type_name: str) -> str:
    """The message for a geometry type that no layer draws."""
    cure = (
        "Split collections with gdf.explode() and keep one type of geometry a layer."
        if type_name == "GeometryCollection"
        else "Turn curves into straight segments first, for instance with ogr2ogr -nlt CONVERT_TO_LINEAR."
    )
    return f"Layer {layer_name!r} holds a {type_name} at row {row}, which cannot be drawn. {cure}"


def _members_are_simple(blob: bytes, member: int) -> bool:
    """Whether every member of a multi geometry is of type `member` and lies inside the blob."""
    try:
        position = _after_header(blob, 0) + 4
        for _ in range(_count(blob, 0, position - 4)):
            if wkb_type(blob, position) != member:
                return False
            position = _after_member(blob, position, member)
    except struct.error:
        return False
    return position <= len(blob)


def _is_bare(blob: bytes) -> bool:
    try:
        return _count(blob, 0, _after_header(blob, 0)) == 0
    except struct.error:
        return False


def _after_header(blob: bytes, position: int) -> int:
    # EWKB carries an SRID of four bytes after the type when this bit is set.
    code = struct.unpack_from("<I" if blob[position] == 1 else ">I", blob, position + 1)[0]
    return position + 5 + (4 if code & 0x20000000 else 0)


def _count(blob: bytes, header: int, position: int) -> int:
    return int(struct.unpack_from("<I" if blob[header] == 1 else ">I", blob, position)[0])


def _after_member(blob: bytes, header: int, member: int) -> int:
    code = struct.unpack_from("<I" if blob[header] == 1 else ">I", blob, header + 1)[0]
    flags, thousands = code >> 30, (code & 0x0FFFFFFF) // 1000
    dimensions = 2 + (flags & 1) + (flags >> 1) if flags else 2 + (0, 1, 1, 2)[min(thousands, 3)]
    point = 8 * dimensions
    position = _after_header(blob, header)
    if member == 1:
        return position + point
    sequences = 1
    if member == 3:
        sequences, position = _count(blob, header, position), position + 4
    for _ in range(sequences):
        position += 4 + point * _count(blob, header, position)
    return position


WKT_SIGNS = re.compile(r"[()]")


def check_wkt(texts: Iterable[str | None], layer_name: str) -> None:
    """Raise InputError at the first text that is a collection or nests deeper than a multi polygon."""
    for row, text in enumerate(texts):
        if text is None:
            continue
        word = text.lstrip()[:64].upper()
        if "COLLECTION" in word or "CURVE" in word or "SURFACE" in word:
            name = "GeometryCollection" if "COLLECTION" in word else word.split("(")[0].strip().title()
            raise InputError(unsupported_type(layer_name, row, name))
        depth = 0
        for sign in WKT_SIGNS.findall(text):
            depth += 1 if sign == "(" else -1
            if depth > DEEPEST_COORDINATES:
                raise InputError(
                    f"Layer {layer_name!r} holds WKT at row {row} whose brackets nest more than"
                    f" {DEEPEST_COORDINATES} deep, as no geometry does. Write the layer anew from its source."
                )


def coordinates_depth(coordinates: Any) -> int:
    """How deep the first number of nested coordinates lies; at most DEEPEST_COORDINATES + 1."""
    depth = 0
    while isinstance(coordinates, (list, tuple, np.ndarray)) and depth <= DEEPEST_COORDINATES:
        depth += 1
        if len(coordinates) == 0:
            break
        coordinates = coordinates[0]
    return depth
