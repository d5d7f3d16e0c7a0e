"""Reader of `.subsurf` files, version 1.0: scattering of translucent materials, for use with numpy.

`load(path_or_bytes)` returns a `Bssrdf`, `NestedBtf`, `FactoredBtf`, `Kernel` or `Transfer`. Everything that the
specification (FORMAT.md) wants checked is checked there; what is wrong with a file is said by a `FormatError`.
The last axis of colours is red, green, blue: linear Rec. 709 primaries with white D65. Lengths are in mm.
"""
from __future__ import annotations

import contextlib
import math
import os
import struct
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["load", "FormatError", "SubsurfFile", "Bssrdf", "SeparableBasis", "Btf", "Material", "NestedBtf",
           "FactoredBtf", "Kernel", "Transfer"]

Source = Union[bytes, bytearray, memoryview, str, "os.PathLike[str]"]
Ints = NDArray[np.int64]
Array = NDArray[np.float64]
Singles = NDArray[np.float32]
Nodes = list[tuple[Ints, Array]]  # of two or four nodes, their numbers and weights

MAGIC = b"\x89SSF\r\n\x1a\n"
HEADERS = ("BSSR", "BTFH", "KERN", "XFER")
STAGE_KINDS = {f"P{p}S{s}" for p in (6, 4, 3, 2, 1) for s in range(4)}
KNOWN_KINDS = set(HEADERS) | STAGE_KINDS | {
    "PROF", "PRFH", "MIXR", "BIDX", "MIX8", "CODE", "PAIR", "LSPP", "sepb", "MATS", "BOOK", "MERG", "CHR2", "CHR1",
    "CHRC", "TINT", "FACT", "AXES", "CORE", "WORD", "INDX", "KOFF", "KWGT", "TAIL", "twog", "XDIR", "XAXS", "XRNG", "XMEA",
    "XBAS", "XVTX", "meta"}

MAX_TABLE = 1 << 28
"""Bytes that the expanded table of a factored BTF may take; a limit of this reader, the format has none."""


class FormatError(ValueError):
    """What is wrong with a file: `section`, `offset` from the start of the file, `value` and what is `allowed`."""

    def __init__(self, section: str, offset: int, value: object, allowed: str) -> None:
        super().__init__(f"{section}: byte {offset}: {value}; expected {allowed}")
        self.section, self.offset, self.value, self.allowed = section, offset, value, allowed


def load(source: Source, check_crc: bool = True) -> SubsurfFile:
    """File read and checked, from its path or its bytes. `check_crc=False` leaves out the CRCs of sections."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        data = bytes(source)
    else:
        with open(source, "rb") as file:
            data = file.read()
    container = _Container(data, check_crc)
    family = container.family()
    if family == "BSSR":
        return Bssrdf(container)
    if family == "KERN":
        return Kernel(container)
    if family == "XFER":
        return Transfer(container)
    model = container.section("BTFH").at_least(36).integer(0, "B", (1, 2))
    return NestedBtf(container) if model == 1 else FactoredBtf(container)


# ---------------------------------------------------------------------------------------------------------------------
# Container


def _f32(value: float) -> float:
    """Value of the nearest f32."""
    return float(np.float32(value))


def _words(allowed: Sequence[int]) -> str:
    """Text for whole numbers that are allowed."""
    if isinstance(allowed, range) and len(allowed) > 1:
        return f"{allowed[0]} to {allowed[-1]}" + (f" in steps of {allowed.step}" if allowed.step > 1 else "")
    return " or ".join(str(number) for number in allowed)


class _Section:
    """Bytes of a section, read with checks. Positions count from its start; errors count from that of the file."""

    def __init__(self, kind: str, data: memoryview, start: int) -> None:
        self.kind, self.data, self.start = kind, data, start

    def error(self, at: int, value: object, allowed: str) -> FormatError:
        return FormatError(self.kind, self.start + at, value, allowed)

    def exactly(self, size: int) -> _Section:
        if len(self.data) != size:
            raise self.error(0, f"a size of {len(self.data)} bytes", f"{size} bytes")
        return self

    def at_least(self, size: int) -> _Section:
        if len(self.data) < size:
            raise self.error(0, f"a size of {len(self.data)} bytes", f"at least {size} bytes")
        return self

    def integer(self, at: int, code: str, allowed: Sequence[int]) -> int:
        """Whole number of `struct` type `code` that is one of `allowed`."""
        (value,) = struct.unpack_from("<" + code, self.data, at)
        if value not in allowed:
            raise self.error(at, value, _words(allowed))
        return value

    def real(self, at: int, low: float, high: float) -> float:
        """Number of type f32 within the nearest f32 of `low` and `high`."""
        return float(self.reals("<f4", (1,), low, high, at)[0])

    def array(self, dtype: str, shape: tuple[int, ...], at: int = 0) -> NDArray:
        """View of the bytes from `at`, not checked. Shape as given, read-only."""
        return np.frombuffer(self.data, dtype, math.prod(shape), at).reshape(shape)

    def reals(self, dtype: str, shape: tuple[int, ...], low: float, high: float, at: int = 0) -> NDArray:
        """View of real numbers within the nearest f32 of `low` and `high`."""
        values = self.array(dtype, shape, at)
        with np.errstate(invalid="ignore"):
            self.check(values, (values >= _f32(low)) & (values <= _f32(high)), f"{low:g} to {high:g}", at)
        return values

    def indices(self, dtype: str, shape: tuple[int, ...], count: int) -> NDArray:
        """View of whole numbers below `count` that fill the section."""
        values = self.exactly(math.prod(shape) * np.dtype(dtype).itemsize).array(dtype, shape)
        self.check(values, values < count, f"an index below {count}")
        return values

    def check(self, values: NDArray, is_good: NDArray, allowed: str, at: int = 0, stride: int | None = None) -> None:
        """Refusal of the first of `values` that is not good; they begin at `at`, `stride` bytes apart."""
        if not is_good.all():
            first = int(np.argmin(is_good))
            raise self.error(at + first * (stride or values.itemsize), values.flat[first], allowed)


class _Entry(NamedTuple):
    crc: int
    offset: int
    length: int


class _Container:
    """Sections of a file by their kinds."""

    def __init__(self, data: bytes, check_crc: bool) -> None:
        self._check_crc = check_crc
        self._data = memoryview(data)
        header = _Section("file header", self._data, 0)
        if data[:8] != MAGIC:
            raise header.error(0, data[:8], f"{MAGIC!r}")
        header.at_least(28)
        self.version = (header.integer(8, "H", (1,)), header.integer(10, "H", range(0x10000)))
        count = header.integer(12, "I", range(1, 65))
        (file_bytes,) = struct.unpack_from("<Q", data, 16)
        header.at_least(max(file_bytes, 28 + 24 * count))
        end = 24 + 24 * count
        (stored,) = struct.unpack_from("<I", data, end)
        if stored != zlib.crc32(self._data[:end]):
            raise header.error(end, f"a CRC-32 of {stored:08x}", f"{zlib.crc32(self._data[:end]):08x}")
        self._data = self._data[:file_bytes]
        self.entries = self._table(header, count, file_bytes)

    @staticmethod
    def _table(header: _Section, count: int, file_bytes: int) -> dict[str, _Entry]:
        """Section table, its kinds and places checked."""
        entries: dict[str, _Entry] = {}
        free = 28 + 24 * count
        for at in range(24, 24 + 24 * count, 24):
            kind, crc, offset, length = struct.unpack_from("<4sIQQ", header.data, at)
            name = kind.decode("latin-1")
            if name in entries:
                raise header.error(at, name, "each kind once")
            if name not in KNOWN_KINDS and not "a" <= name[0] <= "z":
                raise header.error(at, name, "a kind of version 1.0, or one that may be skipped")
            if offset < free:
                raise header.error(at + 8, offset, f"an offset of {name} of at least {free}")
            if offset + length > file_bytes:
                raise header.error(at + 16, length, f"{name} to end within {file_bytes} bytes")
            entries[name] = _Entry(crc, offset, length)
            free = offset + length
        return entries

    def family(self) -> str:
        """Kind of the file's only header section."""
        found = [kind for kind in HEADERS if kind in self.entries]
        if len(found) != 1:
            raise FormatError("file header", 24, " and ".join(found) or "no header", "one of " + ", ".join(HEADERS))
        return found[0]

    def has(self, kind: str) -> bool:
        return kind in self.entries

    def section(self, kind: str) -> _Section:
        """Section that must be there, with its CRC checked."""
        if kind not in self.entries:
            raise FormatError("file header", 24, f"no section {kind}", "all sections of the family and model")
        entry = self.entries[kind]
        section = _Section(kind, self._data[entry.offset:entry.offset + entry.length], entry.offset)
        if self._check_crc and zlib.crc32(section.data) != entry.crc:
            raise section.error(0, f"a CRC-32 of {zlib.crc32(section.data):08x}", f"{entry.crc:08x}")
        return section


class SubsurfFile:
    """File of any family. `version`: major and minor number; `kinds`: its sections, in order."""

    def __init__(self, container: _Container) -> None:
        self._container = container
        self.version: tuple[int, int] = container.version
        self.kinds: tuple[str, ...] = tuple(container.entries)

    def metadata(self) -> dict[str, str]:
        """Entries of `meta`, text from strangers. A key that stands twice has its last value."""
        if not self._container.has("meta"):
            return {}
        data = bytes(self._container.section("meta").data)
        entries: dict[str, str] = {}
        at = 0
        while at + 4 <= len(data):
            key_bytes, value_bytes = struct.unpack_from("<BxH", data, at)
            middle = at + 4 + key_bytes
            end = middle + value_bytes
            if end > len(data):
                break
            with contextlib.suppress(UnicodeDecodeError):
                if key_bytes:
                    entries[data[at + 4:middle].decode("utf-8")] = data[middle:end].decode("utf-8")
            at = end
        return entries


def _whole(values: ArrayLike) -> Ints:
    """Array of whole numbers from what a caller gave."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu":
        raise TypeError(f"whole numbers are needed, not {array.dtype}")
    return array.astype(np.int64)


# ---------------------------------------------------------------------------------------------------------------------
# Diffuse BSSRDF


@dataclass(frozen=True)
class SeparableBasis:
    """Sum of separable blurs in place of a sum over the window.

    sigma: [A] widths of the blurs in pixels. weights: [L, L, A, 3] w_lma, symmetric in l and m.
    d: [L, S, 3] in mm, what a coefficient c_l takes of each node.
    """

    sigma: Singles
    weights: Singles
    d: Singles

    def taps(self) -> list[tuple[int, Array]]:
        """Stages of the blur: the distance s of taps in pixels, and their weights, [2 t + 1] of sum 1."""
        stages = []
        before = 0.0
        for sigma in self.sigma.astype(np.float64):
            k = np.arange(-math.ceil(12 * sigma) - 1, math.ceil(12 * sigma) + 2)
            gaussian = np.exp(-0.5 * (k / sigma) ** 2)
            variance = max(float((k * k * gaussian).sum() / gaussian.sum()) - before, 1e-6)
            spacing = max(1, math.floor(1.8 * math.sqrt(before)))
            reach = min(max(1, math.ceil(3.2 * math.sqrt(variance) / spacing)), 63)
            stages.append((spacing, _taps_of_variance(spacing, reach, variance)))
            before += variance
        return stages


def _taps_of_variance(spacing: int, reach: int, variance: float) -> Array:
    """Weights of a Gaussian at multiples of `spacing` whose width gives them `variance`; bisection of the width."""
    at = spacing * np.arange(-reach, reach + 1, dtype=np.float64)
    low, high = spacing / 40, 10 * (math.sqrt(variance) + spacing)
    for _ in range(80):
        width = 0.5 * (low + high)
        taps = np.exp(-0.5 * (at / width) ** 2)
        taps /= taps.sum()
        if (taps * at * at).sum() < variance:
            low = width
        else:
            high = width
    return taps


class Bssrdf(SubsurfFile):
    """Diffuse BSSRDF of a flat patch of width × height pixels; pixel (x, y) is in column x of row y from the top.

    model: 0 for a profile per pixel, else K = 1, 2, 3 or 5 base materials per pixel.
    coding: "exact", "small ratios" or "palette". addressing: "clamp", "repeat" or "mirror".
    width, height, window_radius (R): pixels. samples: S nodes of a profile. pitch, r_max: mm. eta: 1 to 4.
    bases: [M, S, 3] base scattering profiles, natural log of mm⁻², −87 to 87; M is 0 for model 0.
    indices: [K, height, width] base materials of the pixels, below M.
    ratios: [K, height, width] their shares, 0 to 1, of sum 1.
    local: [S, 3, height, width] profiles of the pixels, natural log of mm⁻²; None for other models than 0.
    basis: `SeparableBasis` or None.

    Methods take whole pixel coordinates, scalars or arrays that broadcast, also outside the patch.
    """

    indices: NDArray[np.integer]
    local: Singles | None = None
    basis: SeparableBasis | None = None

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        header = container.section("BSSR").at_least(32)
        self.model = header.integer(0, "B", (0, 1, 2, 3, 5))
        header.integer(1, "B", (1,))
        self.addressing = ("clamp", "repeat", "mirror")[header.integer(2, "B", range(3))]
        coding = header.integer(3, "B", range(3 if self.model == 2 else 1))
        self.coding = ("exact", "small ratios", "palette")[coding]
        self.width = header.integer(4, "I", range(1, 65536))
        self.height = header.integer(8, "I", range(1, 65536))
        self.window_radius = header.integer(12, "H", range(1024))
        self.samples = header.integer(14, "H", range(2, 4097))
        materials = {0: range(1), 1: range(1, 65537)}.get(self.model, range(1, 257))
        self._read_profiles(container, header.integer(16, "I", materials))
        self.pitch = header.real(20, 1e-6, 1e6)
        self.r_max = header.real(24, 1e-6, 1e6)
        self.eta = header.real(28, 1, 4)
        if container.has("sepb"):
            self.basis = self._read_basis(container.section("sepb"))

    def __repr__(self) -> str:
        what = f"{self.model} of {len(self.bases)} bases, {self.coding}" if self.model else "a profile per pixel"
        return (f"Bssrdf({self.width} × {self.height} pixels of {self.pitch:g} mm, {what}, S {self.samples}, "
                f"r_max {self.r_max:g} mm, R {self.window_radius}, {self.addressing}, eta {self.eta:g})")

    def _read_profiles(self, container: _Container, materials: int) -> None:
        if self.model == 0:
            section = container.section("LSPP").exactly(12 * self.samples * self.height * self.width)
            self.local = section.reals("<f4", (self.samples, 3, self.height, self.width), -87, 87)
            self.bases = np.empty((0, self.samples, 3), np.float32)
            self.indices, self.ratios = (np.empty((0, self.height, self.width), dtype) for dtype in ("u1", "f4"))
            return
        kind, dtype = ("PRFH", "<f2") if container.has("PRFH") else ("PROF", "<f4")
        shape = (materials, self.samples, 3)
        section = container.section(kind).exactly(math.prod(shape) * np.dtype(dtype).itemsize)
        self.bases = section.reals(dtype, shape, -87, 87).astype(np.float32)
        if self.coding == "palette":
            self.indices, self.ratios = self._read_palette(container, materials)
        else:
            self.indices = self._read_indices(container, materials)
            self.ratios = self._read_ratios(container)

    def _read_indices(self, container: _Container, materials: int) -> NDArray[np.integer]:
        section, plane = container.section("BIDX"), (self.height, self.width)
        if self.model == 1:
            return section.indices("<u2" if materials > 256 else "u1", plane, materials)[np.newaxis]
        if self.model == 2:
            return np.moveaxis(section.indices("u1", (*plane, 2), materials), 2, 0)
        return section.indices("u1", (self.model, *plane), materials)

    def _read_ratios(self, container: _Container) -> Singles:
        plane = (self.height, self.width)
        if self.model == 1:
            return np.broadcast_to(np.float32(1), (1, *plane))
        if self.coding == "small ratios":
            codes = container.section("MIX8").exactly(math.prod(plane)).array("u1", plane)
            return _with_rest(codes.astype(np.float32) / 255)
        shape = plane if self.model == 2 else (self.model, *plane)
        section = container.section("MIXR").exactly(4 * math.prod(shape))
        ratios = section.reals("<f4", shape, 0, 1)
        section.check(ratios, ~np.signbit(ratios), "0 to 1, not −0")
        if self.model == 2:
            return _with_rest(ratios)
        total = np.zeros(plane, np.float32)
        for ratio in ratios:
            total = total + ratio
        is_one = (total >= np.float32(1 - 2.0 ** -10)) & (total <= np.float32(1 + 2.0 ** -10))
        section.check(total, is_one, "ratios with a sum of 1 ± 1/1024", stride=4)
        return ratios

    def _read_palette(self, container: _Container, materials: int) -> tuple[NDArray[np.integer], Singles]:
        plane = (self.height, self.width)
        pair_section = container.section("PAIR")
        count = len(pair_section.data) // 2
        if not 1 <= count <= 2048:
            raise pair_section.error(0, f"a size of {len(pair_section.data)} bytes", "2 to 4096 bytes")
        pairs = pair_section.indices("u1", (count, 2), materials)
        section = container.section("CODE").exactly(2 * math.prod(plane))
        codes = section.array("<u2", plane)
        section.check(codes, (codes & 2047) < count, f"the number of a pair below {count}")
        return np.moveaxis(pairs[codes & 2047], 2, 0), _with_rest((codes >> 11).astype(np.float32) / 31)

    def _read_basis(self, section: _Section) -> SeparableBasis:
        maps = section.at_least(4).integer(0, "B", (1, 2))
        blurs = section.integer(1, "B", range(1, 9))
        section.exactly(4 + 4 * blurs + 6 * blurs * maps * (maps + 1) + 12 * maps * self.samples)
        low, high = 0.125, 16.0
        for a in range(blurs):
            low = section.real(4 + 4 * a, low, high)
            high = min(16 * low, 1023)
        at = 4 + 4 * blurs
        pairs = [(0, 0), (0, 1), (1, 1)][:maps * (maps + 1) // 2]
        stored = section.reals("<f4", (len(pairs), blurs, 3), -1e6, 1e6, at)
        weights = np.empty((maps, maps, blurs, 3), np.float32)
        for (one, other), values in zip(pairs, stored):
            weights[one, other] = weights[other, one] = values
        d = section.reals("<f4", (maps, self.samples, 3), -1e15, 1e15, at + stored.nbytes)
        return SeparableBasis(section.array("<f4", (blurs,), 4), weights, d)

    def pixels(self) -> tuple[Ints, Ints]:
        """Coordinates x and y of all pixels, [height, width] each."""
        y, x = np.mgrid[:self.height, :self.width]
        return x, y

    def address(self, x: ArrayLike, y: ArrayLike) -> tuple[Ints, Ints]:
        """Pixels within the patch that coordinates name."""
        return self._address(_whole(x), self.width), self._address(_whole(y), self.height)

    def _address(self, at: Ints, size: int) -> Ints:
        if self.addressing == "clamp":
            return np.clip(at, 0, size - 1)
        if self.addressing == "repeat":
            return at % size
        at = at % (2 * size)
        return np.where(at < size, at, 2 * size - 1 - at)

    def profile(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Profiles P̂_x of pixels, [..., S, 3], natural log of mm⁻²; node h is at h r_max / (S − 1)."""
        x, y = self.address(x, y)
        return self._node(x[..., np.newaxis], y[..., np.newaxis], np.arange(self.samples))

    def _node(self, x: Ints, y: Ints, node: Ints) -> Array:
        """Values of profiles at nodes, [..., 3]; x and y within the patch."""
        if self.local is not None:
            return self.local[node, :, y, x].astype(np.float64)
        total = np.zeros(3)
        for index, ratio in zip(self.indices, self.ratios):
            total = total + ratio[y, x].astype(np.float64)[..., np.newaxis] * self.bases[index[y, x], node]
        return total

    def _profile_at(self, x: Ints, y: Ints, position: Array) -> Array:
        """Values of profiles at positions, in nodes and linear between them, [..., 3]."""
        x, y = self.address(x, y)
        node = np.minimum(position.astype(np.int64), self.samples - 2)
        weight = (position - node)[..., np.newaxis]
        return (1 - weight) * self._node(x, y, node) + weight * self._node(x, y, node + 1)

    def _distance(self, dx: Ints, dy: Ints) -> tuple[Singles, NDArray[np.bool_]]:
        """Distances in mm and whether they count. In f32, so that every reader has the same pairs within r_max."""
        distance = np.sqrt((dx * dx + dy * dy).astype(np.float32)) * np.float32(self.pitch)
        is_near = np.maximum(np.abs(dx), np.abs(dy)) <= self.window_radius
        return distance, is_near & (distance <= np.float32(self.r_max))

    def rd(self, x_in: ArrayLike, y_in: ArrayLike, x_out: ArrayLike, y_out: ArrayLike) -> Array:
        """Reflectance Rd in mm⁻², [..., 3]: exitance at the second pixel per flux that entered at the first."""
        x_in, y_in, x_out, y_out = np.broadcast_arrays(*(_whole(value) for value in (x_in, y_in, x_out, y_out)))
        distance, is_near = self._distance(x_out - x_in, y_out - y_in)
        position = np.where(is_near, distance.astype(np.float64), 0.0) * ((self.samples - 1) / self.r_max)
        mean = 0.5 * (self._profile_at(x_in, y_in, position) + self._profile_at(x_out, y_out, position))
        return np.where(is_near[..., np.newaxis], np.exp(mean), 0.0)

    def albedo(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Albedo of pixels, [..., 3], dimensionless, at most 1 for a physical material.

        The time is that of (2 R + 1)² values of Rd for each pixel.
        """
        return self._sum(x, y, None)

    def exitance(self, irradiance: ArrayLike, x: ArrayLike, y: ArrayLike) -> Array:
        """Radiant exitance of pixels, [..., 3], for the entered irradiance of all pixels, [height, width, 3]."""
        return self._sum(x, y, self._map(irradiance))

    def _map(self, values: ArrayLike) -> Array:
        """Map of the patch, [height, width, 3], from one that may be without colour, [height, width]."""
        values = np.asarray(values, np.float64)
        if values.ndim == 2:
            values = values[..., np.newaxis]
        return np.broadcast_to(values, (self.height, self.width, 3))

    def _sum(self, x: ArrayLike, y: ArrayLike, irradiance: Array | None) -> Array:
        x, y = np.broadcast_arrays(_whole(x), _whole(y))
        result = np.zeros((x.size, 3))
        dx = np.arange(-self.window_radius, self.window_radius + 1)
        step = max(1, (1 << 16) // len(dx))  # pixels at a time, to bound the memory
        for first in range(0, x.size, step):
            x_out, y_out = (value.reshape(-1, 1)[first:first + step] for value in (x, y))
            for dy in dx:
                x_in, y_in = x_out + dx, y_out + dy
                rd = self.rd(x_in, y_in, x_out, y_out)
                if irradiance is not None:
                    column, row = self.address(x_in, y_in)
                    rd *= irradiance[row, column]
                result[first:first + step] += rd.sum(axis=1)
        return result.reshape(x.shape + (3,)) * self.pitch ** 2

    def coefficients(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Coefficients c_l of pixels in the separable basis, [..., L, 3], dimensionless."""
        return np.einsum("lhc,...hc->...lc", self._basis().d.astype(np.float64), np.exp(0.5 * self.profile(x, y)))

    def exitance_by_basis(self, irradiance: ArrayLike) -> Array:
        """Radiant exitance of all pixels, [height, width, 3], by the separable basis: nearly that of `exitance`."""
        basis = self._basis()
        coefficients = np.moveaxis(self.coefficients(*self.pixels()), 2, 0)
        total = np.zeros((self.height, self.width, 3))
        for weights, source in zip(basis.weights.swapaxes(1, 2), coefficients * self._map(irradiance)):
            for weight, (spacing, taps) in zip(weights, basis.taps()):
                for axis in (1, 0):
                    source = self._blur(source, spacing, taps, axis)
                total += np.einsum("myxc,mc->yxc", coefficients, weight) * source
        return total

    def _basis(self) -> SeparableBasis:
        if self.basis is None:
            raise ValueError("this file has no separable basis")
        return self.basis

    def _blur(self, values: Array, spacing: int, taps: Array, axis: int) -> Array:
        """Map blurred along an axis by taps `spacing` pixels apart; what lies outside is addressed."""
        size, reach = values.shape[axis], len(taps) // 2
        total = np.zeros_like(values)
        for number, weight in zip(range(-reach, reach + 1), taps):
            total += weight * values.take(self._address(np.arange(size) + number * spacing, size), axis)
        return total


def _with_rest(ratios: NDArray) -> Singles:
    """Ratios t and 1 − t, [2, height, width]."""
    return np.stack([ratios, 1 - ratios])


# ---------------------------------------------------------------------------------------------------------------------
# Bidirectional texture functions


@dataclass(frozen=True)
class Material:
    """Material of a BTF. name: text from strangers; width, height: texels of level 0; levels: 1 to 16."""

    name: str
    width: int
    height: int
    levels: int

    def size(self, level: int) -> tuple[int, int]:
        """Width and height of a level in texels."""
        if not 0 <= level < self.levels:
            raise ValueError(f"level {level} of {self.levels}")
        return max(1, self.width >> level), max(1, self.height >> level)


class Btf(SubsurfFile):
    """Bidirectional texture function F of one or several materials. White paper has F = cos θ_i.

    encoding: "display" or "LogLuv", how colours are stored. materials: tuple of `Material`.
    n_alpha, n_beta, n_theta, n_phi: nodes; alpha_max, theta_max: rad; sin_beta_max: to 1.
    cos_light_min: cosine of the lowest light that was measured, 0 to 0.999; values fade out below.
    white: scale of encoding "display"; toe, peak: of "LogLuv"; NaN for the other encoding.
    texel_size: distance of texels of level 0 in mm, None where it is not known.

    Directions are unit vectors, [..., 3]: x along the rows, y down the columns, z out of the surface.
    """

    white = toe = peak = math.nan

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        header = container.section("BTFH").at_least(36)
        self.encoding = ("display", "LogLuv")[header.integer(1, "B", (1, 2)) - 1]
        count = header.integer(2, "B", range(1, 256))
        self.n_alpha, self.n_beta, self.n_theta = (header.integer(at, "B", range(2, 65)) for at in (4, 5, 6))
        self.n_phi = header.integer(7, "B", range(1, 65))
        self.alpha_max = header.real(8, 0.001, math.pi / 2)
        self.sin_beta_max = header.real(12, 0.001, 1)
        self.theta_max = header.real(16, 0.001, math.pi / 2)
        self.cos_light_min = header.real(20, 0, 0.999)
        scale = header.real(24, 1e-6, 1e6)
        if self.encoding == "display":
            self.white = scale
        else:
            self.toe, self.peak = scale, header.real(28, scale, 1e6)
        is_known = header.array("<f4", (1,), 32)[0] != 0
        self.texel_size = header.real(32, 1e-6, 1e6) if is_known else None
        self._read_materials(container.section("MATS").exactly(32 * count), count)

    def __repr__(self) -> str:
        return (f"{type(self).__name__}({', '.join(f'{m.name!r} {m.width} × {m.height}' for m in self.materials)}; "
                f"{self.encoding}, nodes {self.n_alpha} × {self.n_beta} × {self.n_theta} × {self.n_phi})")

    def _read_materials(self, section: _Section, count: int) -> None:
        materials = []
        self._first: list[list[int]] = []  # number of the first texel of every level
        self.texels = 0
        for at in range(0, 32 * count, 32):
            name = _valid_text(bytes(section.data[at:at + 24]).split(b"\0")[0])
            width, height = (section.integer(at + 24 + 2 * i, "H", range(1, 65536)) for i in range(2))
            material = Material(name, width, height, section.integer(at + 28, "B", range(1, 17)))
            self._first.append([])
            for level in range(material.levels):
                self._first[-1].append(self.texels)
                self.texels += math.prod(material.size(level))
            materials.append(material)
        if self.texels >= 2**32 - 1:
            raise section.error(0, self.texels, "fewer than 2³² − 1 texels in all")
        self.materials = tuple(materials)

    def texel(self, material: int, level: int, x: ArrayLike, y: ArrayLike) -> Ints:
        """Numbers of texels; coordinates repeat outside the level."""
        if not 0 <= material < len(self.materials):
            raise ValueError(f"material {material} of {len(self.materials)}")
        width, height = self.materials[material].size(level)
        return self._first[material][level] + _whole(y) % height * width + _whole(x) % width

    def eval(self, material: int, level: int, x: ArrayLike, y: ArrayLike, light: ArrayLike, view: ArrayLike,
             linear: bool = True) -> Array:
        """Values of F, [..., 3], of texels under `light` seen from `view`; all four arrays broadcast.

        `linear=False` leaves encoding "display" as images have it, sRGB from 0 to 1.
        """
        light, view = _directions(light), _directions(view)
        view_nodes, light_nodes = self._nodes(light, view)
        luma, chroma_a, chroma_b = self._mix(self.texel(material, level, x, y), view_nodes, light_nodes)
        colour = self._display if self.encoding == "display" else self._log_luv
        rgb = colour(luma, chroma_a, chroma_b) * self._fade(light[..., 2])[..., np.newaxis]
        return self.white * _srgb_to_linear(rgb) if linear and self.encoding == "display" else rgb

    def image(self, material: int, level: int, light: ArrayLike, view: ArrayLike, linear: bool = True) -> Array:
        """Image of a level, [height, width, 3], under one light and from one view."""
        width, height = self.materials[material].size(level)
        y, x = np.mgrid[:height, :width]
        return self.eval(material, level, x, y, light, view, linear)

    def albedo(self, material: int, level: int, x: ArrayLike, y: ArrayLike, view: ArrayLike,
               samples: int = 64) -> Array:
        """Albedo ∫ F dω_i / π of texels seen from `view`, [..., 3], by samples × samples lights."""
        view = _directions(view)
        x, y, _ = np.broadcast_arrays(_whole(x), _whole(y), view[..., 0])
        view = np.broadcast_to(view, (*x.shape, 3))
        # Lights at equal distances in α and sin β, of which the solid angle is the product.
        middle = (np.arange(samples) + 0.5) / samples * 2 - 1
        alpha, sin_beta = np.meshgrid(middle * (math.pi / 2), middle)
        forward, up = (np.sqrt(1 - sin_beta ** 2) * value for value in (np.sin(alpha), np.cos(alpha)))
        result = np.empty((*x.shape, 3))
        for at in np.ndindex(x.shape):
            cos_phi, sin_phi = _azimuth(view[at])
            light = np.stack([forward * cos_phi - sin_beta * sin_phi, forward * sin_phi + sin_beta * cos_phi, up], -1)
            values = self.eval(material, level, x[at], y[at], light, view[at])
            result[at] = 2 * values.mean(axis=(0, 1))  # lights have 2 π together, F counts over π
        return result

    def _nodes(self, light: Array, view: Array) -> tuple[Nodes, Nodes]:
        """Nodes around the directions, four of view, [φ][θ], and four of light, [α][β], with weights."""
        cos_phi, sin_phi = _azimuth(view)
        forward = light[..., 0] * cos_phi + light[..., 1] * sin_phi
        sin_beta = light[..., 1] * cos_phi - light[..., 0] * sin_phi
        alpha = np.arctan2(forward, np.maximum(light[..., 2], 0))
        theta = np.arctan2(np.hypot(view[..., 0], view[..., 1]), view[..., 2])
        phi = np.arctan2(sin_phi, cos_phi)
        on_phi = _on_ring(phi * (self.n_phi / (2 * math.pi)), self.n_phi)
        on_theta = _on_axis(theta / self.theta_max * (self.n_theta - 1), self.n_theta)
        on_alpha = _on_axis((alpha / self.alpha_max + 1) / 2 * (self.n_alpha - 1), self.n_alpha)
        on_beta = _on_axis((sin_beta / self.sin_beta_max + 1) / 2 * (self.n_beta - 1), self.n_beta)
        return list(_products(on_phi, on_theta, self.n_theta)), list(_products(on_alpha, on_beta, self.n_beta))

    def _mix(self, texel: Ints, view: Nodes, light: Nodes) -> tuple[Array, Array, Array]:
        """Luma and both channels of chroma, sums over nodes."""
        raise NotImplementedError

    def _fade(self, cos_light: Array) -> Array:
        """Factor of low lights, 0 to 1."""
        if self.cos_light_min == 0:
            return np.where(cos_light > 0, 1.0, 0.0)
        return np.clip(cos_light / self.cos_light_min, 0, 1)

    @staticmethod
    def _display(luma: Array, cr: Array, cb: Array) -> Array:
        red, blue = luma + cr / 0.713, luma + cb / 0.564
        green = (luma - 0.299 * red - 0.114 * blue) / 0.587
        return np.clip(np.stack([red, green, blue], axis=-1), 0, 1)

    def _log_luv(self, luma: Array, u: Array, v: Array) -> Array:
        luminance = self.toe * (np.exp2(np.clip(luma, 0, 2) * math.log2(1 + self.peak / self.toe)) - 1)
        u, v = np.clip(u, 0, 1), np.clip(v, 0.01, 1)
        x = 9 * u / (4 * v) * luminance
        z = (3 - 0.75 * u) / v * luminance - 5 * luminance
        xyz = np.stack([x, luminance, z], axis=-1)
        matrix = np.array([[3.240970, -1.537383, -0.498611],
                           [-0.969244, 1.875968, 0.041555],
                           [0.055630, -0.203977, 1.056972]])
        return np.maximum(xyz @ matrix.T, 0)


def _valid_text(data: bytes) -> str:
    """Longest beginning that is UTF-8."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        return data[:error.start].decode("utf-8")


def _directions(values: ArrayLike) -> Array:
    """Directions from what a caller gave, [..., 3]."""
    array = np.asarray(values, np.float64)
    if array.shape[-1:] != (3,) or not np.isfinite(array).all():
        raise ValueError("directions are finite and have three coordinates")
    return array


def _azimuth(view: Array) -> tuple[Array, Array]:
    """Cosine and sine of the azimuth of views, which is 0 for those along the normal."""
    sin_theta = np.hypot(view[..., 0], view[..., 1])
    is_normal = sin_theta <= 1e-6
    length = np.where(is_normal, 1, sin_theta)
    return np.where(is_normal, 1, view[..., 0] / length), np.where(is_normal, 0, view[..., 1] / length)


def _on_axis(position: Array, nodes: int) -> Nodes:
    """Two nodes around a position with their weights; positions outside count as the ends."""
    position = np.clip(position, 0, nodes - 1)
    first = np.minimum(position.astype(np.int64), nodes - 2)
    return [(first, 1 - (position - first)), (first + 1, position - first)]


def _on_ring(position: Array, nodes: int) -> Nodes:
    """Two nodes around a position with their weights; node `nodes` is node 0."""
    first = np.floor(position).astype(np.int64)
    return [(first % nodes, 1 - (position - first)), ((first + 1) % nodes, position - first)]


def _products(rows: Nodes, columns: Nodes, width: int) -> Iterator[tuple[Ints, Array]]:
    """Nodes of two axes, numbered row by row, with products of weights."""
    for row, row_weight in rows:
        for column, column_weight in columns:
            yield row * width + column, row_weight * column_weight


def _srgb_to_linear(values: Array) -> Array:
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


class _Items:
    """Table of items of several bit fields, read where they lie: items without bits may be many in a small file."""

    CHUNK = 1 << 16

    def __init__(self, section: _Section, count: int, limits: Sequence[int], at: int = 0) -> None:
        """Table of `count` items that begins at `at`; fields are below `limits`, with as many bits as they need."""
        self._section, self._at, self._count = section, at, count
        self._widths = [(limit - 1).bit_length() for limit in limits]
        self._bits = sum(self._widths)
        section.exactly(at + (count * self._bits + 7) // 8 + 8)  # eight bytes follow, for loads of 64 bits
        self._bytes = section.array("u1", (len(section.data),))
        for field, limit in enumerate(limits):
            if limit < 1 << self._widths[field]:
                self._check(field, limit)

    def _check(self, field: int, limit: int) -> None:
        """Refusal of indices that are not below `limit`."""
        for first in range(0, self._count, self.CHUNK):
            items = np.arange(first, min(first + self.CHUNK, self._count))
            values = self.read(items)[field]
            if values.max() >= limit:
                bad = int(np.argmax(values >= limit))
                raise self._section.error(self._at + (first + bad) * self._bits // 8, values[bad],
                                          f"an index below {limit}")

    def read(self, items: Ints) -> list[Ints]:
        """Fields of items, an array each of the shape of `items`."""
        bit = items * self._bits
        start = self._at + (bit >> 3)
        words = self._bytes[start[..., np.newaxis] + np.arange(8)].view("<u8")[..., 0] >> (bit & 7).astype(np.uint64)
        fields = []
        for width in self._widths:
            fields.append((words & np.uint64((1 << width) - 1)).astype(np.int64))
            words = words >> np.uint64(width)
        return fields


@dataclass(frozen=True)
class _Scale:
    """Codes of a scale: `bits` of them, value 2^((offset + 2^step c) / 64), with the highest bit a sign or not."""

    entries: int
    bits: int
    step: int
    offset: int
    is_signed: bool

    def value(self, code: Ints) -> Array:
        sign = 1 << (self.bits - 1) if self.is_signed and self.bits else 0
        magnitude = np.exp2((self.offset + ((code & ~sign) << self.step)) / 64)
        return np.where(code & sign, -magnitude, magnitude)


class _Stage:
    """Codebooks of one stage of luma."""

    def __init__(self, btf: NestedBtf, container: _Container, book: _Section, number: int) -> None:
        at = 40 + 40 * number
        self.is_signed = bool(book.integer(at + 36, "B", (0, 1) if number else (0,)))
        self.p6, self.p4, self.p3, self.p2 = (self._scale(book, at + 8 * k) for k in range(4))
        if self.p6.entries != btf.texels:
            raise book.error(at, self.p6.entries, f"{btf.texels}, the number of texels")
        slices = book.integer(at + 32, "I", btf.ENTRIES)
        below = self.p2.entries if number else btf.merged
        tints = [btf.tints] if btf.tints and not number else []
        self._btf = btf
        self._p6 = self._items(container, f"P6S{number}", btf.texels, [self.p4.entries, 1 << self.p6.bits, *tints])
        self._p4 = self._items(container, f"P4S{number}", self.p4.entries * btf.n_phi,
                               [self.p3.entries, 1 << self.p4.bits])
        self._p3 = self._items(container, f"P3S{number}", self.p3.entries * btf.n_theta, [below, 1 << self.p3.bits])
        count = self.p2.entries * btf.n_alpha
        self._p2 = self._items(container, f"P2S{number}", count, [slices, 1 << max(0, self.p2.bits - 8)], count)
        self._low = container.section(f"P2S{number}").array("u1", (count,))
        section = container.section(f"P1S{number}").exactly(slices * (btf.n_beta + 1) + 8)
        self._slices = section.array("u1", (slices, btf.n_beta + 1))

    def _scale(self, book: _Section, at: int) -> _Scale:
        entries = book.integer(at, "I", NestedBtf.ENTRIES)
        bits = book.integer(at + 4, "B", range(17))
        step = book.integer(at + 5, "B", range(7))
        highest = 1536 - (((1 << bits) - 1) << step)
        return _Scale(entries, bits, step, book.integer(at + 6, "h", range(-1536, highest + 1)), self.is_signed)

    @staticmethod
    def _items(container: _Container, kind: str, count: int, limits: Sequence[int], at: int = 0) -> _Items:
        """Table of an index, a code and perhaps the index of a tint."""
        section = container.section(kind)
        bits = sum((limit - 1).bit_length() for limit in limits)
        if bits > 28:
            raise section.error(0, f"an item of {bits} bits", "at most 28 bits")
        return _Items(section, count, limits, at)

    def texel(self, texel: Ints) -> list[Ints]:
        """Fields of P6: row of P4, code, perhaps the tint."""
        return self._p6.read(texel)

    def view(self, row: Ints, code: Ints, phi: Ints, theta: Ints) -> tuple[Ints, Array]:
        """Row that P3 names at a node of view, and the product of three scales."""
        p3_row, p4_code = self._p4.read(row * self._btf.n_phi + phi)
        below, p3_code = self._p3.read(p3_row * self._btf.n_theta + theta)
        return below, self.p6.value(code) * self.p4.value(p4_code) * self.p3.value(p3_code)

    def light(self, row: Ints, alpha: Ints, beta: Ints) -> Array:
        """Value of a row of P2 at a node of light."""
        item = row * self._btf.n_alpha + alpha
        p1, high = self._p2.read(item)
        code = (self._low[item] & ((1 << min(self.p2.bits, 8)) - 1)) | high << 8
        value = self._slices[p1, beta]
        unit = value.astype(np.int8) / 127 if self.is_signed else value / 255
        return self.p2.value(code) * unit * np.exp2(self._slices[p1, -1] / 32)


class NestedBtf(Btf):
    """BTF of nested codebooks. stages: 1 to 4; tints: their number, 0 for none; is_relative: chroma over luma."""

    ENTRIES = range(1, (1 << 24) + 1)

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        book = container.section("BOOK")
        if len(book.data) not in range(80, 201, 40):
            raise book.error(0, f"a size of {len(book.data)} bytes", "40 bytes and 40 for each of 1 to 4 stages")
        self.stages = len(book.data) // 40 - 1
        self.merged, second, first, colours = (book.integer(4 * k, "I", self.ENTRIES) for k in range(4))
        self.tints = book.integer(16, "I", range((1 << 24) + 1))
        self._origin = book.reals("<f4", (2,), -16, 16, 20).astype(np.float64)
        self._step = book.reals("<f4", (2,), -16, 16, 28).astype(np.float64)
        self.is_relative = bool(book.integer(36, "B", (0, 1)))
        p2 = book.integer(64, "I", self.ENTRIES)
        bits = (p2 - 1).bit_length() + (second - 1).bit_length()
        if bits > 28:
            raise book.error(40, bits, "rows of M of at most 28 bits")
        self._stages = [_Stage(self, container, book, number) for number in range(self.stages)]
        self._merge = _Items(container.section("MERG"), self.merged, (p2, second))
        self._i2 = _Items(container.section("CHR2"), second * self.n_alpha, (first,))
        self._i1 = _Items(container.section("CHR1"), first * self.n_beta, (colours,))
        self._colours = container.section("CHRC").exactly(2 * colours).array("u1", (colours, 2))
        if self.tints:
            self._tints = container.section("TINT").exactly(2 * self.tints).array("u1", (self.tints, 2))

    def _mix(self, texel: Ints, view: Nodes, light: Nodes) -> tuple[Array, Array, Array]:
        texels = [stage.texel(texel) for stage in self._stages]
        luma = first_luma = np.zeros(())
        chroma = np.zeros(2)
        for view_node, view_weight in view:
            phi, theta = view_node // self.n_theta, view_node % self.n_theta
            rows = [stage.view(fields[0], fields[1], phi, theta) for stage, fields in zip(self._stages, texels)]
            p2_row, i2_row = self._merge.read(rows[0][0])
            rows[0] = (p2_row, rows[0][1])
            for light_node, light_weight in light:
                alpha, beta = light_node // self.n_beta, light_node % self.n_beta
                values = [scale * stage.light(row, alpha, beta) for stage, (row, scale) in zip(self._stages, rows)]
                weight = view_weight * light_weight
                (i1_row,) = self._i2.read(i2_row * self.n_alpha + alpha)
                (colour,) = self._i1.read(i1_row * self.n_beta + beta)
                share = (weight * values[0] if self.is_relative else weight)[..., np.newaxis]
                luma = luma + weight * sum(values)
                first_luma = first_luma + weight * values[0]
                chroma = chroma + share * self._colours[colour]
        return (luma,) + self._chroma(luma, first_luma, chroma, texels[0])

    def _chroma(self, luma: Array, first_luma: Array, codes: Array, texel: list[Ints]) -> tuple[Array, Array]:
        """Both channels of chroma, of sums of codes over nodes and the texel's tint."""
        tint = self._step * (self._tints[texel[2]] - 128.0) if self.tints else 0.0
        if not self.is_relative:
            chroma = self._origin + self._step * codes + tint
            return chroma[..., 0], chroma[..., 1]
        total = first_luma[..., np.newaxis]
        mean = np.divide(codes, total, out=np.zeros_like(codes), where=total != 0)
        chroma = luma[..., np.newaxis] * (self._origin + self._step * mean + tint)
        return chroma[..., 0], chroma[..., 1]


class FactoredBtf(Btf):
    """BTF of factors. luma, chroma: numbers n and m of factors; their codes are decoded when first needed.

    stages: tuple of (codewords, first coefficient, number of coefficients).
    column_scales: [K] f32, K = n + 2 m, of b, then q of both channels. ratio_steps: [2] f32.
    A texel's coefficients are ρ of both channels, v and u: D = 2 + m + n.
    """

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        self._read_sizes(container.section("FACT").at_least(8))
        views, lights = self.n_phi * self.n_theta, self.n_alpha * self.n_beta
        axes = container.section("AXES").exactly(self._view_axes * views + self._light_axes * lights)
        self._views = axes.array("i1", (self._view_axes, views))
        self._lights = axes.array("i1", (self._light_axes, lights), self._views.size)
        self._core_code = bytes(container.section("CORE").data)
        self._word_code = bytes(container.section("WORD").data)
        section = container.section("INDX").exactly(self.texels * len(self.stages))
        self._index = section.array("u1", (self.texels, len(self.stages)))
        counts = np.array([codewords for codewords, _, _ in self.stages])
        section.check(self._index, self._index < counts, "an index below the stage's number of codewords")
        size = views * lights * self._columns
        if size > MAX_TABLE:
            raise FormatError("FACT", self._fact_start, f"a table of {size} bytes", f"{MAX_TABLE} in this reader")

    def _read_sizes(self, section: _Section) -> None:
        self._fact_start = section.start
        self.luma = section.integer(0, "B", range(1, 129))
        self.chroma = section.integer(1, "B", range(33))
        stages = section.integer(2, "B", range(1, 33))
        self._view_axes = section.integer(4, "B", range(1, min(self.n_phi * self.n_theta, 255) + 1))
        self._light_axes = section.integer(5, "B", range(1, min(self.n_alpha * self.n_beta, 255) + 1))
        self._columns = self.luma + 2 * self.chroma
        counts = 2, self._columns, self._columns, self._view_axes, self._light_axes
        section.exactly(8 + 4 * stages + 4 * sum(counts))
        self.stages = tuple(self._stage(section, 8 + 4 * stage) for stage in range(stages))
        steps = section.reals("<f4", (sum(counts),), 0, 1e6, 8 + 4 * stages)
        self.ratio_steps, self.column_scales, self._core_steps, self._view_scales, self._light_scales = np.split(
            steps, np.cumsum(counts)[:-1])

    def _stage(self, section: _Section, at: int) -> tuple[int, int, int]:
        size = 2 + self.chroma + self.luma
        first = section.integer(at + 1, "B", range(size))
        return section.data[at] + 1, first, section.integer(at + 2, "B", range(1, size - first + 1))

    @cached_property
    def core(self) -> NDArray[np.int32]:
        """Core G of the table, [K, I, J], −32,767 to 32,767."""
        return _decode_core(self._core_code, (self._columns, self._view_axes, self._light_axes))

    @cached_property
    def codewords(self) -> list[NDArray[np.int32]]:
        """Codewords of every stage, [codewords, c] each, −32,767 to 32,767."""
        return _decode_words(self._word_code, [(codewords, size) for codewords, _, size in self.stages])

    @cached_property
    def table(self) -> NDArray[np.int8]:
        """Table X, [V, L, K], −127 to 127: nodes of view [φ][θ], nodes of light [α][β], columns."""
        core = self.core.transpose(1, 2, 0).astype(np.float32)
        lights = self._lights.astype(np.float32)
        table = np.empty((self._views.shape[1], lights.shape[1], self._columns), np.int8)
        for view, axes in enumerate(self._views.T):
            # Sums go over i and over j in turn, in f32, so that all readers round alike.
            inner = np.zeros(core.shape[1:], np.float32)
            for value, plane in zip(self._view_scales * axes.astype(np.float32), core):
                inner += value * plane
            total = np.zeros(table.shape[1:], np.float32)
            for row, scale, light in zip(inner, self._light_scales, lights):
                total += ((scale * row) * self._core_steps) * light[:, np.newaxis]
            table[view] = np.clip(np.trunc(total + np.copysign(np.float32(0.5), total)), -127, 127)
        return table

    def coefficients(self, texel: ArrayLike) -> NDArray[np.int32]:
        """Coefficients of texels by their numbers, [..., D]: ρ of both channels, v, u, before their steps."""
        index = self._index[_whole(texel)]
        total = np.zeros(index.shape[:-1] + (2 + self.chroma + self.luma,), np.int32)
        for stage, (words, (_, first, size)) in enumerate(zip(self.codewords, self.stages)):
            total[..., first:first + size] += words[index[..., stage]]
        return total

    def _mix(self, texel: Ints, view: Nodes, light: Nodes) -> tuple[Array, Array, Array]:
        columns = np.zeros(self._columns)
        for view_node, view_weight in view:
            for light_node, light_weight in light:
                columns = columns + (view_weight * light_weight)[..., np.newaxis] * self.table[view_node, light_node]
        columns = columns * self.column_scales
        coefficients = self.coefficients(texel).astype(np.float64)
        ratios = coefficients[..., :2] * self.ratio_steps
        v, u = np.split(coefficients[..., 2:], [self.chroma], axis=-1)
        b, first, second = np.split(columns, [self.luma, self.luma + self.chroma], axis=-1)
        luma = np.einsum("...c,...c->...", u, b)
        return (luma, ratios[..., 0] * luma + np.einsum("...k,...k->...", v, first),
                ratios[..., 1] * luma + np.einsum("...k,...k->...", v, second))


# ---------------------------------------------------------------------------------------------------------------------
# Entropy coding


class _Bits:
    """Decoder of bits from bytes, which zeros follow."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 4
        self._range = 0xFFFFFFFF
        self._code = int.from_bytes(data[:4].ljust(4, b"\0"), "big")

    def even(self) -> int:
        return self._take(self._range >> 1)

    def coin(self, probability: list[int]) -> int:
        """Bit of a probability of 0, [fast, slow], which learns from it."""
        fast, slow = probability
        bit = self._take((self._range >> 16) * ((fast + slow) >> 1))
        if bit:
            probability[:] = fast - (fast >> 4), slow - (slow >> 7)
        else:
            probability[:] = fast + ((65535 - fast) >> 4), slow + ((65535 - slow) >> 7)
        return bit

    def number(self, bits: int) -> int:
        """Number of even bits, the highest first."""
        value = 0
        for _ in range(bits):
            value = 2 * value + self.even()
        return value

    def ones(self, most: int) -> int:
        """Number of even ones before a zero, which is left out after `most`."""
        count = 0
        while count < most and self.even():
            count += 1
        return count

    def _take(self, zero: int) -> int:
        bit = self._code >= zero
        if bit:
            self._code -= zero
            self._range -= zero
        else:
            self._range = zero
        while self._range < 1 << 24:
            byte = self._data[self._at] if self._at < len(self._data) else 0
            self._at += 1
            self._code = (self._code << 8 | byte) & 0xFFFFFFFF
            self._range <<= 8
        return int(bit)


class _Numbers:
    """Decoder of whole numbers, −32,767 to 32,767, by the magnitudes that are expected of them."""

    LEVELS = 24

    def __init__(self, bits: _Bits) -> None:
        self._bits = bits
        self._is_not_zero = [[1 << 15, 1 << 15] for _ in range(self.LEVELS)]
        self._is_more = [[[1 << 15, 1 << 15] for _ in range(12)] for _ in range(self.LEVELS)]
        self._high = [[1 << 15, 1 << 15] for _ in range(self.LEVELS)]

    def next(self, expected: np.float32) -> int:
        (pattern,) = struct.unpack("<I", struct.pack("<f", expected))
        level = min(self.LEVELS - 1, max(0, (pattern >> 22) - 244))
        bits = self._bits
        if not bits.coin(self._is_not_zero[level]):
            return 0
        sign = -1 if bits.even() else 1
        quotient = 0
        while quotient < 20 and bits.coin(self._is_more[level][min(quotient, 11)]):
            quotient += 1
        if quotient == 20:
            digits = bits.ones(15)
            quotient += (1 << digits | bits.number(digits)) - 1
        low_bits = max(0, level - 12) // 2
        low = 0
        if low_bits:
            low = bits.coin(self._high[level]) << (low_bits - 1) | bits.number(low_bits - 1)
        return sign * min((quotient << low_bits | low) + 1, 32767)


def _decode_core(data: bytes, shape: tuple[int, int, int]) -> NDArray[np.int32]:
    """Core of the table, [K, I, J]. What is expected is computed in f32, in the order of the specification."""
    tenths = [np.float32(n / 10) for n in range(7)]
    half, quarter = np.float32(0.5), np.float32(0.25)
    columns, rows, size = shape
    core = np.zeros(shape, np.int32)
    numbers = _Numbers(_Bits(data))
    before = np.zeros((rows, size), np.float32)
    for column in range(columns):
        above = [0] * (size + 3)
        for i in range(rows):
            row = [0] * (size + 3)  # two magnitudes of 0 to the left, one to the right
            for j in range(size):
                near = np.float32(row[j + 1] + above[j + 2])
                far = np.float32(row[j] + above[j + 3])
                expected = half * before[i, j] + quarter * (tenths[6] * near + tenths[4] * far)
                core[column, i, j] = number = numbers.next(expected)
                row[j + 2] = abs(number)
            above = row
        before += tenths[3] * (np.abs(core[column]).astype(np.float32) - before)
    return core


def _decode_words(data: bytes, shapes: Sequence[tuple[int, int]]) -> list[NDArray[np.int32]]:
    """Codewords of all stages, [codewords, c] each."""
    tenth = np.float32(0.1)
    bits = _Bits(data)
    stages = []
    for shape in shapes:
        numbers = _Numbers(bits)
        words = np.zeros(shape, np.int32)
        expected = np.zeros(shape[1], np.float32)
        for word in words:
            word[:] = [numbers.next(magnitude) for magnitude in expected]
            expected += tenth * (np.abs(word).astype(np.float32) - expected)
        stages.append(words)
    return stages


# ---------------------------------------------------------------------------------------------------------------------
# Homogeneous materials: kernels and transfer


class _Tailed(SubsurfFile):
    """Material with a diffusion profile R_d. radius: mm, R_d is 0 from there on; tails: [m, 3], T at its nodes.

    tail_distances: [m] distances of the nodes in mm, radius (k / (m − 1))².
    """

    def _read_tail(self, container: _Container, nodes: int, radius: float) -> None:
        section = container.section("TAIL").exactly(12 * nodes)
        self.radius = radius
        self.tails: Singles = section.reals("<f4", (nodes, 3), 0, 1)
        self.tail_distances: Array = radius * (np.arange(nodes) / (nodes - 1)) ** 2
        inner, last = self.tails[1:], self.tails[-1]
        section.check(inner, inner <= self.tails[:-1], "at most the value of the node before", at=12)
        section.check(last, last == 0, "0 at the last node", at=12 * (nodes - 1))

    def tail(self, d: ArrayLike) -> Array:
        """Tail T(d), [..., 3], 0 to 1: what leaves beyond the distance d in mm, or through a plate of thickness d."""
        nodes = len(self.tails)
        position = np.sqrt(np.maximum(np.asarray(d, np.float64), 0) / self.radius) * (nodes - 1)
        (low, low_weight), (high, high_weight) = _on_axis(position, nodes)
        return low_weight[..., np.newaxis] * self.tails[low] + high_weight[..., np.newaxis] * self.tails[high]

    def rd(self, r: ArrayLike) -> Array:
        """Profile R_d(r) in mm⁻², [..., 3], at the distance r in mm: constant between two nodes of the tail."""
        r = np.asarray(r, np.float64)
        areas = np.pi * np.diff(self.tail_distances ** 2)[:, np.newaxis]
        rings = np.append(-np.diff(self.tails.astype(np.float64), axis=0) / areas, np.zeros((1, 3)), axis=0)
        return rings[np.maximum(np.searchsorted(self.tail_distances, r, side="right") - 1, 0)]


class Kernel(_Tailed):
    """Separable kernel of a homogeneous material.

    method: how it was made. offsets: [n] of taps in mm, from the centre on. weights: [N, n, 3], −16 to 16.
    signs: [N, 3], 1 or −1. depth_variance: mm². eta: 1 to 4. radius, tails, tail_distances: of the profile.
    artist: [3, 3] w, τ_near and τ_far in mm² of an artist, each of red, green and blue; None where there are none.
    """

    METHODS = ("singular values", "pre-integrated", "guided", "two Gaussians of an artist", "sum of Gaussians")

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        header = container.section("KERN").at_least(24)
        self.method = self.METHODS[header.integer(0, "B", range(1, 6)) - 1]
        header.integer(1, "B", (1,))
        terms = header.integer(2, "B", range(1, 7))
        taps = (header.integer(3, "B", range(5, 66, 2)) + 1) // 2
        nodes = header.integer(4, "H", range(2, 1025))
        signs = header.integer(8, "I", range(1 << (3 * terms)))
        self.signs = 1 - 2 * (signs >> np.arange(3 * terms).reshape(terms, 3) & 1)
        radius = header.real(12, 1e-6, 1e6)
        self.depth_variance = header.real(16, 1e-12, 1e12)
        self.eta = header.real(20, 1, 4)
        self.offsets = self._read_offsets(container.section("KOFF").exactly(4 * taps), taps, radius)
        section = container.section("KWGT").exactly(12 * terms * taps)
        self.weights: Singles = section.reals("<f4", (terms, taps, 3), -16, 16)
        self._read_tail(container, nodes, radius)
        energy = self.energy()
        low, high = self.tails[0] - np.float32(1 / 1024), self.tails[0] + np.float32(1 / 1024)
        section.check(energy, (energy >= low) & (energy <= high), "an energy of T(0) ± 1/1024", stride=4)
        self.artist = self._read_artist(container.section("twog")) if container.has("twog") else None

    def __repr__(self) -> str:
        return (f"Kernel({self.method}, {len(self.weights)} terms of {2 * len(self.offsets) - 1} taps, "
                f"radius {self.radius:g} mm, eta {self.eta:g})")

    @staticmethod
    def _read_offsets(section: _Section, taps: int, radius: float) -> Singles:
        offsets = section.array("<f4", (taps,))
        with np.errstate(invalid="ignore"):
            is_good = (offsets < np.float32(radius)) & (np.append(np.float32(-1), offsets[:-1]) < offsets)
        is_good[0] = offsets[0] == 0
        section.check(offsets, is_good, f"offsets that rise from 0 to less than {radius:g}")
        return offsets

    @staticmethod
    def _read_artist(section: _Section) -> Singles:
        section.exactly(36).reals("<f4", (3,), 0, 1)
        near = section.reals("<f4", (3,), 1e-12, 1e12, 12)
        far = section.reals("<f4", (3,), 1e-12, 1e12, 24)
        section.check(far, far >= near, "at least the variance near", 24)
        return section.array("<f4", (3, 3))

    def energy(self) -> Array:
        """Energy Σ_t s_t (Σ_i w_ti)² of the kernel, [3], dimensionless: nearly T(0)."""
        energy = np.zeros(3, np.float32)
        for sign, weights in zip(self.signs.astype(np.float32), self.weights):
            total = np.zeros(3, np.float32)
            for tap, weight in enumerate(weights):
                total = total + np.float32(2 if tap else 1) * weight
            energy = energy + sign * total * total
        return energy

    def matrix(self) -> Array:
        """Weights of all pairs of taps, [taps, taps, 3]: what a light of unit irradiance at an offset adds."""
        line = np.concatenate([self.weights[:, :0:-1], self.weights], axis=1).astype(np.float64)
        return np.einsum("tc,tic,tjc->ijc", self.signs, line, line)


class Transfer(_Tailed):
    """Light transfer of a mesh: radiant exitance at its vertices for directional lights.

    channels: C, 3, or 1 for the mean of three. vertices: their number N. eta: 1 to 4.
    positions_crc, triangles_crc: of the mesh. scale: [C]. bits: those of a coefficient's code, K of them.
    directions: [L, 3] unit vectors towards the lights. radius, tails, tail_distances: of R_d.
    axes: [C, L, R], which clusters share. offsets, steps: [M, 1 + K], of the mean, then of coefficients.
    means: [M, R]. components: [M, K, R]. records: [N, bytes] packed codes of the vertices. M is the number of clusters.
    """

    def __init__(self, container: _Container) -> None:
        super().__init__(container)
        header = container.section("XFER").at_least(58)
        header.integer(0, "B", (1,))
        self.channels = header.integer(1, "B", (1, 3))
        lights = header.integer(2, "H", range(4, 1025))
        clusters = header.integer(4, "H", range(1, 257))
        nodes = header.integer(6, "H", range(2, 1025))
        self.vertices = header.integer(8, "I", range(1, (1 << 26) + 1))
        self.positions_crc, self.triangles_crc = struct.unpack_from("<II", header.data, 12)
        radius = header.real(20, 1e-6, 1e6)
        self.eta = header.real(24, 1, 4)
        self.scale = header.reals("<f4", (3,), 1e-12, 1e6, 28)[:self.channels]
        self.bits = self._read_bits(header)
        axes = header.integer(56, "H", range(1, 257))
        self._read_lights(container.section("XDIR").exactly(12 * lights), lights)
        self.axes = container.section("XAXS").exactly(self.channels * lights * axes).array(
            "i1", (self.channels, lights, axes))
        self._read_clusters(container, clusters, axes)
        self._read_records(container.section("XVTX"), clusters)
        self._read_tail(container, nodes, radius)

    def __repr__(self) -> str:
        return (f"Transfer({self.vertices} vertices, {len(self.directions)} lights, {self.channels} channels, "
                f"{len(self.means)} clusters of {len(self.bits)} components, radius {self.radius:g} mm)")

    @staticmethod
    def _read_bits(header: _Section) -> tuple[int, ...]:
        bits: list[int] = []
        left, is_over = 120, False
        for k in range(16):
            lowest = 1 if k == 0 else 0
            bits.append(header.integer(40 + k, "B", range(lowest, 1 if is_over else min(12, left) + 1)))
            is_over |= bits[-1] == 0
            left -= bits[-1]
        return tuple(count for count in bits if count)

    def _read_lights(self, section: _Section, lights: int) -> None:
        self.directions: Singles = section.array("<f4", (lights, 3))
        with np.errstate(invalid="ignore", over="ignore"):
            x, y, z = self.directions.T
            squares = x * x + y * y + z * z
            is_unit = (squares >= np.float32(1 - 1e-3)) & (squares <= np.float32(1 + 1e-3))
            section.check(squares, is_unit, "a squared length of 1 ± 0.001", stride=12)

    def _read_clusters(self, container: _Container, clusters: int, axes: int) -> None:
        size = len(self.bits)
        section = container.section("XRNG").exactly(8 * clusters * (1 + size))
        ranges = section.array("<f4", (clusters, 1 + size, 2))
        low = np.array([-1000, 0], np.float32)
        with np.errstate(invalid="ignore"):
            section.check(ranges, (ranges >= low) & (ranges <= 1000), "offsets of ±1000 and steps of 0 to 1000")
        self.offsets, self.steps = ranges[..., 0], ranges[..., 1]
        count = clusters * axes
        codes = container.section("XMEA").exactly(2 * count).array("<u2", (clusters, axes))
        offset, step = (values[:, :1].astype(np.float64) for values in (self.offsets, self.steps))
        self.means = offset + step * codes
        section = container.section("XBAS").exactly(size * count)
        self.components = section.array("i1", (clusters, size, axes))

    def _read_records(self, section: _Section, clusters: int) -> None:
        size = (8 + sum(self.bits) + 7) // 8
        self.records = section.exactly(self.vertices * size).array("u1", (self.vertices, size))
        cluster = self.records[:, 0]
        section.check(cluster, cluster < clusters, f"a cluster below {clusters}", stride=size)

    def cluster(self, vertex: ArrayLike) -> Ints:
        """Clusters of vertices."""
        return self.records[_whole(vertex), 0].astype(np.int64)

    def coefficients(self, vertex: ArrayLike) -> Array:
        """Coefficients a_k of vertices, [..., K]."""
        record = self.records[_whole(vertex)].astype(np.int64)
        cluster = record[..., 0]
        codes = np.zeros(cluster.shape + (len(self.bits),))
        at = 8
        for k, bits in enumerate(self.bits):
            word = sum(record[..., i] << 8 * (i - at // 8) for i in range(at // 8, (at + bits + 7) // 8))
            codes[..., k] = word >> at % 8 & ((1 << bits) - 1)
            at += bits
        return self.offsets[cluster, 1:] + self.steps[cluster, 1:] * codes

    def exitance(self, light: ArrayLike, vertex: ArrayLike) -> Array:
        """Radiant exitance q of vertices for lights by their numbers, [..., C]; arrays broadcast.

        That of a light of irradiance 1 across it, before Fresnel transmission on the way out. It may be below 0.
        """
        light, vertex = np.broadcast_arrays(_whole(light), _whole(vertex))
        axes = np.moveaxis(self.axes.astype(np.float64), 1, 0)[light]
        return self.scale * np.einsum("...cr,...r->...c", axes, self.along(vertex))

    def along(self, vertex: ArrayLike) -> Array:
        """What vertices have along the axes, mu + sum of a_k b_k, [..., R]."""
        cluster = self.cluster(vertex)
        varying = np.einsum("...k,...kr->...r", self.coefficients(vertex), self.components[cluster])
        return self.means[cluster] + varying

    def shade(self, weights: ArrayLike, vertex: ArrayLike) -> Array:
        """Radiant exitance Σ_j w_j q_j of vertices, [..., C], for weights of the lights, [L]."""
        axes = np.einsum("l,clr->cr", np.asarray(weights, np.float64), self.axes)
        return self.scale * (self.along(vertex) @ axes.T)

    def fits(self, positions: ArrayLike, triangles: ArrayLike) -> bool:
        """Whether the file is for this mesh: positions in mm, [N, 3], and triangles, [.., 3]."""
        return (zlib.crc32(np.asarray(positions, "<f4").tobytes()) == self.positions_crc
                and zlib.crc32(np.asarray(triangles, "<u4").tobytes()) == self.triangles_crc)
