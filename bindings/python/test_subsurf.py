"""Test of subsurf.py with the conformance vectors: `python3 -m pytest` or `python3 test_subsurf.py [FOLDER]`.

Without an argument the vectors are those in the folder $SUBSURF_VECTORS, or else in ../../tests/vectors.
"""
from __future__ import annotations

import csv
import os
import struct
import sys
import time
import warnings
import zlib
from pathlib import Path

import numpy as np

import subsurf

VECTORS = Path(os.environ.get("SUBSURF_VECTORS", Path(__file__).parent / "../../tests/vectors"))

warnings.simplefilter("error")


def files(pattern: str) -> list[Path]:
    """Vectors of a pattern; there are some, or the folder is the wrong one."""
    found = sorted(VECTORS.glob(pattern))
    assert found, f"no {pattern} in {VECTORS}"
    return found


def good_files() -> list[Path]:
    return [path for path in files("*.subsurf") if not path.name.startswith("x")]


def answer(file: subsurf.SubsurfFile, query: str, numbers: list[str]) -> np.ndarray:
    """Value of a query of the tables."""
    if query in ("tail", "rd") and isinstance(file, subsurf.Kernel):
        return getattr(file, query)(float(numbers[0]))
    if isinstance(file, subsurf.Btf):
        texel = [int(number) for number in numbers[:4]]
        directions = np.array(numbers[4:], float).reshape(-1, 3)
        return file.albedo(*texel, *directions) if query == "albedo" else file.eval(*texel, *directions, linear=False)
    whole = [int(number) for number in numbers]
    if isinstance(file, subsurf.Kernel):
        if query == "gaussians":
            return file.artist[:, whole[0]]
        return file.energy() if query == "energy" else file.weights[tuple(whole)]
    if query == "profile":
        return file.profile(*whole[:2])[whole[2]]
    if query == "coefficient":
        return file.coefficients(*whole[1:])[whole[0]]
    if query == "blurred":
        return file.exitance_by_basis(np.ones((file.height, file.width)))[whole[1], whole[0]]
    if query == "weight":
        return file.basis.weights[tuple(whole)]
    return getattr(file, query)(*whole)


def check_table(path: Path) -> int:
    """Number of lines in the table of a vector, all of them met."""
    file = subsurf.load(path)
    with open(path.with_suffix(".csv"), newline="", encoding="utf-8") as table:
        lines = list(csv.DictReader(table))
    for line in lines:
        values = np.array(line["values"].split(), float)
        found = answer(file, line["query"], line["arguments"].split())
        assert found.shape == values.shape, (path.name, line, found)
        assert (np.abs(found - values) <= float(line["tolerance"])).all(), (path.name, line, found)
    return len(lines)


def test_tables() -> None:
    assert sum(check_table(path) for path in good_files()) > 0


def test_refused() -> None:
    for path in files("x*.subsurf"):
        assert error_of(path.read_bytes()), path.name


def test_refused_places() -> None:
    """Sections and bytes of refusals are those of another reader's messages, as far as these have a byte."""
    with open(VECTORS / "refused.csv", newline="", encoding="utf-8") as table:
        for line in csv.DictReader(table):
            section, _, place = line["error"].partition(": ")
            if place.startswith("byte "):
                error = error_of((VECTORS / line["file"]).read_bytes())
                assert error.section == section.split(" (")[0], (line, error)
                assert int(place.split(":")[0][5:]) == error.offset, (line, error)


def error_of(data: bytes, check_crc: bool = True) -> subsurf.FormatError | None:
    """Refusal of a file, None where it is read; what it holds is used then."""
    try:
        use(subsurf.load(data, check_crc))
    except subsurf.FormatError as error:
        return error
    return None


def use(file: subsurf.SubsurfFile) -> None:
    """Access to what is read late, and one value."""
    repr(file)
    file.metadata()
    if isinstance(file, subsurf.Bssrdf):
        file.profile(file.width, -1)
    elif isinstance(file, subsurf.Btf):
        width, height = file.materials[-1].size(0)
        file.eval(len(file.materials) - 1, 0, width - 1, height - 1, (0.6, 0, 0.8), (0, 0.6, 0.8))
    elif isinstance(file, subsurf.Transfer):
        file.exitance(0, [0, file.vertices - 1])
    else:
        file.matrix()


WRONG = (
    ("format_example", "MIXR", 4, struct.pack("<f", -0.0)),
    ("three_bases", "MIXR", 0, struct.pack("<f", 0.123)),
    ("half_profiles", "PRFH", 0, struct.pack("<e", 88)),
    ("one_of_300_bases", "BIDX", 0, struct.pack("<H", 300)),
    ("palette", "CODE", 0, struct.pack("<H", 2047)),
    ("palette", "PAIR", 0, b"\x07"),
    ("per_pixel_clamp", "LSPP", 8, struct.pack("<f", float("nan"))),
    ("per_pixel_clamp", "BSSR", 16, struct.pack("<I", 1)),
    ("kernel_two_gaussians", "twog", 24, struct.pack("<f", 1e-9)),
    ("kernel_two_terms", "TAIL", 0, struct.pack("<f", -0.1)),
    ("nested_display", "BOOK", 46, struct.pack("<h", 1507)),
    ("nested_display", "BOOK", 40, struct.pack("<I", 7)),
    ("nested_log_luv_stages", "BTFH", 28, struct.pack("<f", 0.005)),
    ("nested_tints", "BOOK", 16, struct.pack("<I", 4)),
    ("factored", "FACT", 9, b"\x05"),
    ("transfer_example", "XDIR", 0, struct.pack("<f", 1e38)),
    ("transfer_example", "XFER", 40, b"\x00"),
)
"""Values out of range: of a file, in a section, at a byte of it."""


def test_wrong_values() -> None:
    for name, kind, at, wrong in WRONG:
        data = bytearray((VECTORS / f"{name}.subsurf").read_bytes())
        (offset,) = struct.unpack_from("<Q", data, data.index(kind.encode()) + 8)
        data[offset + at:offset + at + len(wrong)] = wrong
        error = error_of(bytes(data), check_crc=False)
        assert error, (name, kind, at)
        assert kind == "BOOK" or (error.section, error.offset) == (kind, offset + at), (name, error)


def container(sections: dict[str, bytes]) -> bytes:
    """File of sections."""
    table, place = b"", 28 + 24 * len(sections)
    for kind, data in sections.items():
        table += struct.pack("<4sIQQ", kind.encode(), zlib.crc32(data), place, len(data))
        place += len(data)
    header = subsurf.MAGIC + struct.pack("<HHIQ", 1, 0, len(sections), place) + table
    return header + struct.pack("<I", zlib.crc32(header)) + b"".join(sections.values())


def test_many_items_without_bits() -> None:
    """Sixteen million texels and a thousand million nodes take no memory where the file has no bits for them."""
    scale = struct.pack("<IBBh", 1, 0, 0, 0)
    sizes = struct.pack("<5I4fB3x", 1, 1, 1 << 24, 1, 0, 0, 0, 1, 1, 0)
    stage = struct.pack("<IBBh", 1 << 24, 0, 0, 0) + 3 * scale + struct.pack("<IB3x", 1, 0)
    end = bytes(8)
    file = subsurf.load(container({
        "BTFH": struct.pack("<8B7f", 1, 1, 1, 0, 64, 64, 64, 64, 1.5, 1, 1.5, 0, 1, 0, 0),
        "MATS": struct.pack("<24sHHB3x", b"\xc3\xa4\xff", 4096, 4096, 1), "BOOK": sizes + stage,
        "P6S0": end, "P4S0": end, "P3S0": end, "P2S0": bytes(64) + end, "P1S0": b"\xff" * 64 + b"\x00" + end,
        "MERG": end, "CHR2": bytes(192) + end, "CHR1": end, "CHRC": b"\x00\x00"}))
    assert file.materials[0].name == "ä" and file.texels == 1 << 24
    assert np.allclose(file.eval(0, 0, 4095, 4095, (0, 0, 1), (0, 0, 1)), 1)


SMALL = ("format_example", "metadata", "one_pixel", "palette", "separable_basis", "kernel_example", "transfer_example",
         "nested_tints", "factored")


def test_cuts() -> None:
    for name in SMALL:
        data = (VECTORS / f"{name}.subsurf").read_bytes()
        for size in range(len(data)):
            assert error_of(data[:size]), (name, size)


def test_flips() -> None:
    """Flips of a bit in every byte are noticed by CRCs; without these they are read or refused, nothing else."""
    for name in SMALL:
        data = (VECTORS / f"{name}.subsurf").read_bytes()
        used = covered(data)
        for at in range(len(data)):
            damaged = bytearray(data)
            damaged[at] ^= 1 << at % 8
            assert at not in used or error_of(bytes(damaged)), (name, at)
            error_of(with_header_crc(damaged), check_crc=False)


def covered(data: bytes) -> set[int]:
    """Bytes of a file that a CRC covers, or that are one."""
    (count,) = struct.unpack_from("<I", data, 12)
    used = set(range(28 + 24 * count))
    for entry in range(count):
        offset, length = struct.unpack_from("<QQ", data, 32 + 24 * entry)
        used.update(range(offset, offset + length))
    return used


def with_header_crc(data: bytearray) -> bytes:
    """File whose header's CRC is made good again, so that what is in the header is looked at."""
    end = 24 + 24 * data[12]
    if end + 4 <= len(data):
        struct.pack_into("<I", data, end, zlib.crc32(data[:end]))
    return bytes(data)


def test_metadata() -> None:
    entries = subsurf.load(VECTORS / "metadata.subsurf").metadata()
    assert entries and all(isinstance(value, str) for value in entries.values())


def test_arrays() -> None:
    """Arrays give what their elements give."""
    file = subsurf.load(VECTORS / "bmpp_mirror.subsurf")
    x, y = file.pixels()
    albedo = file.albedo(x, y)
    assert np.allclose(albedo[1, 2], file.albedo(2, 1))
    assert np.allclose(file.exitance(np.ones(x.shape), x, y), albedo)
    assert np.allclose(file.exitance(albedo, 1, 1), file.exitance(albedo, x, y)[1, 1])
    assert file.profile(x, y).shape == x.shape + (file.samples, 3)


def test_images() -> None:
    for name in ("nested_materials", "factored"):
        file = subsurf.load(VECTORS / f"{name}.subsurf")
        light, view = (0.48, 0.36, 0.8), (0.0, 0.6, 0.8)
        image = file.image(0, 0, light, view)
        height, width, _ = image.shape
        assert (width, height) == file.materials[0].size(0)
        assert np.allclose(image[height - 1, 0], file.eval(0, 0, 0, height - 1, light, view))
        lights = np.array([light, (0, 0, 1)])
        both = file.eval(0, 0, 0, height - 1, lights, view)
        assert both.shape == (2, 3) and np.allclose(both[0], image[height - 1, 0])
        albedo = file.albedo(0, 0, [0, width - 1], 0, view, samples=16)
        assert np.allclose(albedo[1], file.albedo(0, 0, width - 1, 0, view, samples=16))


def test_basis() -> None:
    """Blurs have sum 1 and, together, the variance of Gaussians at whole pixels; a constant map stays constant."""
    basis = subsurf.SeparableBasis(np.array([0.5, 1.5, 6, 20], np.float32), np.ones((1, 1, 4, 3), np.float32),
                                   np.ones((1, 2, 3), np.float32))
    kernel = np.ones(1)
    for sigma, (spacing, taps) in zip(basis.sigma, basis.taps()):
        spread = np.zeros((len(taps) - 1) * spacing + 1)
        spread[::spacing] = taps
        kernel = np.convolve(kernel, spread)
        k = np.arange(len(kernel)) - len(kernel) // 2
        assert abs(kernel.sum() - 1) < 1e-9
        every = np.arange(-300, 301)
        gaussian = np.exp(-0.5 * (every / sigma) ** 2)
        variance = (gaussian * every ** 2).sum() / gaussian.sum()
        assert abs((kernel * k * k).sum() / variance - 1) < 1e-3
    file = subsurf.load(VECTORS / "separable_basis.subsurf")
    x, y = file.pixels()
    c = file.coefficients(x, y)
    assert c.shape == x.shape + (len(file.basis.d), 3)
    assert file.exitance_by_basis(np.ones(x.shape)).shape == x.shape + (3,)


def test_transfer_arrays() -> None:
    file = subsurf.load(VECTORS / "transfer_example.subsurf")
    everything = file.exitance(np.arange(len(file.directions))[:, np.newaxis], np.arange(file.vertices))
    assert np.array_equal(file.along(np.arange(3)), [[0.875, 2], [0.75, 0.5], [0.5, 0.5]])
    weights = np.array([0.5, 0.25, 0, 0.25])
    assert np.allclose(file.shade(weights, np.arange(file.vertices)), np.tensordot(weights, everything, 1))
    assert file.fits([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    assert not file.fits([(0, 0, 0), (1, 0, 0), (0, 1, 1)], [(0, 1, 2)])


def main() -> None:
    global VECTORS
    if len(sys.argv) > 1:
        VECTORS = Path(sys.argv[1])
    for name, function in list(globals().items()):
        if name.startswith("test_"):
            start = time.perf_counter()
            function()
            print(f"{name}: good, {time.perf_counter() - start:.2f} s")
    lines = sum(len(path.with_suffix(".csv").read_text("utf-8").splitlines()) - 1 for path in good_files())
    print(f"{len(good_files())} files and {lines} lines of tables met, {len(files('x*.subsurf'))} files refused")


if __name__ == "__main__":
    main()
